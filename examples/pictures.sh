#!/usr/bin/env bash
# Frames of a run above or beside each other: what the plot.sh of several examples have in common.
#     pictures.sh <run directory> <picture> <columns> <rows> <width> <height> "<frame|colour|range|title>" ... -- <options of particls render...>
# Width and height are those of one frame in pixels; an empty range is the frame's own. Needs gnuplot; PARTICLS is the program, particls by default.
set -euo pipefail
results=$1 picture=$2 columns=$3 rows=$4 width=$5 height=$6
shift 6
frames=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    frames+=("$1")
    shift
done
shift

number=0
titles=""
for entry in "${frames[@]}"; do
    IFS='|' read -r frame colour range title <<<"$entry"
    options=(--frame "$frame" --colour "$colour")
    [ -n "$range" ] && options+=(--range "$range")
    "${PARTICLS:-particls}" render "$results" -o "$results/view_$number.png" "${options[@]}" --size "${width}x$height" --quiet "$@"
    titles+=" \"$title\""
    number=$((number + 1))
done

gnuplot <<GNUPLOT
set terminal pngcairo size $((columns * width)),$((rows * (height + 30))) font 'sans,13' background 'white'
set output '$results/$picture'
set multiplot layout $rows,$columns margins 0,1,0,$(awk "BEGIN { print 1 - 28 / ($rows * ($height + 30)) }") spacing 0,$(awk "BEGIN { print 28 / ($rows * ($height + 30)) }")
unset key
unset border
unset tics
titles = '$titles'
do for [n = 0:$((number - 1))] {
    set title word(titles, n + 1) offset 0,-0.7
    plot sprintf('$results/view_%d.png', n) binary filetype=png with rgbimage
}
unset multiplot
GNUPLOT
rm -f "$results"/view_*.png
