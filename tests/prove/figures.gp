# Figures of docs/verification.md: gnuplot -e "data='DIR'; out='DIR'" figures.gp
set terminal svg size 640,420 font 'sans,13' background 'white'
set grid lc rgb '#dddddd'
set key top left
set style line 1 lc rgb '#1f77b4' lw 1.5 pt 7 ps 0.45
set style line 2 lc rgb '#d62728' lw 1.5 pt 5 ps 0.45
set style line 3 lc rgb '#2ca02c' lw 1.5 pt 9 ps 0.55
set style line 9 lc rgb '#555555' lw 1.2

set output out.'/verify-oblique.svg'
set xlabel 'angle of impact [degrees]'
set ylabel 'tangential velocity after / before'
set key top center
tangent(a) = tan(a*pi/180)
plot data.'/oblique-wall.tsv' using 1:($3/tangent($1)) with lines ls 9 title 'stick-slip solution', \
     data.'/oblique-pair.tsv' using 1:($3/tangent($1)) with lines ls 9 notitle, \
     data.'/oblique-disc.tsv' using 1:($3/tangent($1)) with lines ls 9 notitle, \
     data.'/oblique-wall.tsv' using 1:($2/tangent($1)) with points ls 1 title 'sphere on plane', \
     data.'/oblique-pair.tsv' using 1:($2/tangent($1)) with points ls 2 title 'two spheres', \
     data.'/oblique-disc.tsv' using 1:($2/tangent($1)) with points ls 3 title 'disc on line'

set output out.'/verify-orders.svg'
set logscale xy
set format y '10^{%L}'
set format x '10^{%L}'
set xlabel 'dt / contact time'
set ylabel 'relative error of energy'
set key top left
plot data.'/elastic-energy.tsv' using 1:2 with linespoints ls 1 title 'elastic head-on impact', \
     data.'/book-oblique.tsv' using 1:2 with linespoints ls 2 title 'book, oblique impact with sliding', \
     3*x**2 with lines ls 9 dt 2 title 'slope 2'
unset logscale
set format '%g'

set output out.'/verify-rotation.svg'
set xlabel 'time [s]'
set ylabel 'spin about the intermediate axis [rad/s]'
set key top right
plot data.'/free-rotation.tsv' using 1:3 with lines ls 9 title 'Jacobi', \
     data.'/free-rotation.tsv' using 1:2 every 12 with points ls 1 title 'simulated'

set output out.'/verify-rolling.svg'
set xlabel 'time [s]'
set ylabel 'speed [m/s]'
plot data.'/sliding-to-rolling.tsv' using 1:3 with lines ls 9 title 'v_0 - {/Symbol m} g t, then 5/7 v_0', \
     data.'/sliding-to-rolling.tsv' using 1:2 every 8 with points ls 1 title 'simulated'

set output out.'/verify-cloud.svg'
set xlabel 'time [s]'
set ylabel 'relative error of the energy book'
set format y '%.0e'
plot data.'/cloud.tsv' using 1:2 with lines ls 1 notitle

set output out.'/verify-compression.svg'
set xlabel 'time [s]'
set ylabel 'sum of {/Symbol s}_{zz} V [J]'
set format y '%g'
set key top right
plot data.'/compression.tsv' using 1:3 with lines ls 9 lw 3 title 'LAMMPS', \
     data.'/compression.tsv' using 1:2 with lines ls 2 lw 1 title 'simulated'
