#!/usr/bin/env bash
# A run that is killed or interrupted at any instant, and resumed, leaves the same files as an undisturbed one: series, frames and checkpoints
# byte for byte, the summary but for wall times. Runs in an empty folder with PARTICLS (the program).
#   PARTICLS_KILLS   random moments to try on each scene (5); half as many again with Ctrl-C
#   PARTICLS_SEED    of the moments
#   PARTICLS_SCENE   another scene instead of the two below
set -euo pipefail
set -m # jobs in the background keep SIGINT

kills=${PARTICLS_KILLS:-5}
RANDOM=${PARTICLS_SEED:-$$}
echo "seed ${PARTICLS_SEED:-$$}"

cat >grows.yaml <<'YAML'
particls: 1
title: spheres fall on a plane, are hit by a driven wall, one of them grows
dimension: 3
materials:
  grain: {density: 1000}
shapes:
  ball: {sphere: {radius: 0.05}}
  wall: {plane: {}}
bodies:
  - {name: pack, shape: ball, material: grain, velocity: [0.3, 0.1, -1], place: {hex_pack: {count: [8, 8, 8], corner: [0, 0, 0.06]}}}
  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
  - {name: pusher, shape: wall, material: grain, position: [-0.1, 0, 0], normal: [1, 0, 0], motion: {velocity: [0.5, 0, 0]}}
contact:
  - {between: [grain, grain], law: viscoelastic, kn: 20000, ks: 10000, cn: 4, cs: 2, friction: 0.4}
forces:
  - {gravity: [0, 0, -9.81]}
states:
  - {of: "pack[100]", radius: {rate: "0.02 * cos(5 * t)"}}
time: {end: 0.4, dt: 1.0e-4}
observe:
  - {collection: all, name: heap, quantities: [stress, fabric, coordination, energy, momentum], every: 0.002}
  - {particle: pusher, name: pusher, quantities: [position, force], every_steps: 7}
  - {frames: vtk, name: picture, every: 0.02, contacts: true}
  - {checkpoint: {every: 0.05}}
YAML

# Nothing is driven and nothing grows, and all radii are equal: only so do steps run into each other, and contacts go in whole vectors.
cat >equal.yaml <<'YAML'
particls: 1
title: equal spheres, packed so densely that they touch, fall on a plane
dimension: 3
materials:
  grain: {density: 1000}
shapes:
  ball: {sphere: {radius: 0.05}}
  wall: {plane: {}}
bodies:
  - {name: pack, shape: ball, material: grain, velocity: [0.3, 0.1, -1], place: {hex_pack: {count: [10, 10, 10], corner: [0, 0, 0.01], spacing: 0.099}}}
  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
  - {name: side, shape: wall, material: grain, position: [-0.01, 0, 0], normal: [1, 0, 0]}
contact:
  - {between: [grain, grain], law: viscoelastic, kn: 20000, ks: 10000, cn: 4, cs: 2, friction: 0.4}
forces:
  - {gravity: [0, 0, -9.81]}
time: {end: 0.12, dt: 1.0e-4}
observe:
  - {collection: all, name: heap, quantities: [stress, fabric, coordination, energy, momentum], every: 0.002}
  - {particle: floor, name: floor, quantities: [position, force], every_steps: 7}
  - {frames: vtk, name: picture, every: 0.02, contacts: true}
  - {checkpoint: {every: 0.02}}
YAML

same_results() { # <directory>: the same as in ./reference
    local part
    for part in series frames checkpoint; do
        if ! diff -r --brief "reference/$part" "$1/$part"; then
            echo "$1/$part is not that of the undisturbed run" >&2
            exit 1
        fi
    done
    if ! diff <(grep -v '_s"' reference/summary.json) <(grep -v '_s"' "$1/summary.json"); then
        echo "$1/summary.json is not that of the undisturbed run" >&2
        exit 1
    fi
}

random_wait() { # <longest time in ms>
    sleep "$(awk -v ms=$((RANDOM * $1 / 32768)) 'BEGIN { print ms / 1000 }')"
}

stop_after_a_while() { # <signal> <process>
    random_wait $((duration + duration / 10))
    kill "-$1" "$2" 2>/dev/null || true
    wait "$2" 2>/dev/null || status=$?
}

finish() { # <directory>: resume until it is done, as a user would
    if ! "$PARTICLS" resume "$1" --quiet >>log 2>&1; then
        # killed before anything was written: there is nothing to resume, the message says so
        if [ -e "$1/scene.used.yaml" ]; then echo "resume failed:"; tail -n 3 log; exit 1; fi
        "$PARTICLS" run "$scene" -o "$1" --overwrite --quiet
    fi
}

undisturbed() { # makes ./reference
    local begin
    begin=$(date +%s%N)
    "$PARTICLS" run "$scene" -o reference --quiet
    duration=$((($(date +%s%N) - begin) / 1000000))
    echo "$scene: the undisturbed run takes $duration ms"
}

kill_runs() {
    for ((k = 0; k < kills; ++k)); do
        "$PARTICLS" run "$scene" -o killed --quiet &
        stop_after_a_while KILL $!
        if ((k % 2 == 1)) && [ -e killed/scene.used.yaml ]; then # and again while it goes on
            "$PARTICLS" resume killed --quiet >>log 2>&1 &
            stop_after_a_while KILL $!
        fi
        finish killed
        same_results killed
        rm -r killed
    done
}

interrupt_runs() {
    for ((k = 0; k < (kills + 1) / 2; ++k)); do
        status=0
        "$PARTICLS" run "$scene" -o interrupted --quiet >>log 2>&1 &
        stop_after_a_while INT $!
        if ((status > 1)) && [ -e interrupted/scene.used.yaml ]; then
            echo "Ctrl-C: exit status $status instead of 0 or 1" >&2
            exit 1
        fi
        finish interrupted
        same_results interrupted
        rm -r interrupted
    done
}

extend_run() { # <first end> <end>: a run that ends early and is then asked for more has the series and frames of one that went on at once
    "$PARTICLS" run "$scene" -o extended --until "$1" --quiet
    "$PARTICLS" resume extended --until "$2" --quiet
    diff -r --brief reference/series extended/series
    diff -r --brief reference/frames extended/frames
    rm -r extended
}

for scene in ${PARTICLS_SCENE:-grows.yaml equal.yaml}; do
    undisturbed
    kill_runs
    interrupt_runs
    case $scene in
        grows.yaml) extend_run 0.17 0.4 ;;
        equal.yaml) extend_run 0.07 0.12 ;;
    esac
    echo "$scene: $kills runs killed, $(((kills + 1) / 2)) interrupted: all ended like the undisturbed one"
    rm -rf reference
done
