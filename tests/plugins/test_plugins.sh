#!/usr/bin/env bash
# The plugins of plugins/ and the C pieces of docs/extending.md compile without a warning and do what they say.
# Runs in an empty folder with PARTICLS, PARTICLS_SOURCE, PARTICLS_BUILD, CC and PARTICLS_SANITIZE.
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

read -r -a flags <<<"$("$PARTICLS" plugin --cflags)"

# A program that was copied away from its headers says where it looked; one that finds those of another version does not take them.
here=$(pwd -P)
mkdir -p copy/bin 'with space/bin'
cp "$PARTICLS" copy/bin/particls
library=$(dirname "$(ldd "$PARTICLS" | sed -n 's/.*=> \(.*libparticls[^ ]*\).*/\1/p')")
refuses() { # <program> <word>...: it fails, prints no flags, and says all of the words
    local program=$1 word
    shift
    if LD_LIBRARY_PATH=$library "$program" plugin --cflags >flags.txt 2>said.txt; then complain "$program prints flags: $(cat flags.txt)"; fi
    [ ! -s flags.txt ] || complain "$program prints flags and fails"
    for word in "$@"; do grep -qF -- "$word" said.txt || complain "'$word' is not in: $(cat said.txt)"; done
}
refuses copy/bin/particls "$here/copy/bin" "/copy/bin/../include: there is no particls/types.h"
mkdir -p copy/include/particls
echo '#define PLS_API_VERSION 1' >copy/include/particls/types.h
refuses copy/bin/particls "$here/copy/include: headers of API 1, the program has "
cp copy/bin/particls 'with space/bin/particls'
cp -r "$PARTICLS_SOURCE/include" 'with space/include'
refuses 'with space/bin/particls' "-I'$here/with space/include'"
rm -r copy/include
cp -r "$PARTICLS_SOURCE/include" copy/include
[[ "$(LD_LIBRARY_PATH=$library copy/bin/particls plugin --cflags)" == *" -I$here/copy/include" ]] || complain "a program moved with its headers does not find them"
ln -s "$PARTICLS" linked
[ "$(./linked plugin --cflags)" = "$("$PARTICLS" plugin --cflags)" ] || complain "a link to the program does not find the headers"
warnings=(-Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Werror)
for source in template/my_plugin cohesion/linear_cohesion torus/torus drag/stokes_drag temperature/granular_temperature; do
    "$CC" "${flags[@]}" "${warnings[@]}" "$PARTICLS_SOURCE/plugins/$source.c" -o "${source#*/}.so" || complain "plugins/$source.c does not compile"
    "$PARTICLS" info "${source#*/}.so" >info.txt || complain "the plugin of plugins/$source.c cannot be described"
    grep -q '^### ' info.txt || complain "the plugin of plugins/$source.c brings nothing"
done

# A shape whose SDF lies: the scene's line, the shape's name once, the reason with the point and the value.
sed -e 's/- shape->values\[TUBE\];/+ shape->values[TUBE];/' "$PARTICLS_SOURCE/plugins/torus/torus.c" >lie.c
"$CC" "${flags[@]}" lie.c -o lie.so || complain "the SDF that lies does not compile"
cat >lie.yaml <<'YAML'
particls: 1
plugins: [./lie.so]
materials: {grain: {density: 2000}}
shapes:
  ring: {torus: {ring_radius: 0.3, tube_radius: 0.1}}
bodies: [{shape: ring, material: grain, position: [0, 0, 0]}]
time: {end: 1, dt: 1.0e-3}
YAML
"$PARTICLS" check lie.yaml >said.txt 2>&1 && complain "an SDF that is nowhere negative is taken"
for line in "^particls: lie.yaml:5:9: the SDF of shape 'ring' is nowhere negative: the least value found is 0.1 m, at (.*) m; inside it must be negative$" \
    '^    5 |   ring: {torus: {ring_radius: 0.3, tube_radius: 0.1}}$' '^      |         ^$'; do
    grep -q -- "$line" said.txt || complain "of an SDF that lies is said: $(cat said.txt)"
done

