#!/usr/bin/env bash
# Draw the damage at four times: plot.sh <run directory>; makes cracks.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" cracks.png 4 1 260 480 '1|damage|0:0.6|15 us' '3|damage|0:0.6|45 us' '4|damage|0:0.6|60 us' '6|damage|0:0.6|90 us' -- \
    --view z --hide impactor --no-bar --no-shadows
