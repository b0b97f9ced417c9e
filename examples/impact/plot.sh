#!/usr/bin/env bash
# Draw the disc from above and from the side, and the sphere's speed: plot.sh <run directory>; makes disc.png and sphere.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" disc.png 3 1 420 420 '3|damage|0:1|60 us' '6|damage|0:1|120 us' '10|damage|0:1|200 us' -- --no-bar

gnuplot <<GNUPLOT
set terminal pngcairo size 720,400 font 'sans,12' background 'white'
set output '$results/sphere.png'
set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set key top right
set xlabel 't [us]'
set ylabel 'speed of the sphere [m/s]'
set y2label 'fragments'
set y2tics
plot '$results/series/ball.csv' using (1e6*\$1):(-column('velocity_z [m/s]')) with lines lw 1.8 lc rgb '#1f77b4' title 'speed', \\
     '$results/series/disc.csv' using (1e6*\$1):(column('fragments')) axes x1y2 with lines lw 1.8 lc rgb '#d62728' title 'fragments'
GNUPLOT
