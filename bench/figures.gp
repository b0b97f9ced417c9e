# Figures of docs/performance.md: gnuplot -e "data='DIR'; out='DIR'" figures.gp
set terminal png size 720,450
set grid lc rgb '#dddddd'
set style line 1 lc rgb '#1f77b4' lw 2 pt 7 ps 1.2
set style line 2 lc rgb '#d62728' lw 2 pt 5 ps 1.2
set logscale x
set format x '10^{%L}'
set yrange [0:*]
set datafile separator '\t'

set output out.'/bench-scaling.png'
set xlabel 'spheres'
set ylabel 'ns per particle-step'
plot data.'/scaling.tsv' using 1:2 with linespoints ls 1 notitle

set output out.'/bench-broad-phase.png'
set xlabel 'bodies'
set ylabel 'ns per body'
set key bottom right
plot data.'/broad-phase.tsv' using 1:2 with linespoints ls 1 title 'one size', \
     data.'/broad-phase.tsv' using 1:3 with linespoints ls 2 title 'sizes 1:100'
