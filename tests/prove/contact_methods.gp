# Figure of docs/contact-detection.md: gnuplot -e "data='DIR'; out='DIR'" contact_methods.gp
stats data.'/energies.tsv' using 2 nooutput
set terminal svg size 760,100+18*STATS_records font 'sans,12' background 'white'
set output out.'/contact-energy.svg'
set grid x lc rgb '#dddddd'
set key outside top center horizontal
set logscale x
set format x '10^{%L}'
set xlabel 'change of energy: median, line to the worst'
set xrange [1e-9:*]
set yrange [STATS_records-0.4:-0.6]
set style line 1 lc rgb '#1f77b4' lw 1.5 pt 7 ps 0.6
set style line 2 lc rgb '#d62728' lw 1.5 pt 5 ps 0.6
set style line 3 lc rgb '#7f7f7f' lw 1.5 pt 9 ps 0.6
plot data.'/energies.tsv' using 2:($0-0.25):2:3:ytic(1) with xerrorbars ls 1 title 'default', \
     data.'/energies.tsv' using 4:($0):4:5 with xerrorbars ls 3 title 'deepest point', \
     data.'/energies.tsv' using 6:($0+0.25):6:7 with xerrorbars ls 2 title 'P1 eq. 14'
