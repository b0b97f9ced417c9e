#!/usr/bin/env bash
# Draw the prisms at t = 0, 0.5, 0.75 and 1 s, and the energies: plot.sh <run directory>; makes prisms.png and energy.png there. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
bash "$(dirname "$0")/../four-frames.sh" "${1:?usage: plot.sh <run directory>}" prisms.png "0 10 15 20" 1.5 --range 0:0.35 --view -1,-0.7,1.1
