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
    [[ " $* " == *" --until "* ]] || grep -q '"finished": true' "$directory/summary.json" || complain "$example has not finished"
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
carry_out polygons polygons
carry_out polyhedra polyhedra
# Prisms of height 1 whose middles are at z = 0 are the polygons, which are 1 thick.
tall=()
for stone in red a b c d e f g h; do tall+=(--set "shapes.$stone.prism.height=1"); done
carry_out prisms polyhedra --set vars.stand=0 --set bodies[red].velocity=[0.25,0.24,0] "${tall[@]}"
carry_out flat polygons --set contact[0].faces=manifold
# Some grains of the hopper and of the heaps, on a smaller bed.
carry_out hopper hopper --set bodies[grains].place.lattice.count=[3,3,6] --set bodies[grains].place.lattice.corner=[-0.02565,-0.02565,0.03] \
    --set vars.open=0.15 --set time.end=0.45 --set observe[2].every=0.05
carry_out heaps sand-pile --set bodies[balls].place.lattice.count=[3,3,8] --set bodies[balls].place.lattice.corner=[-0.21875,-0.01875,0.005] \
    --set bodies[stones].place.lattice.count=[3,3,8] --set bodies[stones].place.lattice.corner=[0.1757,-0.0243,0.005] \
    --set bodies[bed].place.hex_pack.count=[64,16,1] --set bodies[bed].place.hex_pack.corner=[-0.32,-0.07,-0.01] \
    --set vars.lift=0.2 --set vars.speed=0.3 --set time.end=0.75 --set time.dt=2e-4

# Coarse points carry less at the edge of the hole, so the plate is softer.
carry_out plate plate-with-hole --set vars.n=41 --set materials.solid.young_modulus=12

# Sanitizers see the continua for some steps only: what comes of them is looked at in the other build.
some() { [ -z "${PARTICLS_SANITIZE:-}" ] || echo "--until $1"; }
carry_out hanging cantilever-2d --set time.end=12000 $(for k in 0 1 2 3 4 5 6 7; do echo --set observe[$k].every=2000; done) --set observe[8].every=12000 $(some 200)
carry_out bars cantilever-3d --set time.end=4.5 --set observe[3].every=1 $(some 0.2)
carry_out notches kalthoff-winkler --set vars.dx=0.2/100 $(some 2e-5)
carry_out shot impact --set vars.dx=1e-3 $(some 2e-5)
carry_out ridge ice-ridge --set time.end=3.5 --set observe[1].every=0.145 $(some 0.1)
carry_out branches branching $(some 5e-6)
carry_out quench quenched-plate --set vars.dx=4e-4 --set time.end=0.05 --set observe[1].every=0.005 $(some 0.005)

"$PARTICLS" check "$PARTICLS_SOURCE/examples/uniaxial-compression/scene.yaml" --no-timing --set time.dt=3e-5 >check.txt || complain "check of the compression fails"
grep -q "That is a bound from single bodies" check.txt || complain "check does not say why it accepts a step above its bound"

python3 - <<'PYTHON' || failures=$((failures + 1))
import csv, json, math, os, re

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

# Polygons and prisms: nothing outside acts on them, and friction and dashpots get what motion loses. The mass comes from the shoelace formula.
def corners(example, name):
    scene = open(os.path.join(os.environ["PARTICLS_SOURCE"], "examples", example, "scene.yaml")).read()
    points = re.search(rf"^  {name}: .*points: \[(\[.*\])\]", scene, re.M).group(1)
    points = [tuple(map(float, point.split(","))) for point in re.findall(r"\[([^][]*)\]", points)]
    return points if area(points)[0] > 0 else points[::-1]

def area(points):
    double = [a[0] * b[1] - a[1] * b[0] for a, b in zip(points, points[1:] + points[:1])]
    middle = [sum((a[k] + b[k]) * w for a, b, w in zip(points, points[1:] + points[:1], double)) / sum(double) / 3 for k in range(2)]
    return sum(double) / 2, middle

