#!/usr/bin/env bash
# Draw the deflection of the tips over Young's modulus, beside what theory says: plot.sh <run directory>; makes deflection.png there. Needs gnuplot and awk.
set -euo pipefail
results=${1:?usage: plot.sh <run directory>}

: >"$results/tips.txt"
for stiffness in 8 16 31 62 125 250 500 1000; do
    awk -F, -v E=$stiffness 'NR == 2 { first = $3 } END { print E, $3 - first }' "$results/series/tip_$stiffness.csv" >>"$results/tips.txt"
done

# Eq. 38, and the elastica under its own weight: EI theta'' = -q (L - s) cos(theta), theta(0) = 0, theta'(L) = 0, by shooting.
awk 'BEGIN {
    q = 2e-6; I = 3.14159265358979 * 0.01^4 / 4; n = 1000; h = 1 / n
    for (k = 0; k <= 60; ++k) {
        E = 8 * exp(k / 60 * log(125)); load = q / (E * I); low = 0; high = load
        for (pass = 0; pass < 50; ++pass) {
            c = start = (low + high) / 2; a = y = 0
            for (i = 0; i < n; ++i) { # midpoint rule
                am = a + h / 2 * c; cm = c - h / 2 * load * (1 - i * h) * cos(a)
                y += h * sin(am); a += h * cm; c -= h * load * (1 - (i + 0.5) * h) * cos(am)
            }
            if (c > 0) high = start; else low = start
        }
        print E, -load / 8, -y
    }
}' >"$results/theory.txt"

gnuplot <<GNUPLOT
set terminal pngcairo size 720,440 font 'sans,12' background 'white'
set output '$results/deflection.png'
set grid lc rgb '#dddddd'
set key bottom right
set logscale x
set xlabel "Young's modulus [Pa]"
set ylabel 'deflection of the tip [m]'
set yrange [-1.5:0]
plot '$results/theory.txt' using 1:2 with lines dt 2 lw 1.8 lc rgb '#606060' title 'small deflections, M a L^3/(8 E I) (eq. 38)', \\
     '$results/theory.txt' using 1:3 with lines lw 1.8 lc rgb '#d62728' title 'elastica', \\
     '$results/tips.txt' using 1:2 with points pt 7 ps 1.3 lc rgb '#1f77b4' title '11 points'
GNUPLOT