# A loose heap that falls on a floor and slides: all that a law can do.
heap() { # <law> <further parameters>
    cat <<YAML
particls: 1
plugins: [./my_plugin.so, ./linear_cohesion.so]
materials: {grain: {density: 2000}}
shapes:
  ball: {sphere: {radius: 0.05}}
  floor: {plane: {}}
bodies:
  - {name: heap, shape: ball, material: grain, velocity: ["y - x", "0.3*x", -1],
     place: {random: {count: 60, box: {lower: [0, 0, 0], upper: [1, 1, 0.8]}, radius: {uniform: [0.03, 0.06]}}}}
  - {name: ground, shape: floor, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
contact:
  - {between: all, law: $1, kn: 1.0e4, ks: 4000, friction: 0.4$2}
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.4, dt: 1.0e-4}
observe:
  - {particle: heap, quantities: [position, velocity, angular_velocity], every: 0.1}
  - {collection: all, name: sums, quantities: [energy], every: 0.01}
YAML
}
heap elastic "" >elastic.yaml
heap my_law "" >my_law.yaml
heap viscoelastic ", cn: 2, cs: 1" >viscoelastic.yaml
heap linear_cohesion ", cn: 2, cs: 1, cohesion: 0" >no_cohesion.yaml
heap linear_cohesion ", cohesion: 0.3" >cohesion.yaml

# A ball under a ceiling: f0 = twice its weight holds it at delta = (f0 - m g)/kn, half of its weight does not.
for factor in 2 0.5; do
    cat >ceiling_$factor.yaml <<YAML
particls: 1
plugins: [./linear_cohesion.so]
vars: {weight: 9.81*1000*4/3*pi*0.1^3}
materials: {grain: {density: 1000}}
shapes:
  ball: {sphere: {radius: 0.1}}
  flat: {plane: {}}
bodies:
  - {name: ball, shape: ball, material: grain, position: [0, 0, -0.0985]}
  - {name: ceiling, shape: flat, material: grain, position: [0, 0, 0], normal: [0, 0, -1]}
contact:
  - {between: all, law: linear_cohesion, kn: 2.0e4, cn: 200, cohesion: "$factor*weight"}
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 1, dt: 2.0e-4}
observe: [{particle: ball, quantities: [position], every: 0.1}]
YAML
done

# A slow pull F = rate t on a ball that adheres to a ceiling: it comes off when F = f0, and the pull has then done the work f0^2/(2 kn).
cat >pull.yaml <<'YAML'
particls: 1
plugins: [./linear_cohesion.so]
vars: {kn: 1.0e4, f0: 2, rate: 2}
materials: {grain: {density: 1}}
shapes:
  ball: {sphere: {radius: 0.1}}
  flat: {plane: {}}
bodies:
  - {name: ball, shape: ball, material: grain, position: [0, 0, "-0.1 + f0/kn"]}
  - {name: ceiling, shape: flat, material: grain, position: [0, 0, 0], normal: [0, 0, -1]}
contact:
  - {between: all, law: linear_cohesion, kn: kn, cn: 2, cohesion: f0}
forces: [{field: {force: [0, 0, "-rate*t"]}}]
time: {end: 1.05, dt: 1.0e-4}
observe: [{particle: ball, quantities: [position], every: 0.001}]
YAML

# A body falls through a fluid; another is carried along by a flow that swings; a third, of another entry, feels nothing.
cat >drag.yaml <<'YAML'
particls: 1
plugins: [./stokes_drag.so]
vars: {eta: 0.5}
materials: {grain: {density: 2000}}
shapes: {ball: {sphere: {radius: 0.01}}}
bodies:
  - {name: falling, shape: ball, material: grain, position: [0, 0, 0], angular_velocity: [0, 7, 0]}
  - {name: carried, shape: ball, material: grain, position: [1, 0, 0]}
  - {name: free, shape: ball, material: grain, position: [2, 0, 0], velocity: [0, 1, 0]}
forces:
  - {stokes_drag: {viscosity: eta, bodies: falling}}
  - {stokes_drag: {viscosity: eta, flow: ["0.3*sin(20*t)", 0, 0], bodies: carried}}
  - {field: {acceleration: [0, 0, -9.81], bodies: falling}}
time: {end: 1.6, dt: 1.0e-4}
observe:
  - {particle: falling, quantities: [velocity, angular_velocity, mass], every: 0.02}
  - {particle: carried, quantities: [velocity, mass], every: 0.02}
  - {particle: free, quantities: [velocity], every: 0.02}
YAML