for example, height, bound in (("polygons", 1, 2e-5), ("polyhedra", 0.25, 2e-4)):
    rows = series(f"{example}/series/sums.csv")
    mass = area(corners(example, "red"))[0] * height
    near(f"momentum of {example}", rows[0]["momentum_x"], 0.25 * mass, 1e-12)
    for row in rows:
        for name in row:
            if "momentum" in name: near(f"{name} of {example}", row[name], rows[0][name], 1e-12)
        near(f"energy of {example}", row["energy_total"] / rows[0]["energy_total"], 1, bound)
    assert rows[-1]["energy_damped"] > 0 and rows[-1]["energy_slid"] > 0

names = ["red", *"abcdefgh"]
outline = [(corners("polygons", name), area(corners("polygons", name))[1]) for name in names]
def placed(row, k):
    angle = 2 * math.atan2(row[f"{k}.orientation_z"], row[f"{k}.orientation_w"])
    points, middle = outline[k]
    turned = [(math.cos(angle) * (x - middle[0]) - math.sin(angle) * (y - middle[1]),
               math.sin(angle) * (x - middle[0]) + math.cos(angle) * (y - middle[1])) for x, y in points]
    return [(x + row[f"{k}.position_x"], y + row[f"{k}.position_y"]) for x, y in turned]

def depth_along_edges(A, B):
    """The least depth of B under the edges of A: convex shapes that overlap have it positive for both."""
    least = math.inf
    for p, q in zip(A, A[1:] + A[:1]):
        normal = ((q[1] - p[1]) / math.dist(p, q), (p[0] - q[0]) / math.dist(p, q))
        least = min(least, max(normal[0] * (p[0] - b[0]) + normal[1] * (p[1] - b[1]) for b in B))
    return least

for row in series("polygons/series/places.csv"):
    outlines = [placed(row, k) for k in range(9)]
    for k, A in enumerate(outlines):
        for B in outlines[:k]:
            overlap = min(depth_along_edges(A, B), depth_along_edges(B, A))
            assert overlap < 5e-4, f"polygons overlap by {overlap} at t = {row['time']}"
for flat, prism in zip(series("flat/series/places.csv"), series("prisms/series/places.csv")):
    for k in range(9):
        for axis in "xy": near(f"place of prism {k}", prism[f"{k}.position_{axis}"], flat[f"{k}.position_{axis}"], 1e-4)
        near(f"height of prism {k}", prism[f"{k}.position_z"], 0, 1e-4)

# Hopper: grains are above the opening, within the funnel, or below it, within the tray; mass is neither lost nor gained, and no energy comes up when nothing is driven any more.
for row, out in zip(series("hopper/series/grains.csv"), series("hopper/series/discharged.csv")[::5]):
    places = [[row[f"{k}.position_{axis}"] for axis in "xyz"] for k in range(54)]
    near("time", out["time"], row["time"], 1e-9)
    assert sum(z < 0 for x, y, z in places) == out["bodies"], f"bodies below the opening at t = {row['time']}"
    for x, y, z in places:
        if z > 0: assert math.hypot(x, y) < min(0.035 + z, 0.095), f"a grain is outside the funnel at t = {row['time']}"
        else: assert abs(x) < 0.12 and abs(y) < 0.12 and z > -0.15, f"a grain is outside the tray at t = {row['time']}"
assert out["bodies"] > 50, "the grains do not flow out"
near("mean mass of a grain", out["mass"] / out["bodies"] / (2500 * math.pi / 6 * 1e-6), 1, 5e-3)
later = [row for row in series("hopper/series/all.csv") if row["time"] > 0.27]
taken = later[-1]["energy_damped"] + later[-1]["energy_slid"] - later[0]["energy_damped"] - later[0]["energy_slid"]
assert taken > 0.05
near("energy after the gate has stopped", later[-1]["energy_total"], later[0]["energy_total"], 0.02 * taken)

# The plate: nothing pushes the whole, its ends carry what eq. 37 puts on them, and it ends in two halves that part.
rows = series("plate/series/all.csv")
for row in rows:
    for axis in "xy": near("momentum of the plate", row[f"momentum_{axis}"], 0, 1e-14)
assert rows[10]["energy_bonds"] > 0 and rows[10]["energy_broken"] == 0 and rows[-1]["energy_broken"] > 1e-6, rows[-1]
assert rows[-1]["energy_kinetic"] > 100 * rows[20]["energy_kinetic"], "the halves do not part"
last = rows[-1]
assert rows[0]["fragments"] == 1 and last["fragments"] >= 2, last
near("a half by the other", last["fragment_second"] / last["fragment_largest"], 1, 1e-9)
assert last["fragment_largest"] > 0.45 * rows[0]["fragment_largest"], last
plate = json.load(open("plate/summary.json"))
assert 0 < plate["bonds_broken"] < 0.2 * plate["bonds"], plate

