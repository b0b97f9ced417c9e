#!/usr/bin/env bash
# Draw four frames of a run beside each other, and its energies as energy.png: what plot.sh of examples/polygons and examples/polyhedra have in common.
#     four-frames.sh <run directory> <picture> <numbers of the frames> <largest energy, mJ> <options of particls render...>
# The run has frames 0.05 s apart and a series `sums` with the energies. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=$1 picture=$2 frames=$3 most=$4
shift 4

"${PARTICLS:-particls}" render "$results" -o "$results/view.png" --each --colour velocity --size 400x400 --no-bar --quiet "$@"

gnuplot <<GNUPLOT
set terminal pngcairo size 800,860 font 'sans,12' background 'white'
set output '$results/$picture'
set multiplot layout 2,2 margins 0,1,0,0.96 spacing 0,0.04
unset key
unset border
unset tics
do for [frame in "$frames"] {
    set title sprintf('t = %g s', 0.05 * frame) offset 0,-0.5
    plot sprintf('$results/view_%06d.png', int(frame)) binary filetype=png with rgbimage
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
set yrange [0:$most]
column_of(name) = 1e3 * column(name . ' [J]')
series = '$results/series/sums.csv'
plot series using 1:(column_of('energy_kinetic')) with lines lw 1.8 lc rgb '#1f77b4' title 'translation', \\
     series using 1:(column_of('energy_rotation')) with lines lw 1.8 lc rgb '#d62728' title 'rotation', \\
     series using 1:(column_of('energy_damped')) with lines lw 1.8 lc rgb '#2ca02c' title 'damped', \\
     series using 1:(column_of('energy_slid')) with lines lw 1.8 lc rgb '#9467bd' title 'slid', \\
     series using 1:(column_of('energy_total')) with lines lw 1.8 lc rgb '#303030' title 'all'
GNUPLOT
rm -f "$results"/view_*.png
