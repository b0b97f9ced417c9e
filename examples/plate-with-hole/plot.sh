#!/usr/bin/env bash
# Draw the plate at t = 0, 0.25 and 1 s with its damage, and the forces along x and y beside: plot.sh <run directory>; makes plate.png and energy.png there. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

draw() { # <frame> <colour> <range>
    "${PARTICLS:-particls}" render "$results" -o "$results/view_$1_$2.png" --frame "$1" --colour "$2" --range "$3" --view z --size 420x315 --no-shadows --quiet
}
for frame in 0 5 20; do
    draw $frame damage 0:0.6
    draw $frame force.x -4e-7:4e-7
    draw $frame force.y -4e-7:4e-7
done

gnuplot <<GNUPLOT
set terminal pngcairo size 945,735 font 'sans,13' background 'white'
set output '$results/plate.png'
set multiplot layout 3,3 margins 0,1,0,0.97 spacing 0,0.01
unset key
unset border
unset tics
do for [frame in "0 5 20"] {
    do for [colour in "damage force.x force.y"] {
        set title (frame eq "0" ? colour : '') offset 0,-0.8
        plot sprintf('$results/view_%s_%s.png', frame, colour) binary filetype=png with rgbimage
    }
}
unset multiplot

reset
set terminal pngcairo size 720,400 font 'sans,12' background 'white'
set output '$results/energy.png'
set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set key outside right
set xlabel 't [s]'
set ylabel 'energy [mJ]'
column_of(name) = 1e3 * column(name . ' [J]')
series = '$results/series/all.csv'
plot series using 1:(column_of('energy_kinetic')) with lines lw 1.8 lc rgb '#1f77b4' title 'kinetic', \\
     series using 1:(column_of('energy_bonds')) with lines lw 1.8 lc rgb '#d62728' title 'stored in bonds', \\
     series using 1:(column_of('energy_broken')) with lines lw 1.8 lc rgb '#2ca02c' title 'of broken bonds'
GNUPLOT
rm -f "$results"/view_*.png