# Two clouds collide; centre of mass and temperature of one of them, of both, and in the plane. The template's force holds all of them, its observer counts.
cat >cloud.yaml <<'YAML'
particls: 1
plugins: [./my_plugin.so, ./granular_temperature.so]
materials: {grain: {density: 2000}}
shapes: {ball: {sphere: {radius: 0.05}}}
bodies:
  - {name: left, shape: ball, material: grain, velocity: ["1 + 3*y", "z", "-x"],
     place: {random: {count: 30, box: {lower: [-1, -0.4, -0.4], upper: [-0.1, 0.4, 0.4]}, radius: {uniform: [0.03, 0.06]}}}}
  - {name: right, shape: ball, material: grain, velocity: ["-1", "x", "y"],
     place: {random: {count: 30, box: {lower: [0.1, -0.4, -0.4], upper: [1, 0.4, 0.4]}, radius: {uniform: [0.03, 0.06]}}}}
contact:
  - {between: all, law: my_law, kn: 1.0e5, ks: 4.0e4, friction: 0.4}
forces: [{my_force: {stiffness: 20, centre: [0.1, 0, 0]}}]
time: {end: 0.3, dt: 5.0e-5}
observe:
  - {particle: left, quantities: [position, velocity, mass], every: 0.01}
  - {particle: right, quantities: [position, velocity, mass], every: 0.01}
  - {granular_temperature: {bodies: left}, every: 0.01}
  - {granular_temperature: {}, every: 0.01, name: both}
  - {my_observer: {faster: 1.5, bodies: right}, every: 0.01}
  - {collection: all, name: sums, quantities: [energy], every: 0.01}
YAML
cat >plane.yaml <<'YAML'
particls: 1
dimension: 2
plugins: [./my_plugin.so, ./granular_temperature.so]
materials: {grain: {density: 2000}}
shapes: {ball: {sphere: {radius: 0.05}}}
bodies:
  - {name: a, shape: ball, material: grain, position: [0, 0], velocity: [1, 0]}
  - {name: b, shape: ball, material: grain, scale: 2, position: [1, 0], velocity: [-2, 3]}
forces: [{my_force: {stiffness: 20, centre: [0, 0], bodies: a}}]
time: {end: 0.5, dt: 1.0e-4}
observe:
  - {granular_temperature: {}, every: 0.1}
  - {particle: a, quantities: [position], every: 0.1}
YAML

# Two points that fly apart, joined by a bond that is softer where it is stretched.
cat >two.yaml <<'YAML'
particls: 1
plugins: [./my_plugin.so]
materials: {solid: {density: 1000, young_modulus: 1.0e6}}
shapes: {pair: {box: {half: [0.1, 0.05, 0.05]}}, point: {sphere: {radius: 0.04}}}
bodies: [{name: points, shape: point, material: solid, velocity: ["0.1*x", 0, 0], place: {fill: {region: pair, spacing: 0.1}}}]
contact: [{between: all, law: elastic, kn: 1}]
bonds: [{of: [points], law: my_bond, horizon: 0.15, tension: 0.2}]
time: {end: 0.0075, dt: 1.0e-5}
observe:
  - {particle: points, quantities: [position], every_steps: 1}
  - {collection: all, name: energies, quantities: [energy], every_steps: 10}
YAML

# A run that is stopped in the middle and resumed: rows, the summary and what observers remember are those of a run that was not.
"$PARTICLS" run cloud.yaml -o halves --until 0.146 --quiet --threads 1 && "$PARTICLS" resume halves --until 0.3 --quiet --threads 1 ||
    complain "the cloud cannot be resumed"

for scene in two pull drag cloud plane elastic my_law viscoelastic no_cohesion cohesion ceiling_2 ceiling_0.5; do
    "$PARTICLS" run $scene.yaml -o $scene --quiet --threads 1 || complain "$scene does not run"
done

for series in granular_temperature both my_observer sums left; do
    cmp -s cloud/series/$series.csv halves/series/$series.csv || complain "series $series differs after a run was resumed"
done
for key in observers state_hash; do
    sed -n "/\"$key\"/,\$p" cloud/summary.json >whole.txt
    sed -n "/\"$key\"/,\$p" halves/summary.json >halves.txt
    cmp -s whole.txt halves.txt || complain "the summary's $key differ after a run was resumed"
done

