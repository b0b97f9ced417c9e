#!/usr/bin/env bash
# Draw both bars at three times, and their tips over time: plot.sh <run directory>; makes bars.png and tips.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" bars.png 3 1 420 420 '0|speed||t = 0' '2|speed|0:0.3|t = 5 s' '4|speed|0:0.3|t = 10 s' -- \
    --camera 1.9,-1.9,0.5:0.5,0.2,-0.25 --no-bar

gnuplot <<GNUPLOT
set terminal pngcairo size 720,400 font 'sans,12' background 'white'
set output '$results/tips.png'
set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set key top right
set yrange [-1:0.25]
set xrange [0:10]
set xlabel 't [s]'
set ylabel 'height of the tip [m]'
# The last point of either bar's first row.
plot '$results/series/near_tip.csv' using 1:(column('38.position_z [m]')) with lines lw 1.8 lc rgb '#1f77b4' title 'beams to nearest neighbours', \\
     '$results/series/far_tip.csv' using 1:(column('38.position_z [m]')) with lines lw 1.8 lc rgb '#d62728' title 'beams within 0.06 m'
GNUPLOT