# Continua, where they ran to their ends.
def continua():
    # Cantilevers of the plane: the elastica under its own weight, EI theta'' = -q (L - s) cos(theta), by shooting.
    def elastica(load, n=400):
        low, high, h = 0.0, load, 1.0 / n
        for _ in range(60):
            start = c = (low + high) / 2
            a = y = 0.0
            for i in range(n):
                middle, turn = a + h / 2 * c, c - h / 2 * load * (1 - i * h) * math.cos(a)
                y += h * math.sin(middle)
                a += h * turn
                c -= h * load * (1 - (i + 0.5) * h) * math.cos(middle)
            if c > 0: high = start
            else: low = start
        return y
    for stiffness in (8, 31, 125, 1000):
        rows = series(f"hanging/series/tip_{stiffness}.csv")
        sunk = rows[0]["position_y"] - rows[-1]["position_y"]
        near(f"tip at E = {stiffness} Pa", sunk / elastica(2e-6 / (stiffness * math.pi / 4 * 1e-8)), 1, 0.01)

    # Bars of space: more beams are stiffer; nothing is damped.
    lowest = {bar: min(row["38.position_z"] for row in series(f"bars/series/{bar}_tip.csv")) for bar in ("near", "far")}
    assert -1 < lowest["near"] < -0.8 < -0.5 < lowest["far"] < -0.4, lowest
    rows = series("bars/series/all.csv")
    near("energy of the bars", rows[-1]["energy_total"], rows[0]["energy_total"], 1e-3 * max(row["energy_kinetic"] for row in rows))

    # What breaks: energy is kept, and momentum where nothing holds.
    for run, energies, part in (("notches", "all", 0.01), ("shot", "all", 0.01)):
        rows = series(f"{run}/series/{energies}.csv")
        near(f"energy of {run}", rows[-1]["energy_total"], rows[0]["energy_total"], part * rows[0]["energy_kinetic"])
        assert rows[0]["energy_broken"] == 0 and rows[-1]["energy_broken"] > 1e-3 * rows[0]["energy_kinetic"], run
    for axis in "xyz":
        near("momentum of sphere and disc", rows[-1][f"momentum_{axis}"], rows[0][f"momentum_{axis}"], 1e-13)
    assert series("shot/series/disc.csv")[-1]["fragments"] > 10
    rows = series("ridge/series/all.csv")
    assert rows[0]["fragments"] == 2 and rows[-1]["fragments"] > 3, rows[-1]["fragments"]
    rows = series("branches/series/all.csv")
    assert rows[10]["energy_broken"] == 0 < rows[-1]["energy_broken"], rows[10]
    for row in rows: near("momentum of the branching plate", row["momentum_y"], 0, 1e-10)
    quench = json.load(open("quench/summary.json"))
    assert 0.002 * quench["bonds"] < quench["bonds_broken"] < 0.3 * quench["bonds"], quench
if not os.environ.get("PARTICLS_SANITIZE"): continua()

# Heaps: cones of mean height h/4 and mean radius R/2; stones are steeper than balls; nothing falls through the bed or is lost.
slope = {}
for heap in ("balls", "stones"):
    rows = series(f"heaps/series/{heap}.csv")
    for row in rows: assert all(row[f"{k}.position_z"] > -0.0055 for k in range(72)), f"{heap} fall through the ground"
    places = [[rows[-1][f"{k}.position_{axis}"] for axis in "xyz"] for k in range(72)]
    middle = [sum(place[axis] for place in places) / 72 for axis in range(2)]
    distance = sum(math.hypot(x - middle[0], y - middle[1]) for x, y, z in places)
    slope[heap] = math.degrees(math.atan(2 * sum(z for x, y, z in places) / distance))
assert 8 < slope["balls"] < 20 and slope["balls"] + 1 < slope["stones"] < 35, slope  # by 2 to 3 degrees in heaps as small as these
PYTHON

[ $failures -eq 0 ] || exit 1