# The scene in force is the same scene.
"$PARTICLS" run cloud/scene.used.yaml -o again --quiet --threads 2 || complain "the used scene of the cloud does not run"
cmp -s cloud/series/both.csv again/series/both.csv || complain "the used scene of the cloud gives another series"
cmp -s cloud/scene.used.yaml again/scene.used.yaml || complain "the used scene of the cloud is not its own used scene"

# A mistyped parameter of a plugin's law gets the same help as one of a built-in law.
sed 's/friction/frictoin/' my_law.yaml >mistyped.yaml
"$PARTICLS" check mistyped.yaml >mistyped.txt 2>&1
grep -q "did you mean 'friction'?" mistyped.txt || complain "a mistyped parameter of a plugin's law is not explained"

python3 - <<'PYTHON' || failures=$((failures + 1))
import csv, math

def table(path):
    rows = list(csv.reader(open(path)))
    return rows[0], [[float(x) for x in row] for row in rows[1:]]

def same(a, b):
    (names, one), (_, other) = table(a + "/series/heap.csv"), table(b + "/series/heap.csv")
    assert len(one) == len(other) == 5
    for p, q in zip(one, other):
        for name, x, y in zip(names, p, q):
            assert abs(x - y) <= 1e-12 * max(1, abs(x)), f"{a} and {b} differ at t = {p[0]}: {name} {x} {y}"

# The same equations in the same order: the same motion to round-off, through hundreds of impacts.
same("elastic", "my_law")
same("viscoelastic", "no_cohesion")

# Cohesion without dashpots: energy, friction work included, stays.
names, rows = table("cohesion/series/sums.csv")
total = names.index("energy_total [J]")
assert max(abs(row[total] - rows[0][total]) for row in rows) < 1e-4 * rows[0][total], [row[total] for row in rows]

weight = 9.81 * 1000 * 4 / 3 * math.pi * 0.1**3
_, held = table("ceiling_2/series/ball.csv")
overlap = 0.1 + held[-1][3]
assert abs(overlap - weight / 2e4) < 1e-6 * 0.1, (overlap, weight / 2e4)
_, fallen = table("ceiling_0.5/series/ball.csv")
assert fallen[-1][3] < -4, fallen[-1]

# Pull-off: the overlap is (f0 - F)/kn until F = f0.
_, pull = table("pull/series/ball.csv")
kn, f0, rate = 1e4, 2.0, 2.0
off = next(row[0] for row in pull if row[3] < -0.1)
assert abs(rate * off - f0) < 2e-3 * f0, (rate * off, f0)
work = sum(rate * (b[0] + a[0]) / 2 * (a[3] - b[3]) for a, b in zip(pull, pull[1:]) if b[0] < off)
assert abs(work - f0**2 / (2 * kn)) < 2e-3 * f0**2 / (2 * kn), (work, f0**2 / (2 * kn))

# Half a period stretched, half a period compressed: k = 2 b V/xi^2 of both families, b = 6 E, times 0.2 where it is stretched; reduced mass m/2.
_, rows = table("two/series/points.csv")
gaps = [(row[0], row[4] - row[1] - 0.1) for row in rows]
turns = [a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1]) for a, b in zip(gaps[1:], gaps[2:]) if a[1] * b[1] < 0]
stiff = math.sqrt(2 * 6e6 * 1e-3 / 0.01 / 0.5)
assert abs(turns[0] / (math.pi / (math.sqrt(0.2) * stiff)) - 1) < 1e-4, turns
assert abs((turns[1] - turns[0]) / (math.pi / stiff) - 1) < 1e-4, turns
names, rows = table("two/series/energies.csv")
total = names.index("energy_total [J]")
assert max(abs(row[total] / rows[0][total] - 1) for row in rows) < 1e-4

# Stokes: v = -m g/c (1 - exp(-t/tau)), c = 6 pi eta r, tau = m/c; the spin decays with 8 pi eta r^3 / (2/5 m r^2).
eta, r, g = 0.5, 0.01, 9.81
m = 2000 * 4 / 3 * math.pi * r**3
c = 6 * math.pi * eta * r
tau = m / c
names, falling = table("drag/series/falling.csv")
column = {name.split(" ")[0]: k for k, name in enumerate(names)}
for row in falling:
    t = row[0]
    v = -m * g / c * (1 - math.exp(-t / tau))
    assert abs(row[column["velocity_z"]] - v) < 1e-5 * m * g / c, (t, row, v)
    w = 7 * math.exp(-8 * math.pi * eta * r**3 / (0.4 * m * r * r) * t)
    assert abs(row[column["angular_velocity_y"]] - w) < 1e-3 * 7, (t, row, w)
