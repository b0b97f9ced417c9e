#!/usr/bin/env bash
# Every example runs, shortened where it is long, and gives figures that are known from elsewhere.
# Runs in an empty folder with PARTICLS (the program) and PARTICLS_SOURCE (the source tree).
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

carry_out() { # <run directory> <example> <options...>
    local directory=$1 example=$2
    shift 2
    "$PARTICLS" run "$PARTICLS_SOURCE/examples/$example/scene.yaml" -o "$directory" --quiet --threads 1 "$@" || complain "$example does not run"
    grep -q '"finished": true' "$directory/summary.json" || complain "$example has not finished"
    if command -v gnuplot >/dev/null && [ -z "${PARTICLS_SANITIZE:-}" ]; then
        bash "$PARTICLS_SOURCE/examples/$example/plot.sh" "$directory" >plot.log 2>&1 || complain "$example cannot be plotted: $(cat plot.log)"
    fi
}

# An example that is not listed here would go untested.
for scene in "$PARTICLS_SOURCE"/examples/*/scene.yaml; do
    example=$(basename "$(dirname "$scene")")
    grep -q "^carry_out [a-z-]* $example" "$0" || complain "examples/$example is not tested"
    for file in README.md plot.sh; do
        [ -e "$(dirname "$scene")/$file" ] || complain "examples/$example has no $file"
    done
done

carry_out compression uniaxial-compression --set time.end=0.005 --set observe[0].every=0.001 --set observe[1].every=0.001 \
    --set observe[3].every=0.001
carry_out impact two-spheres
carry_out head-on two-spheres --set vars.w=0
carry_out growth dilating-sphere
carry_out cooling temperature-stiffness

"$PARTICLS" check "$PARTICLS_SOURCE/examples/uniaxial-compression/scene.yaml" --no-timing --set time.dt=3e-5 >check.txt || complain "check of the compression fails"
grep -q "That is a bound from single bodies" check.txt || complain "check does not say why it accepts a step above its bound"

python3 - <<'PYTHON' || failures=$((failures + 1))
import csv, json, math

def series(path):
    rows = list(csv.reader(open(path)))
    names = [name.split(" [")[0] for name in rows[0]]
    return [dict(zip(names, map(float, row))) for row in rows[1:]]

def near(what, value, expected, tolerance):
    assert abs(value - expected) <= tolerance, f"{what} is {value}, expected {expected} +- {tolerance}"

# Compression: nothing stirs before the plate arrives, which moves at 0.35 m/s.
summary = json.load(open("compression/summary.json"))
assert summary["bodies"] == 22 * 25 * 30 + 6, summary["bodies"]
for row in series("compression/series/all.csv"):
    near("kinetic energy", row["energy_kinetic"], 0, 1e-18)
for row in series("compression/series/top.csv"):
    near("place of the plate", row["position_z"], 1 - 0.35 * row["time"], 1e-12)

# Head-on impact of two linear viscoelastic spheres: e = exp(-pi beta/omega), momentum kept.
mass = 4 / 3 * math.pi * 0.01**3 * 2500
beta = 0.5 * 10 / (mass / 2)
omega = math.sqrt(1e6 / (mass / 2) - beta**2)
left, right = series("head-on/series/left.csv"), series("head-on/series/right.csv")
near("restitution", (right[-1]["velocity_x"] - left[-1]["velocity_x"]) / 2, math.exp(-math.pi * beta / omega), 1e-3)
touching = [row["time"] for row in left if row["force_x"] != 0]
near("contact time", touching[-1] - touching[0], math.pi / omega, 1.5e-6)
sums = series("impact/series/sums.csv")
for name, scale in (("momentum_x", mass), ("momentum_y", mass), ("angular_momentum_z", mass * 0.01)):
    near(name, sums[-1][name], sums[0][name], 1e-9 * scale)
near("energy, dissipated energy included", sums[-1]["energy_total"], mass * 1.25, 1e-5 * mass)

# The growing disc: its radius is 1 + t, the others move out of its way and nothing pushes the whole.
for row in series("growth/series/discs.csv"):
    discs = [[row[f"{k}.{name}"] for name in ("position_x", "position_y", "radius")] for k in range(25)]
    near("radius", discs[12][2], 1 + row["time"], 1e-9)
    deepest = max(a[2] + b[2] - math.dist(a[:2], b[:2]) for k, a in enumerate(discs) for b in discs[:k])
    assert deepest < 0.1, f"overlap {deepest} at t = {row['time']}"
for row in series("growth/series/sums.csv"):
    near("momentum", math.hypot(row["momentum_x"], row["momentum_y"]), 0, 1e-12)

# The ball rests where the spring, as stiff as the temperature makes it, carries its weight.
weight = 9.81 * 1000 * 4 / 3 * math.pi * 0.05**3
for row in series("cooling/series/ball.csv"):
    warmth = math.exp(-row["time"] / 1.5)
    if row["time"] > 2: near("overlap", (0.05 - row["position_z"]) * (2e4 - 1.8e4 * warmth) / weight, 1, 1e-3)
PYTHON

[ $failures -eq 0 ] || exit 1
