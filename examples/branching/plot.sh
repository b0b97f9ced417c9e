#!/usr/bin/env bash
# Draw the damage at four times: plot.sh <run directory>; makes branches.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" branches.png 2 2 500 220 '3|damage|0:0.5|15 us' '5|damage|0:0.5|25 us' '7|damage|0:0.5|35 us' '9|damage|0:0.5|45 us' -- \
    --view z --no-bar --no-shadows