end = falling[-1][column["velocity_z"]]
# after 18 tau nothing of the start is left
assert abs(end / (-m * g / (6 * math.pi * eta * r)) - 1) < 1e-6, end

# v' = (u0 sin(f t) - v)/tau from rest: v = u0 (sin(f t) - f tau cos(f t) + f tau exp(-t/tau)) / (1 + f^2 tau^2)
_, carried = table("drag/series/carried.csv")
u0, f = 0.3, 20.0
for row in carried:
    t = row[0]
    v = u0 * (math.sin(f * t) - f * tau * math.cos(f * t) + f * tau * math.exp(-t / tau)) / (1 + (f * tau)**2)
    assert abs(row[1] - v) < 1e-5 * u0, (t, row[1], v)
_, free = table("drag/series/free.csv")
assert all(row[1:4] == [0, 1, 0] for row in free), free[-1]

# The same from the series of single particles.
def clouds(*entries):
    rows = []
    for entry in entries:
        names, table_of = table(f"cloud/series/{entry}.csv")
        rows.append([[line[k:k + 7] for k in range(1, len(line), 7)] for line in table_of])
        assert names[7].endswith("mass [kg]"), names[:9]
    return [sum(at, []) for at in zip(*rows)]

def temperature(bodies):
    mass = sum(b[6] for b in bodies)
    centre = [sum(b[6] * b[a] for b in bodies) / mass for a in range(3)]
    mean = [sum(b[6] * b[3 + a] for b in bodies) / mass for a in range(3)]
    return centre + mean + [sum(b[6] * (b[3 + a] - mean[a])**2 for b in bodies for a in range(3)) / (3 * mass)]

for name, bodies in (("granular_temperature", clouds("left")), ("both", clouds("left", "right"))):
    names, rows = table(f"cloud/series/{name}.csv")
    assert names == ["time [s]", "centre_x [m]", "centre_y [m]", "centre_z [m]", "velocity_x [m/s]", "velocity_y [m/s]",
                     "velocity_z [m/s]", "temperature [m^2/s^2]", "temperature_largest [m^2/s^2]"], names
    assert len(rows) == len(bodies) == 31
    largest = 0
    for row, now in zip(rows, bodies):
        known = temperature(now)
        largest = max(largest, known[-1])
        for value, wanted in zip(row[1:], known + [largest]):
            assert abs(value - wanted) < 1e-12 * max(1, abs(wanted)), (name, row[0], value, wanted)

names, rows = table("cloud/series/my_observer.csv")
largest = 0
for row, now in zip(rows, clouds("right")):
    speeds = [math.hypot(*b[3:6]) for b in now]
    fast = [s for s in speeds if s > 1.5]
    largest = max([largest] + fast)
    assert row[1] == len(fast) and abs(row[2] - sum(fast) / max(1, len(fast))) < 1e-12 and abs(row[3] - largest) < 1e-12, (row, len(fast))

# Springs to a point have a potential: with contacts that keep energy the sum of all energies stays.
names, rows = table("cloud/series/sums.csv")
total = names.index("energy_total [J]")
assert max(abs(row[total] - rows[0][total]) for row in rows) < 1e-4 * rows[0][total], [row[total] for row in rows]

# In the plane: no columns along z, D = 2. Body a swings about the origin: x = sin(omega t)/omega, omega^2 = k/m.
names, rows = table("plane/series/granular_temperature.csv")
assert [name.split(" ")[0] for name in names] == ["time", "centre_x", "centre_y", "velocity_x", "velocity_y", "temperature", "temperature_largest"]
# masses 1 : 4, velocities (1, 0) and (-2, 3): V = (-7/5, 12/5), T = (1 |(12/5, -12/5)|^2 + 4 |(-3/5, 3/5)|^2) / (2 * 5)
assert abs(rows[0][5] - (2 * 2.4**2 + 4 * 2 * 0.6**2) / 10) < 1e-12, rows[0]
omega = math.sqrt(20 / (2000 * math.pi * 0.05**2))
_, swings = table("plane/series/a.csv")
for row in swings:
    assert abs(row[1] - math.sin(omega * row[0]) / omega) < 1e-7, row
