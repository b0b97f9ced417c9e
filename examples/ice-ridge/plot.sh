#!/usr/bin/env bash
# Draw the floes at four times, and energies: plot.sh <run directory>; makes ridge.png and energy.png there. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

bash "$(dirname "${BASH_SOURCE[0]}")/../pictures.sh" "$results" ridge.png 1 4 1000 170 '0|damage|0:0.7|t = 0' '8|damage|0:0.7|t = 8 s' '16|damage|0:0.7|t = 16 s' '24|damage|0:0.7|t = 24 s' -- \
    --view z --no-bar --no-shadows

gnuplot <<GNUPLOT
set terminal pngcairo size 720,400 font 'sans,12' background 'white'
set output '$results/energy.png'
set datafile separator ','
set datafile columnheaders
set grid lc rgb '#dddddd'
set key center right
set xlabel 't [s]'
set ylabel 'energy [kJ]'
set y2label 'fragments'
set y2tics
plot '$results/series/all.csv' using 1:(1e-3*column('energy_bonds [J]')) with lines lw 1.8 lc rgb '#1f77b4' title 'stored in beams', \\
     '$results/series/all.csv' using 1:(1e-3*column('energy_broken [J]')) with lines lw 1.8 lc rgb '#2ca02c' title 'of broken beams', \\
     '$results/series/all.csv' using 1:(column('fragments')) axes x1y2 with lines lw 1.8 lc rgb '#d62728' title 'fragments'
GNUPLOT
