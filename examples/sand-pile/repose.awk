# The slope of a heap: awk -F, -f repose.awk series/balls.csv. Prints the angle of repose, the number of grains and, after a blank line, the surface:
# radius [m] and height [m] of rings 1 cm wide, mean of the highest grain of each cell, some 1 cm long, of a ring.
#
# A cone of height h and base radius R has its mass at the mean height h/4 and the mean distance R/2 from its axis, hence tan(angle) = 2 <z>/<r>: all grains
# count, none more than another, and no line has to be laid by eye. Grains farther than `far` from the middle rolled away alone.
BEGIN { far = 0.18; ring = 0.01; pi = atan2(0, -1) }
NR == 1 { for (k = 2; k <= NF; ++k) if ($k ~ /position_x/) column[n++] = k }
{ last = $0 }
END {
    $0 = last
    for (g = 0; g < n; ++g) { x[g] = $(column[g]); y[g] = $(column[g] + 1); z[g] = $(column[g] + 2) }
    for (pass = 0; pass < 20; ++pass) { # the middle of the grains near the middle
        sx = sy = near = 0
        for (g = 0; g < n; ++g) if (pass == 0 || (x[g] - cx)^2 + (y[g] - cy)^2 < far^2) { sx += x[g]; sy += y[g]; ++near }
        cx = sx / near; cy = sy / near
    }
    for (g = 0; g < n; ++g) {
        r = sqrt((x[g] - cx)^2 + (y[g] - cy)^2)
        if (r >= far) continue
        sum_r += r; sum_z += z[g]
        k = int(r / ring)
        s = k " " int((atan2(y[g] - cy, x[g] - cx) / pi + 1) / 2 * (6 * k + 3))
        if (z[g] > top[s]) top[s] = z[g]
    }
    printf "angle %.1f degrees, %d of %d grains\n\n", atan2(2 * sum_z, sum_r) * 180 / pi, near, n
    for (k = 0; k * ring < far; ++k) {
        h = 0
        for (s = 0; s < 6 * k + 3; ++s) h += top[k " " s]
        print (k + 0.5) * ring, h / (6 * k + 3)
    }
}
