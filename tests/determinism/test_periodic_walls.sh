#!/usr/bin/env bash
# Walls of pieces in periodic boxes: the images of a floor that spans the period join to one floor, it does not matter where in the box it is cut, and the bits are those of
# any number of threads, any skin and after a restart.
# Runs in an empty folder with PARTICLS (the program).
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

run() { # <scene> <folder> <option...>
    local scene=$1 folder=$2
    shift 2
    "$PARTICLS" run "$scene" -o "$folder" --quiet "$@" >"$folder.txt" 2>&1 || { complain "run $folder failed"; cat "$folder.txt" >&2; }
}

# compare <folder> <folder> <how far the second is shifted along x> <tolerance>: the series of all bodies
compare() {
    paste -d, "$1"/series/all.csv "$2"/series/all.csv | awk -F, -v shift="$3" -v tolerance="$4" '
        NR == 1 { half = NF / 2; for (k = 1; k <= half; ++k) if ($k ~ /position_x|^x/) x[k] = 1; next }
        { for (k = 1; k <= half; ++k) { d = $(k + half) - $k - (k in x ? shift : 0); if (d < 0) d = -d; if (d > most) most = d; ++numbers } }
        END { if (!(numbers > 100) || !(most <= tolerance)) { print most " of " numbers " numbers"; exit 1 } }' >difference.txt ||
        complain "$1 and $2 differ: $(cat difference.txt)"
}

# ---- a floor across the seam ----------------------------------------------------------------------------------------------------------------------------------

# One tile of the floor is two triangles, a metre long.
tiles() { # <first> <last>
    local vertex=1
    for ((k = $1; k <= $2; ++k)); do
        printf 'v %d -1 0\nv %d -1 0\nv %d 1 0\nv %d 1 0\n' "$k" $((k + 1)) $((k + 1)) "$k"
        printf 'f %d %d %d\nf %d %d %d\n' $vertex $((vertex + 1)) $((vertex + 2)) $vertex $((vertex + 2)) $((vertex + 3))
        vertex=$((vertex + 4))
    done
}
tiles 0 0 >tile.obj
tiles -1 3 >floor.obj

slide() { # <mesh> <where it and the bodies are shifted to> <domain>
    cat <<YAML
particls: 1
vars: {from: $2}
$3
materials: {grain: {density: 2500}}
shapes:
  brick: {box: {half: [0.1, 0.06, 0.05]}}
  ball: {sphere: {radius: 0.06}}
  floor: {mesh: {path: $1}}
bodies:
  - {name: brick, shape: brick, material: grain, position: ["0.4+from", 0.1, 0.0499], velocity: [2, 0, 0]}
  - {name: ball, shape: ball, material: grain, position: ["0.7+from", -0.2, 0.0599], velocity: [2.1, 0.02, 0]}
  - {name: floor, shape: floor, material: grain, position: ["from", 0, 0], fixed: true}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 50, cs: 20, friction: 0.1}]
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.8, dt: 2.0e-4}
observe: [{particle: all, name: all, quantities: [position, velocity, angular_velocity], every: 0.02}]
YAML
}
periodic='domain: {periodic: [true, false, false], lower: [0, -1, -1], upper: [1, 1, 2]}'
slide tile.obj 0 "$periodic" >seam.yaml
slide floor.obj 0 "" >long.yaml
slide tile.obj 0.37 "$periodic" >shifted.yaml
run seam.yaml seam
run long.yaml long
run shifted.yaml shifted
compare long seam 0 1e-11
compare seam shifted 0.37 1e-11
# Its weight presses the brick 0.6 mm into the floor; it never leaves it.
awk -F, 'NR > 1 { if ($4 < 0.049 || $4 > 0.05) off = 1; if ($2 > 1.5) beyond = 1 } END { exit off || !beyond }' seam/series/all.csv ||
    complain "the brick does not slide over the seam as over a floor"

# Driven along x through the box, on and on: carries the bodies as the long floor does.
sed 's/fixed: true/motion: {velocity: [2.5, 0, 0]}/' seam.yaml >driven.yaml
sed 's/fixed: true/motion: {velocity: [2.5, 0, 0]}/; s/floor.obj/belt.obj/' long.yaml >belt.yaml
tiles -5 4 >belt.obj
run driven.yaml driven
run belt.yaml belt
compare belt driven 0 1e-11

# A floor that is longer than the box is refused: it would lie on its own image.
slide floor.obj 0 "$periodic" >overlong.yaml
"$PARTICLS" run overlong.yaml -o overlong --quiet >overlong.txt 2>&1 && complain "a wall longer than the period is accepted"
grep -q 'is 5 m long along x, where the box repeats after 1 m' overlong.txt || complain "the reason is not given: $(cat overlong.txt)"

