#!/usr/bin/env bash
# Plot the compression: plot.sh <run directory>; makes stress-strain.png (P1 figure 8), history.png and packing.png there. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

# all.csv and top.csv have their rows at the same times: side by side they are one table.
gnuplot <<GNUPLOT
set datafile separator ','
set datafile columnheaders
both = "< paste -d, '$results/series/all.csv' '$results/series/top.csv'"
tangent = '$results/series/tangent.csv'
area = 0.85 * 0.85
speed = 0.35
strain(z) = 1.0 - z
set grid lc rgb '#dddddd'
set style line 1 lc rgb '#1f77b4' lw 1.8
set style line 2 lc rgb '#d62728' lw 1.8
set style line 3 lc rgb '#2ca02c' lw 1.8 pt 7 ps 0.7

set terminal pngcairo size 720,480 font 'sans,12' background 'white'
set output '$results/stress-strain.png'
set xlabel 'strain (1 - z_{top}) / 1 m'
set ylabel 'stress [Pa]'
set key bottom left
plot both using (strain(column('position_z [m]'))):(column('sigma_zz [Pa]')) with lines ls 1 title '{/Symbol s}_{zz} of the packing, walls included', \\
     both using (strain(column('position_z [m]'))):(-column('force_z [N]') / area) with lines ls 2 title '- force on the top plane / area', \\
     both using (strain(column('position_z [m]'))):(column('sigma_xx [Pa]')) with lines ls 3 title '{/Symbol s}_{xx}'

set terminal pngcairo size 720,800 font 'sans,12' background 'white'
set output '$results/history.png'
unset key
set multiplot layout 3,1
set ylabel 'kinetic energy [J]'
plot both using (strain(column('position_z [m]'))):(column('energy_kinetic [J]') + column('energy_rotation [J]')) with lines ls 1
set ylabel 'contacts per sphere'
plot both using (strain(column('position_z [m]'))):(column('coordination')) with lines ls 2
set ylabel 'D_{zzzz} [Pa]'
plot tangent using (speed * column('time [s]')):(column('D_zzzz [Pa]')) with linespoints ls 3
unset multiplot
GNUPLOT

"${PARTICLS:-particls}" render "$results" -o "$results/packing.png" --time 0.8 --colour velocity --range 0:0.4 --size 480x320 --quiet
