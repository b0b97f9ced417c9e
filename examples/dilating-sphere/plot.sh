#!/usr/bin/env bash
# Draw the discs at t = 0, 1, 2 and 3 s: plot.sh <run directory>; makes discs.png there. Needs gnuplot.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

gnuplot <<GNUPLOT
set terminal pngcairo size 800,800 font 'sans,11' background 'white'
set output '$results/discs.png'
set datafile separator ','
series = '$results/series/discs.csv'
set multiplot layout 2,2
unset key
set size ratio -1
set xrange [-6:17]
set yrange [-7:16]
set xlabel 'x [m]'
set ylabel 'y [m]'
set style fill solid 0.6 border lc rgb '#303030'
# Four columns for each disc: x, y, z, radius. Rows are 0.1 s apart; row 0 holds the names.
do for [second = 0:3] {
    row = 10 * second + 1
    set title sprintf('t = %d s', second)
    plot for [disc = 0:24] series every ::row::row using (column(2 + 4 * disc)):(column(3 + 4 * disc)):(column(5 + 4 * disc)) \\
        with circles lc rgb (disc == 12 ? '#d62728' : '#7fa8d0')
}
unset multiplot
GNUPLOT
