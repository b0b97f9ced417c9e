#!/usr/bin/env bash
# Shapes of all kinds that rain on each other, one of them partly driven, give the same bits on any number of threads, with any skin and order in memory, and after a restart.
# Runs in an empty folder with PARTICLS (the program).
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

# A hill on the floor.
cat >hill.obj <<'OBJ'
v 0.05 0.05 0
v 0.35 0.05 0
v 0.35 0.35 0
v 0.05 0.35 0
v 0.2 0.2 0.06
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
OBJ

plugins=$PARTICLS_BUILD/lib/plugins
cat >rain.yaml <<YAML
particls: 1
plugins: ["$plugins/torus.so", "$plugins/template.so"]
materials: {grain: {density: 2500}}
shapes:
  ball: {sphere: {radius: 0.05}}
  brick: {box: {half: [0.05, 0.03, 0.025]}}
  soap: {box: {half: [0.04, 0.03, 0.02], rounding: 0.01}}
  pill: {capsule: {radius: 0.03, length: 0.06}}
  can: {cylinder: {radius: 0.03, length: 0.08}}
  egg: {ellipsoid: {half: [0.06, 0.04, 0.03]}}
  tetra: {polyhedron: {points: [[0.05, 0.05, 0.05], [-0.05, -0.05, 0.05], [-0.05, 0.05, -0.05], [0.05, -0.05, -0.05]]}}
  flint: {polyhedron: {points: [[0.04, 0.03, 0.02], [-0.04, -0.03, 0.03], [-0.03, 0.04, -0.03], [0.03, -0.04, -0.04], [0.01, 0.02, 0.05]], rounding: 0.008}}
  lens: {superquadric: {half: [0.05, 0.045, 0.03], epsilon1: 0.7, epsilon2: 0.8}}
  nut: {prism: {points: [[0.05, 0], [0.025, 0.043], [-0.025, 0.043], [-0.05, 0], [-0.025, -0.043], [0.025, -0.043]], height: 0.03}}
  plank: {box: {half: [0.05, 0.02, 0.02]}}
  knob: {sphere: {radius: 0.025}}
  corner: {compound: {parts: [{shape: plank}, {shape: plank, position: [-0.03, 0.06, 0], orientation: {axis: [0, 0, 1], angle: 1.5}, scale: 0.6}, {shape: knob, position: [0.08, 0, 0.01]}]}} # a hair apart: soon measured
  bean: {my_shape: {length: 0.06, radius: 0.03}}          # known by its distance alone, convex
  ring: {torus: {ring_radius: 0.045, tube_radius: 0.018}} # the same, not convex
  hill: {mesh: {path: hill.obj}}
  wall: {plane: {}}
bodies:
  - {name: rain, shape: [ball, brick, soap, pill, can, egg, tetra, flint, lens, nut, corner, bean], material: grain, velocity: [0, 0, -4],
     place: {random: {count: 30, box: {lower: [0, 0, 0.12], upper: [0.4, 0.4, 1.2]}}}, orientation: random}
  - {name: stirrer, shape: brick, material: grain, position: [0.05, 0.2, 0.05], motion: {velocity: [0.6, free, free], angular_velocity: [free, free, 9]}}
  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
  - {name: hill, shape: hill, material: grain, position: [0, 0, 0], fixed: true}
  - {name: left, shape: wall, material: grain, position: [0, 0, 0], normal: [1, 0, 0]}
  - {name: right, shape: wall, material: grain, position: [0.4, 0, 0], normal: [-1, 0, 0]}
  - {name: front, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 1, 0]}
  - {name: back, shape: wall, material: grain, position: [0, 0.4, 0], normal: [0, -1, 0]}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 50, cs: 20, friction: 0.5}]
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.15, dt: 1.0e-4, coordination: 8}
observe: [{checkpoint: {every: 0.05}}]
YAML

state_of() { grep -o '"state_hash": "[0-9a-f]*"' "$1/summary.json"; }

run() { # <folder> <option...>
    local folder=$1
    shift
    "$PARTICLS" run rain.yaml -o "$folder" --quiet "$@" >"$folder.txt" 2>&1 || { complain "run $folder failed"; cat "$folder.txt" >&2; }
}

run first --threads 1
grep -q '"contacts": 0,' first/summary.json && complain "nothing touches: the test shows nothing"
grep -q '"contact_search": {"queries": [1-9][0-9]*, "iterations": [1-9][0-9]*, "restarts": [0-9]*, "fallbacks": [0-9]*, "failures": 0}' first/summary.json || complain "contacts were not searched for as they should be: $(grep contact_search first/summary.json)"
expected=$(state_of first)
[ -n "$expected" ] || complain "there is no state hash"

