#!/usr/bin/env bash
# Draw the polygons at t = 0, 0.45, 0.65 and 1 s, and the energies: plot.sh <run directory>; makes polygons.png and energy.png there. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
bash "$(dirname "$0")/../four-frames.sh" "${1:?usage: plot.sh <run directory>}" polygons.png "0 9 13 20" 5.5 --range 0:0.3