PYTHON

# The C pieces of docs/extending.md: those that begin with a file name are whole programs or plugins.
awk '/^```c$/ {inside = 1; next} /^```$/ {inside = 0; file = ""} inside && /^\/\/ [a-z_]+\.c/ && !file {file = $2; sub(/:$/, "", file)} inside && file {print > file}' \
    "$PARTICLS_SOURCE/docs/extending.md"
sanitize=()
if [ -n "${PARTICLS_SANITIZE:-}" ]; then sanitize=("-fsanitize=$PARTICLS_SANITIZE"); fi
for source in square.c wind.c fastest.c drop.c observed.c; do
    if [ ! -s $source ]; then
        complain "docs/extending.md has no $source"
    elif grep -q particls_plugin_api $source; then
        "$CC" "${flags[@]}" -Wall -Wextra -Werror $source -o "${source%.c}.so" || complain "$source of docs/extending.md does not compile"
    else
        "$CC" -std=gnu17 -Wall -Wextra -Werror "${sanitize[@]}" -I"$PARTICLS_SOURCE/include" $source -o "${source%.c}" -L"$PARTICLS_BUILD/lib" -lparticls -lm \
            "-Wl,-rpath,$PARTICLS_BUILD/lib" || complain "$source of docs/extending.md does not compile"
    fi
done
sed 's/law: my_law/law: square/; s/kn: 1.0e4, ks: 4000, friction: 0.4/kn: 1.0e6/; s/^plugins: .*/plugins: [.\/square.so, .\/wind.so, .\/fastest.so]/
    s/^forces: .*/forces: [{gravity: [0, 0, -9.81]}, {wind: {speed: "3*(1 - exp(-t))", bodies: heap}}]/' my_law.yaml >scene.yaml
echo '  - {fastest: {bodies: heap}, every: 0.1}' >>scene.yaml
"$PARTICLS" run scene.yaml -o square --quiet --threads 1 || complain "the plugins of docs/extending.md do not run"
[ "$(wc -l <square/series/fastest.csv)" -eq 6 ] || complain "the observer of docs/extending.md has not written a row per look"
fallen=$(./drop) || complain "drop of docs/extending.md fails"
grep -q "^t = 1 s" <<<"$fallen" || complain "drop of docs/extending.md prints $fallen"
./observed scene.yaml out >observed.txt || complain "observed of docs/extending.md fails"
[ "$(wc -l <observed.txt)" -ge 4 ] || complain "observed of docs/extending.md saw nothing"

# Rings fall on each other: no energy comes from nowhere, and threads change nothing.
cat >rings.yaml <<'YAML'
particls: 1
plugins: [./torus.so]
materials: {grain: {density: 2500}}
shapes: {ring: {torus: {ring_radius: 0.03, tube_radius: 0.01}}, wall: {plane: {}}}
bodies:
  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}
  - {name: low, shape: ring, material: grain, position: [0, 0, 0.02], orientation: {axis: [1, 0.3, 0], angle: 0.2}}
  - {name: high, shape: ring, material: grain, position: [0.01, 0.005, 0.06], orientation: {axis: [1, 1, 0], angle: 0.7}}
contact: [{between: all, law: viscoelastic, kn: 1.0e5, ks: 5.0e4, cn: 10, cs: 5, friction: 0.5}]
forces: [{gravity: [0, 0, -9.81]}]
time: {end: 0.3, dt: 2.0e-5}
observe: [{collection: all, name: sums, quantities: [energy], every: 0.01}]
YAML
for threads in 1 2; do
    "$PARTICLS" run rings.yaml -o "rings-$threads" --quiet --threads $threads || complain "rings on $threads threads failed"
done
[ "$(grep state_hash rings-1/summary.json)" = "$(grep state_hash rings-2/summary.json)" ] || complain "rings depend on threads"
awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /^energy_total/) column = k }
    NR == 2 { first = $column }
    NR > 2 { error = $column / first - 1; if (error < 0) error = -error; if (error > worst) worst = error }
    END { if (!(NR > 20 && column && worst < 1e-3)) { print "relative error of the energy of rings: " worst; exit 1 } }' rings-1/series/sums.csv >&2 ||
    complain "rings win or lose energy"

[ $failures -eq 0 ] || exit 1
