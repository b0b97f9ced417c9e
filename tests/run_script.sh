#!/usr/bin/env bash
# Run one test script in an emptied working directory: run_script.sh <script>. CTest sets the working directory and the environment.
set -euo pipefail

case "$PWD" in
    */tests/scratch/*) find . -mindepth 1 -delete ;;
    *) echo "run_script.sh: $PWD is no test folder of a build tree, nothing is deleted here" >&2; exit 1 ;;
esac
exec bash "$1"