same() { [ "$(state_of "$1")" = "$expected" ] || complain "$1 ended in $(state_of "$1"), the first run in $expected"; }

run threads --threads 3
same threads
run skin --threads 2 --set neighbours.skin=0.002
same skin
run wide --threads 1 --set neighbours.skin=0.08 --set neighbours.reorder=false
same wide
for middle in 0.0312 0.0704 0.1101; do
    run "half-$middle" --threads 1 --set time.end=$middle
    "$PARTICLS" resume "half-$middle" --until 0.15 --threads 2 --quiet >resume.txt 2>&1 || { complain "resume at $middle failed"; cat resume.txt >&2; }
    same "half-$middle"
    diff <(grep -v '_s"\|"threads"\|"scene_hash"' first/summary.json) <(grep -v '_s"\|"threads"\|"scene_hash"' "half-$middle/summary.json") >&2 || complain "the summary after a restart is another one"
done
for faces in point volume; do
    run "$faces-1" --threads 1 --set "contact[0].faces=$faces" --set contact[0].face_area=0.002
    run "$faces-2" --threads 2 --set "contact[0].faces=$faces" --set contact[0].face_area=0.002 --set neighbours.skin=0.002
    [ "$(state_of "$faces-1")" = "$(state_of "$faces-2")" ] || complain "faces: $faces depends on threads or skin"
    [ "$(state_of "$faces-1")" != "$expected" ] || complain "faces: $faces changes nothing"
done
run admm-1 --threads 1 --set contact[0].solver=admm --set time.end=0.05
run admm-2 --threads 2 --set contact[0].solver=admm --set time.end=0.05 --set neighbours.skin=0.002
[ "$(state_of admm-1)" = "$(state_of admm-2)" ] || complain "solver: admm depends on threads or skin"

# A compound whose parts' spheres stand out of its own, over a wall whose facets matter before they are touched.
cat >bone.yaml <<'YAML'
particls: 1
materials: {grain: {density: 2500}}
shapes:
  end: {box: {half: [0.05, 0.05, 0.05]}}
  bone: {compound: {parts: [{shape: end, position: [-0.06, 0, 0]}, {shape: end, position: [0.06, 0, 0]}]}}
  hill: {mesh: {path: hill.obj}}
bodies:
  - {name: bone, shape: bone, material: grain, position: [0.17, 0.22, 0.16], velocity: [0.3, 0.1, -0.5], angular_velocity: [1, 2, 0]}
  - {name: hill, shape: hill, material: grain, position: [0, 0, 0], fixed: true}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 50, cs: 20, friction: 0.5}]
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.2, dt: 1.0e-4}
YAML
for skin in 0.0005 0.01 0.2; do
    "$PARTICLS" run bone.yaml -o "bone-$skin" --quiet --set neighbours.skin=$skin >bone.txt 2>&1 || { complain "the bone's run failed"; cat bone.txt >&2; }
    [ "$(state_of "bone-$skin")" = "$(state_of bone-0.0005)" ] || complain "a compound on a wall of pieces depends on the skin: $skin"
done
grep -q '"contacts": 0,' bone-0.01/summary.json && complain "the bone touches nothing: it shows nothing"

# Rings, which are not convex and known by their distance alone, take long: a few of them, not for long.
sed -e 's/shape: \[ball.*bean\], material/shape: [ring, brick, nut], material/; s/count: 30/count: 9/; s/upper: \[0.4, 0.4, 1.2\]/upper: [0.4, 0.4, 0.4]/' rain.yaml >rings.yaml
rings() { # <folder> <option...>
    local folder=$1
    shift
    "$PARTICLS" run rings.yaml -o "$folder" --quiet --set time.end=0.05 "$@" >"$folder.txt" 2>&1 || { complain "run $folder failed"; cat "$folder.txt" >&2; }
}
rings rings-1 --threads 1
rings rings-2 --threads 2 --set neighbours.skin=0.002 --set neighbours.reorder=false
rings rings-half --threads 2 --set time.end=0.0406
"$PARTICLS" resume rings-half --until 0.05 --threads 1 --quiet >resume.txt 2>&1 || { complain "the rings cannot be resumed"; cat resume.txt >&2; }
grep -q '"contacts": 0,' rings-1/summary.json && complain "the rings touch nothing: they show nothing"
for folder in rings-2 rings-half; do
    [ "$(state_of $folder)" = "$(state_of rings-1)" ] || complain "$folder ended in $(state_of $folder), the first run of rings in $(state_of rings-1)"
done

[ $failures -eq 0 ] || exit 1
