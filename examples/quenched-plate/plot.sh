#!/usr/bin/env bash
# Draw temperature and damage: plot.sh <run directory>; makes cracks.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" cracks.png 2 2 560 240 '1|temperature|20:400|temperature, t = 0.03 s' '1|damage|0:0.6|damage, t = 0.03 s' \
    '10|temperature|20:400|temperature, t = 0.3 s' '10|damage|0:0.6|damage, t = 0.3 s' -- --view z --no-shadows
