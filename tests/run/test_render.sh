#!/usr/bin/env bash
# particls render from outside: pictures of scenes, runs, frames and checkpoints, series, messages that help. Pictures are judged by their pixels, never by golden files.
# Runs in an empty folder with PARTICLS (the program).
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

expect() { # <exit status> <words of the output> <arguments of render...>
    local wanted=$1 words=$2 output status
    shift 2
    output=$("$PARTICLS" render "$@" 2>&1 </dev/null)
    status=$?
    if [ $status -ne "$wanted" ]; then
        complain "particls render $*: exit status $status instead of $wanted: $output"
    elif ! grep -qF -- "$words" <<<"$output"; then
        complain "particls render $*: '$words' is not in the output: $output"
    fi
}

cat >scene.yaml <<'YAML'
particls: 1
materials:
  grain: {density: 1000}
shapes:
  ball: {sphere: {radius: 0.1}}
  brick: {box: {half: [0.1, 0.1, 0.1]}}
  bar: {capsule: {radius: 0.03, length: 0.2}}
  cross: {compound: {parts: [{shape: bar, position: [0, 0, 0.04]}, {shape: bar, position: [0, 0, -0.04], orientation: {axis: [0, 0, 1], angle: 0.7}}]}}
  wall: {plane: {}}
bodies:
  - {name: left, shape: ball, material: grain, position: [-0.5, 0, 0.3], velocity: [1, 0, 0]}
  - {name: middle, shape: brick, material: grain, position: [0, 0, 0.3], velocity: [0, 0, -2]}
  - {name: right, shape: cross, material: grain, position: [0.5, 0, 0.3], velocity: [0, 0, 3]}
  - {name: ground, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
contact:
  - {between: [grain, grain], law: elastic, kn: 10000}
time: {end: 0.03, dt: 1.0e-4}
observe:
  - {frames: vtk, name: film, every: 0.01}
YAML
cat >flat.yaml <<'YAML'
particls: 1
dimension: 2
materials:
  grain: {density: 1000}
shapes:
  disc: {sphere: {radius: 1}}
  stone: {polygon: {points: [[-1, -1], [1, -1], [1, 1], [-1, 1]]}}
  fence: {polyline: {points: [[-4, -2], [4, -2]]}}
  ground: {plane: {}}
bodies:
  - {name: disc, shape: disc, material: grain, position: [-2, 0]}
  - {name: stone, shape: stone, material: grain, position: [2, 0]}
  - {name: fence, shape: fence, material: grain, position: [0, 0], fixed: true}
  - {name: below, shape: ground, material: grain, position: [0, -3], normal: [0, 1]}
contact:
  - {between: [grain, grain], law: elastic, kn: 10000}
time: {end: 0.01, dt: 1.0e-4}
YAML

# A scene before its first step.
expect 0 "start.png: 640 x 360, 3 bodies, t = 0 s" scene.yaml -o start.png --size 640x360 --view -y
expect 0 "scene.png: 1280 x 720" scene.yaml
expect 0 "flat.png: 320 x 200, 3 bodies" flat.yaml --size 320x200 --walls solid
expect 0 "2 bodies" scene.yaml -o hidden.png --hide left --view -y --size 160x120
expect 0 "" scene.yaml -o moved.png --set 'bodies[0].scale=2' --view -y --size 160x120 --no-bar

# A run: its last frame, any other, a file of it, a checkpoint.
"$PARTICLS" run scene.yaml -o out --quiet || complain "the scene does not run"
expect 0 "t = 0.03 s, velocity 0 to 3 m/s" out -o last.png --view -y --size 640x360
expect 0 "t = 0.01 s" out -o one.png --frame 1 --size 64x48
expect 0 "t = 0.02 s" out -o one.png --frame -2 --size 64x48
expect 0 "t = 0.02 s" out -o one.png --time 0.0231 --size 64x48
expect 0 "t = 0.02 s" out/frames/film_000002.vtp -o one.png --size 64x48
(cd out/frames && "$PARTICLS" render film_000001.vtp -o ../../two.png --size 64x48 --quiet) || complain "a frame cannot be drawn from its own folder"
expect 0 "t = 0.03 s, velocity.z -2 to 3 m/s" out/checkpoint/000000300.h5 -o check.png -c velocity.z --range -2:3 --size 64x48
expect 0 "kinetic energy" out/checkpoint/000000300.h5 -o check.png -c energy --size 64x48
expect 0 "velocity.z -3 to 3 m/s" out -o check.png -c velocity.z --size 64x48 # both signs: symmetric
for field in force radius number group shape material spin speed none torque; do
    expect 0 "field.png" out -o field.png -c $field --size 64x48
done
for view in iso x -x y -y z -z 1,-2,0.5; do expect 0 "view.png" out -o view.png --view=$view --size 64x48; done
expect 0 "view.png" out -o view.png --camera 3,-4,2:0,0,0.3 --zoom 2 --size 64x48 --section 0,0,1,0.3 --background '#102030' --map magma --no-shadows
expect 0 "view.png" out -o view.png --orthographic --background none --walls none --size 64x48

# The same picture from the frame and from the checkpoint of one instant, and on one and two threads.
"$PARTICLS" render out/checkpoint/000000300.h5 -o again.png --view -y --size 640x360 --quiet
cmp -s last.png again.png || complain "a frame and a checkpoint of the same instant give different pictures"
"$PARTICLS" render out -o threads.png --view -y --size 640x360 --threads 1 --quiet
"$PARTICLS" render out -o threads2.png --view -y --size 640x360 --threads 2 --quiet
cmp -s threads.png threads2.png || complain "one and two threads give different pictures"

# Series.
expect 0 "film.png: 4 pictures" out -o film.png --animate --fps 20 --size 160x90
expect 0 "each_000000.png ...: 4 pictures" out -o each.png --each --size 160x90
for k in 0 1 2 3; do [ -s each_00000$k.png ] || complain "each_00000$k.png is missing"; done

# Mistakes.
expect 2 "did you mean 'velocity'?" out -c velocty
expect 2 "no component 'q'" out -c velocity.q
expect 2 "fields: [mass]" out -c mass
expect 2 "did you mean 'transparent'?" out --walls transparant
expect 2 "FILE.png" out -o picture.jpg
expect 2 "--size takes" out --size big
expect 2 "--range takes" out --range 2:1
expect 2 "--camera takes" out --camera here
expect 2 "there is no frame 9" out --frame 9
expect 2 "give one of" out --frame 1 --animate
expect 2 "did you mean 'left'?" scene.yaml --hide lefd
expect 2 "no frames named 'film2'; there are: film" out --frames film2
expect 2 "cannot look at" not_there
expect 2 "must be a map" scene.yaml --set vars=3
mkdir -p empty
expect 2 "no scene.used.yaml" empty
cp out/scene.used.yaml empty/
expect 2 "neither frames nor checkpoints" empty
cp -r out bad
head -c 900 out/frames/film_000003.vtp >bad/frames/film_000003.vtp
expect 1 "film_000003.vtp" bad
expect 1 "no_folder" out -o no_folder/picture.png --size 64x48
expect 2 "can be changed in a scene" out --set title=other
expect 2 "is no run directory, frame" "$0"
if compgen -G '*.tmp' >/dev/null; then complain "a temporary file is left"; fi

command -v python3 >/dev/null || exit $((failures > 0))
python3 - <<'PYTHON' || failures=$((failures + 1))
import struct, zlib

def chunks(path):
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at = 8
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        yield name, data[at + 8:at + 8 + size]
        at += size + 12

def read(path):
    """Rows of (r, g, b, a), by the PNG specification."""
    packed = b""
    for name, data in chunks(path):
        if name == b"IHDR":
            width, height, depth, kind = struct.unpack(">IIBB", data[:10])
        if name == b"IDAT":
            packed += data
    assert depth == 8 and kind in (2, 6), (path, depth, kind)
    n = 3 if kind == 2 else 4
    raw, rows, before = zlib.decompress(packed), [], bytes(n * width)
    for y in range(height):
        line = bytearray(raw[y * (n * width + 1):(y + 1) * (n * width + 1)])
        how = line.pop(0)
        for x in range(n * width):
            a, b, c = (line[x - n] if x >= n else 0), before[x], (before[x - n] if x >= n else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[x] = (line[x] + (0, a, b, (a + b) // 2, paeth)[how]) & 255
        rows.append([tuple(line[n * x:n * x + n]) + (255,) * (4 - n) for x in range(width)])
        before = line
    return rows

def colours(rows, x0, x1):
    """Hue families of saturated pixels, as a count each."""
    found = {"red": 0, "yellow": 0, "green": 0, "blue": 0}
    for row in rows:
        for r, g, b, a in row[x0:x1]:
            if max(r, g, b) - min(r, g, b) < 60:
                continue
            if b == max(r, g, b):
                found["blue"] += 1
            elif g == max(r, g, b) and g > 1.3 * r:
                found["green"] += 1
            elif r > 1.5 * g:
                found["red"] += 1
            else:
                found["yellow"] += 1
    return found

# At the start colours tell groups, in order of the scene: orange, light blue, green; each where its body is.
rows = read("start.png")
assert len(rows) == 360 and len(rows[0]) == 640
bar = 640 - 110 # where the bar and its names begin, at the latest
left, middle, right = (colours(rows, 0, bar // 3), colours(rows, bar // 3, 2 * bar // 3), colours(rows, 2 * bar // 3, bar))
assert left["yellow"] + left["red"] > 500 and left["blue"] + left["green"] == 0, left
assert middle["blue"] > 500 and middle["green"] + middle["red"] == 0, middle
assert right["green"] > 500 and right["blue"] + right["red"] == 0, right

# In the run they tell speed: viridis from 1 of 3 (blue) by 2 of 3 (green) to 3 of 3 (yellow).
rows = read("last.png")
left, middle, right = (colours(rows, 0, bar // 3), colours(rows, bar // 3, 2 * bar // 3), colours(rows, 2 * bar // 3, bar))
assert left["blue"] > 500 and left["yellow"] == 0, left
assert middle["green"] > 500 and middle["yellow"] + middle["blue"] < 20, middle
assert right["yellow"] > 500 and right["blue"] + right["green"] < 20, right

# In 2D the half-plane fills the bottom, the background is white above, and the line of the fence is drawn between.
rows = read("flat.png")
assert rows[0][5] == (255, 255, 255, 255), rows[0][5]
assert rows[-1][100] != (255, 255, 255, 255)
column = [row[110] for row in rows]
runs = [p != (255, 255, 255, 255) for p in column]
assert sum(1 for a, b in zip([False] + runs, runs) if b and not a) == 2, "the fence and the ground are two strokes down the middle"

# A hidden body is not there.
found = colours(read("hidden.png"), 0, 50)
assert found["yellow"] + found["red"] == 0 or found["blue"] > 0, found

# Frames of the animation: counted in acTL, each with its control and data, 50 ms each.
frames, controls, parts = 0, [], 0
for name, data in chunks("film.png"):
    if name == b"acTL":
        frames, plays = struct.unpack(">II", data)
        assert plays == 0
    if name == b"fcTL":
        controls.append(struct.unpack(">IIIIIHHBB", data))
assert frames == 4 and len(controls) == 4, (frames, len(controls))
assert all(c[5] / c[6] == 0.05 and c[1:3] == (160, 90) for c in controls), controls

# No two pictures of a series are alike.
assert all(read(f"each_00000{k}.png") != read(f"each_00000{k + 1}.png") for k in range(3))
PYTHON
exit $((failures > 0))
