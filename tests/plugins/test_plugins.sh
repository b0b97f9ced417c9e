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
warnings=(-Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Werror)
"$CC" "${flags[@]}" "${warnings[@]}" "$PARTICLS_SOURCE/plugins/template/my_law.c" -o my_law.so || complain "the template does not compile"
"$CC" "${flags[@]}" "${warnings[@]}" "$PARTICLS_SOURCE/plugins/cohesion/linear_cohesion.c" -o linear_cohesion.so || complain "linear_cohesion does not compile"

# A loose heap that falls on a floor and slides: all that a law can do.
heap() { # <law> <further parameters>
    cat <<YAML
particls: 1
plugins: [./my_law.so, ./linear_cohesion.so]
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

for scene in elastic my_law viscoelastic no_cohesion cohesion ceiling_2 ceiling_0.5; do
    "$PARTICLS" run $scene.yaml -o $scene --quiet --threads 1 || complain "$scene does not run"
done

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
PYTHON

# The C pieces of docs/extending.md: those that begin with a file name are whole programs or plugins.
awk '/^```c$/ {inside = 1; next} /^```$/ {inside = 0; file = ""} inside && /^\/\/ [a-z_]+\.c/ && !file {file = $2; sub(/:$/, "", file)} inside && file {print > file}' \
    "$PARTICLS_SOURCE/docs/extending.md"
sanitize=()
if [ -n "${PARTICLS_SANITIZE:-}" ]; then sanitize=("-fsanitize=$PARTICLS_SANITIZE"); fi
for source in square.c drop.c observed.c; do
    if [ ! -s $source ]; then
        complain "docs/extending.md has no $source"
    elif [ $source = square.c ]; then
        "$CC" "${flags[@]}" -Wall -Wextra -Werror $source -o square.so || complain "$source of docs/extending.md does not compile"
    else
        "$CC" -std=gnu17 -Wall -Wextra -Werror "${sanitize[@]}" -I"$PARTICLS_SOURCE/include" $source -o "${source%.c}" -L"$PARTICLS_BUILD/lib" -lparticls -lm \
            "-Wl,-rpath,$PARTICLS_BUILD/lib" || complain "$source of docs/extending.md does not compile"
    fi
done
sed 's/law: my_law/law: square/; s/kn: 1.0e4, ks: 4000, friction: 0.4/kn: 1.0e6/; s/^plugins: .*/plugins: [.\/square.so]/' my_law.yaml >scene.yaml
"$PARTICLS" run scene.yaml -o square --quiet --threads 1 || complain "the law of docs/extending.md does not run"
fallen=$(./drop) || complain "drop of docs/extending.md fails"
grep -q "^t = 1 s" <<<"$fallen" || complain "drop of docs/extending.md prints $fallen"
./observed scene.yaml out >observed.txt || complain "observed of docs/extending.md fails"
[ "$(wc -l <observed.txt)" -ge 4 ] || complain "observed of docs/extending.md saw nothing"

[ $failures -eq 0 ] || exit 1
