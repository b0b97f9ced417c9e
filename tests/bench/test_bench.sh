#!/usr/bin/env bash
# The benchmark programs run in small and print sound JSON; the state does not depend on the instruction set.
# Runs in an empty folder with PARTICLS_BUILD (the build tree).
set -euo pipefail

fail() { echo "test_bench.sh: $1" >&2; exit 1; }

run=("$PARTICLS_BUILD/bench/compression" --bodies 1000 --pressed 0.02 --steps 50)
"${run[@]}" >best.json
PARTICLS_ISA=v2 "${run[@]}" --threads 2 >v2.json
"$PARTICLS_BUILD/bench/broad_phase" 1000 100 >broad.json
"$PARTICLS_BUILD/bench/contact_query" box polyhedron32 20 5 >query.json
"$PARTICLS_BUILD/bench/polyhedra" --bodies 8 --steps 10 --faces point --state heap >polyhedra.json
"$PARTICLS_BUILD/bench/peridynamics" --side 8 --steps 10 >bonds.json
PARTICLS_ISA=v2 OMP_NUM_THREADS=2 "$PARTICLS_BUILD/bench/peridynamics" --side 8 --steps 10 >bonds2.json
PARTICLS_ISA=v3 OMP_NUM_THREADS=2 "$PARTICLS_BUILD/bench/peridynamics" --side 8 --steps 10 --law beam >beams2.json
"$PARTICLS_BUILD/bench/peridynamics" --side 8 --steps 10 --law beam >beams.json
"${run[@]}" --lammps-data packing.data >variables

# 9 x 10 x 12: the example's 22 : 25 : 30 with at least 1,000 spheres. Inside a hexagonal close packing a sphere has 12 neighbours, each contact has two ends;
# at the surface and towards the walls it has fewer.
python3 - <<'PYTHON' || fail "the JSON is not as it should be"
import json
best, v2, broad, query, polyhedra, bonds, bonds2, beams, beams2 = (json.load(open(name + ".json")) for name in ("best", "v2", "broad", "query", "polyhedra", "bonds", "bonds2", "beams", "beams2"))
assert best["counts"] == [9, 10, 12] and best["bodies"] == 1080 and best["steps"] == 50 and best["threads"] == 1, best
assert v2["threads"] == 2 and v2["state_hash"] == best["state_hash"], (best, v2)
assert 4 * 1080 < best["touching"] < 6.5 * 1080 and best["listed"] >= best["touching"], best
assert best["wall_s"] > 0 and abs(best["particle_steps_per_s"] * best["wall_s"] / (1080 * 50) - 1) < 0.01, best
assert best["bytes_per_body"] > 0 and best["bytes_per_contact"] > 0 and best["peak_bytes"] > 0 and best["skin"] > 0 and best["list_builds"] >= 1, best
assert broad["bodies"] == 1000 and broad["size_ratio"] == 100 and broad["pairs"] > 0 and broad["ns_per_body"] > 0, broad
# Poses are made to overlap; nobody's normal gives an overlap less than our depth.
assert query["touching"] > 0.9 and query["warm_ns"] > 0 and query["failures"] == 0 and query["cold_worst"] < 1e-9 and query.get("ours_above", 0) < 1e-9, query
assert polyhedra["bodies"] == 8 and polyhedra["particle_steps_per_s"] > 0, polyhedra
# Bonds: vectors from -3 to 3 of length up to 3.015, each as often as it fits into 8 x 8 x 8 points; beams along the edges of the lattice. The state depends on nothing but the job.
steps = [(i, j, k) for i in range(-3, 4) for j in range(-3, 4) for k in range(-3, 4) if 0 < i * i + j * j + k * k <= 9]
assert bonds["bonds"] == sum((8 - abs(i)) * (8 - abs(j)) * (8 - abs(k)) for i, j, k in steps) and beams["bonds"] == 6 * 7 * 64, (bonds, beams)
assert bonds["energy"] > 0 and beams["energy"] > 0 and bonds2["threads"] == 2 and bonds2["state_hash"] == bonds["state_hash"], (bonds, bonds2)
assert beams2["state_hash"] == beams["state_hash"], (beams, beams2)
# The heap: grains of 28 corners, no further apart than the longest diameter, 1 m.
lines = [list(map(float, line.split())) for line in open("heap")]
assert len(lines) == 9 and len(lines[0]) == 6, lines[0]
for numbers in lines[1:]:
    corners = [numbers[k:k + 3] for k in range(0, len(numbers), 3)]
    assert len(corners) == 28 and all(sum((a - b) ** 2 for a, b in zip(p, q)) < 1.0001 for p in corners for q in corners), numbers
PYTHON

[ "$(awk 'NF == 7' packing.data | wc -l)" -eq 1080 ] || fail "packing.data does not hold 1,080 spheres"
grep -q '^-var width .* -var depth .* -var height .* -var speed .* -var dt ' variables || fail "no variables for the LAMMPS deck"

# Wrong usage is refused with status 2.
for wrong in "--steps 3.5" "--bodies -1" "--pressed 0.5" "--unknown 1" "--steps"; do
    status=0
    # shellcheck disable=SC2086
    "$PARTICLS_BUILD/bench/compression" $wrong 2>errors >/dev/null || status=$?
    if [ $status -ne 2 ] || ! grep -q '^usage:' errors; then fail "'$wrong' gave status $status"; fi
done
