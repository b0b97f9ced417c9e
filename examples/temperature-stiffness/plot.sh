#!/usr/bin/env bash
# Plot the overlap beside weight / stiffness: plot.sh <run directory>; makes overlap.png there. Needs gnuplot.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

gnuplot <<GNUPLOT
set datafile separator ','
set datafile columnheaders
weight = 9.81 * 1000 * 4.0 / 3.0 * pi * 0.05**3
warmth(t) = exp(-t / 1.5) # (T - 20) / 80
stiffness(t) = 2.0e4 - 1.8e4 * warmth(t)
set terminal pngcairo size 720,420 font 'sans,12' background 'white'
set output '$results/overlap.png'
set grid lc rgb '#dddddd'
set xlabel 'time [s]'
set ylabel 'overlap [mm]'
set samples 600
plot [0:6] 1e3 * weight / stiffness(x) with lines lc rgb '#555555' lw 1.3 title 'weight / k_n(T)', \\
     '$results/series/ball.csv' using (column('time [s]')):(1e3 * (0.05 - column('position_z [m]'))) every 4 with points pt 7 ps 0.5 lc rgb '#1f77b4' title 'simulated'
GNUPLOT