# ---- in the plane ---------------------------------------------------------------------------------------------------------------------------------------------

bumpy() { # <points> <where it and the bodies are shifted to> <domain>
    cat <<YAML
particls: 1
dimension: 2
vars: {from: $2}
$3
materials: {grain: {density: 2500}}
shapes:
  brick: {box: {half: [0.1, 0.05]}}
  disc: {disc: {radius: 0.05}}
  pair: {compound: {parts: [{shape: disc, position: [-0.04, 0]}, {shape: disc, position: [0.04, 0]}]}}
  hills: {polyline: {points: $1}}
bodies:
  - {name: brick, shape: brick, material: grain, position: ["0.4+from", 0.3], velocity: [1, 0]}
  - {name: pair, shape: pair, material: grain, position: ["0.7+from", 0.3], velocity: [1.4, 0]}
  - {name: follower, shape: pair, material: grain, position: ["0.1+from", 0.3], velocity: [2.5, 0]}
  - {name: hills, shape: hills, material: grain, position: ["from", 0], fixed: true}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 50, cs: 20, friction: 0.1}]
forces: [{gravity: [0, -9.81]}]
time: {end: 0.5, dt: 1.0e-4}
observe: [{particle: all, name: all, quantities: [position, velocity, angular_velocity], every: 0.02}]
YAML
}
flat='domain: {periodic: [true, false], lower: [0, -1], upper: [1, 2]}'
bumpy '[[0, 0.1], [0.5, 0], [1, 0.1]]' 0 "$flat" >hills.yaml
bumpy '[[-1, 0.1], [-0.5, 0], [0, 0.1], [0.5, 0], [1, 0.1], [1.5, 0], [2, 0.1], [2.5, 0], [3, 0.1]]' 0 "" >range.yaml
bumpy '[[0, 0.1], [0.5, 0], [1, 0.1]]' -0.23 "$flat" >moved.yaml
run hills.yaml hills
run range.yaml range
run moved.yaml moved
compare range hills 0 1e-9
compare hills moved -0.23 1e-9

# ---- the same bits --------------------------------------------------------------------------------------------------------------------------------------------

printf 'v 0 0 0\nv 0.2 0 0.03\nv 0.4 0 0\nv 0 0.4 0\nv 0.2 0.4 0.03\nv 0.4 0.4 0\nf 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\n' >ridge.obj
cat >rain.yaml <<'YAML'
particls: 1
domain: {periodic: [true, true, false], lower: [0, 0, -1], upper: [0.4, 0.4, 2]}
materials: {grain: {density: 2500}}
shapes:
  ball: {sphere: {radius: 0.04}}
  brick: {box: {half: [0.04, 0.03, 0.025]}}
  bone: {compound: {parts: [{shape: brick, position: [-0.02, 0, 0]}, {shape: ball, position: [0.02, 0, 0]}]}}
  ridge: {mesh: {path: ridge.obj}}
bodies:
  - {name: rain, shape: [ball, brick, bone], material: grain, velocity: [3, 1, -4],
     place: {random: {count: 14, box: {lower: [0, 0, 0.12], upper: [0.4, 0.4, 1.2]}}}, orientation: random}
  - {name: ridge, shape: ridge, material: grain, position: [0, 0, 0], motion: {velocity: [-0.5, 0.2, 0]}}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 50, cs: 20, friction: 0.5}]
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.15, dt: 1.0e-4}
observe: [{checkpoint: {every: 0.05}}]
YAML
state_of() { grep -o '"state_hash": "[0-9a-f]*"' "$1/summary.json"; }
same() { [ "$(state_of "$1")" = "$expected" ] || complain "$1 ended in $(state_of "$1"), the first run in $expected"; }

run rain.yaml first --threads 1
grep -q '"contacts": 0,' first/summary.json && complain "nothing touches: the test shows nothing"
expected=$(state_of first)
[ -n "$expected" ] || complain "there is no state hash"
run rain.yaml threads --threads 3
same threads
run rain.yaml skin --threads 2 --set neighbours.skin=0.001
same skin
run rain.yaml wide --threads 1 --set neighbours.skin=0.03 --set neighbours.reorder=false
same wide
for middle in 0.1134; do
    run rain.yaml "half-$middle" --threads 1 --set time.end=$middle
    "$PARTICLS" resume "half-$middle" --until 0.15 --threads 2 --quiet >resume.txt 2>&1 || { complain "resume at $middle failed"; cat resume.txt >&2; }
    same "half-$middle"
done

[ $failures -eq 0 ] || exit 1
