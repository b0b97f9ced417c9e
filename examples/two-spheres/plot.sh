#!/usr/bin/env bash
# Plot the impact beside the solution of the normal motion: plot.sh <run directory>; makes impact.png there. Needs gnuplot.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

gnuplot <<GNUPLOT
set datafile separator ','
set datafile columnheaders
left = '$results/series/left.csv'

# m_eff d'' + cn d' + kn d = 0 with d(0) = 0, d'(0) = 2 v, from the first touch to d = 0
kn = 1.0e6; cn = 10.0; v = 1.0; before = 2.0e-5
m = 4.0 / 3.0 * pi * 0.01**3 * 2500.0
beta = 0.5 * cn / (0.5 * m)
omega = sqrt(kn / (0.5 * m) - beta**2)
contact = pi / omega
d(t) = 2.0 * v / omega * exp(-beta * t) * sin(omega * t)
rate(t) = 2.0 * v / omega * exp(-beta * t) * (omega * cos(omega * t) - beta * sin(omega * t))
inside(t) = t >= 0.0 && t <= contact
force(t) = inside(t) ? kn * d(t) + cn * rate(t) : 0.0
speed(t) = t < 0.0 ? v : (inside(t) ? 0.5 * rate(t) : -v * exp(-beta * contact))
clock = 1.0e-6 # the axis is in microseconds from the first touch

set terminal pngcairo size 760,760 font 'sans,12' background 'white'
set output '$results/impact.png'
set grid lc rgb '#dddddd'
set xrange [-20:280]
set samples 1200
set style line 1 lc rgb '#1f77b4' pt 7 ps 0.5
set style line 2 lc rgb '#d62728' pt 5 ps 0.5
set style line 9 lc rgb '#555555' lw 1.3
set multiplot layout 2,1
set ylabel 'force on the left sphere [N]'
set key top right
plot force(x * clock) with lines ls 9 title 'normal force, exact', \\
     left using ((column('time [s]') - before) / clock):(-column('force_x [N]')) every 8 with points ls 1 title 'normal, simulated', \\
     left using ((column('time [s]') - before) / clock):(-column('force_y [N]')) every 8 with points ls 2 title 'tangential, simulated'
set xlabel 'time since the first touch [microseconds]'
set ylabel 'velocity of the left sphere [m/s]'
plot speed(x * clock) with lines ls 9 title 'normal velocity, exact', \\
     left using ((column('time [s]') - before) / clock):(column('velocity_x [m/s]')) every 8 with points ls 1 title 'normal, simulated', \\
     left using ((column('time [s]') - before) / clock):(column('velocity_y [m/s]')) every 8 with points ls 2 title 'tangential, simulated'
unset multiplot
GNUPLOT
