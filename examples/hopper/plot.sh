#!/usr/bin/env bash
# Draw the hopper at four times and the discharged mass: plot.sh <run directory>; makes hopper.png and discharge.png there and prints the flow. Needs gnuplot;
# PARTICLS is the program, particls by default.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

last=$(tail -n 1 "$results/series/discharged.csv" | cut -d , -f 1)
times="0.7 0.8 1 $last"
number=0
for time in $times; do
    "${PARTICLS:-particls}" render "$results" -o "$results/view_$number.png" --time "$time" --colour shape --hide gate --section 0,-1,0,0 --no-bar \
        --camera 0,-1,0.12:0,0,-0.01 --zoom 1.3 --size 300x400 --quiet
    number=$((number + 1))
done

gnuplot <<GNUPLOT
set terminal pngcairo size 1000,360 font 'sans,12' background 'white'
set output '$results/hopper.png'
set multiplot layout 1,4 margins 0,1,0,0.92 spacing 0
unset key
unset border
unset tics
do for [k = 0:3] {
    set title sprintf('t = %s s', word('$times', k + 1)) offset 0,-0.5
    plot sprintf('$results/view_%d.png', k) binary filetype=png with rgbimage
}
unset multiplot

reset
set terminal pngcairo size 720,440 font 'sans,12' background 'white'
set output '$results/discharge.png'
set datafile separator ','
set grid lc rgb '#dddddd'
set key top left
set xlabel 't [s]'
set ylabel 'mass below the opening [kg]'
series = '$results/series/discharged.csv'
# The flow after it has set in and before the hopper runs empty: a line.
flow(t) = slope * t + start
slope = 1
start = -1
set fit quiet
set fit logfile '/dev/null'
begin = $last > 1 ? 0.9 : 0
fit [begin:*] flow(x) series using 1:3 via slope, start
# Beverloo: C rho sqrt(g) (D - k d)^(5/2), rho the bulk density in the full hopper
beverloo(k) = 0.58 * 1500 * sqrt(9.81) * (0.07 - k * 0.01)**2.5
print sprintf('flow from t = %g s on: %.2f kg/s', begin, slope)
plot [0.6:*][0:1.4] series every ::1 using 1:3 with lines lw 2.4 lc rgb '#1f77b4' title 'simulation', \\
     [0.6:*] flow(x) with lines lw 1.2 dt 2 lc rgb '#303030' title sprintf('line from %g s on: %.2f kg/s', begin, slope), \\
     [0.73:*] beverloo(1.4) * (x - 0.73) with lines lw 1.2 lc rgb '#d62728' title sprintf('Beverloo, k = 1.4 (round): %.2f kg/s', beverloo(1.4)), \\
     [0.73:*] beverloo(2.9) * (x - 0.73) with lines lw 1.2 lc rgb '#2ca02c' title sprintf('Beverloo, k = 2.9 (sand): %.2f kg/s', beverloo(2.9))
GNUPLOT
rm -f "$results"/view_?.png
