#!/usr/bin/env bash
# Draw the heaps and their profiles: plot.sh <run directory>; makes heaps.png and profile.png there and prints the angles of repose. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}
here=$(dirname "$0")

for heap in balls stones; do
    awk -F, -f "$here/repose.awk" "$results/series/$heap.csv" >"$results/$heap.txt"
    echo "$heap: $(head -n 1 "$results/$heap.txt")"
done

"${PARTICLS:-particls}" render "$results" -o "$results/heaps.png" --colour group --hide tube_of_balls --hide tube_of_stones \
    --camera 0,-0.75,0.22:0,0,0.01 --size 1000x360 --no-bar --quiet

gnuplot <<GNUPLOT
set terminal pngcairo size 720,360 font 'sans,12' background 'white'
set output '$results/profile.png'
set grid lc rgb '#dddddd'
set xlabel 'distance from the middle [m]'
set ylabel 'height [m]'
set xrange [0:0.16]
set yrange [0:0.06]
angle(file) = system("head -n 1 " . file . " | cut -d ' ' -f 2")
plot '$results/balls.txt' skip 2 using 1:2 with linespoints lw 1.8 pt 7 ps 0.7 lc rgb '#e69f00' title 'balls, ' . angle('$results/balls.txt') . '°', \\
     '$results/stones.txt' skip 2 using 1:2 with linespoints lw 1.8 pt 7 ps 0.7 lc rgb '#56b4e9' title 'stones, ' . angle('$results/stones.txt') . '°'
GNUPLOT
