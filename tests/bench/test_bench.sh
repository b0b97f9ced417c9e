#!/usr/bin/env bash
# The benchmark programs run in small and print sound JSON; the state does not depend on the instruction set.
# Runs in an empty folder with PARTICLS_BUILD (the build tree).
set -euo pipefail

fail() { echo "test_bench.sh: $1" >&2; exit 1; }

run=("$PARTICLS_BUILD/bench/compression" --bodies 1000 --pressed 0.02 --steps 50)
"${run[@]}" >best.json
PARTICLS_ISA=v2 "${run[@]}" --threads 2 >v2.json
"$PARTICLS_BUILD/bench/broad_phase" 1000 100 >broad.json
"${run[@]}" --lammps-data packing.data >variables

# 9 x 10 x 12: the example's 22 : 25 : 30 with at least 1,000 spheres. Inside a hexagonal close packing a sphere has 12 neighbours, each contact has two ends;
# at the surface and towards the walls it has fewer.
python3 - <<'PYTHON' || fail "the JSON is not as it should be"
import json
best, v2, broad = (json.load(open(name + ".json")) for name in ("best", "v2", "broad"))
assert best["counts"] == [9, 10, 12] and best["bodies"] == 1080 and best["steps"] == 50 and best["threads"] == 1, best
assert v2["threads"] == 2 and v2["state_hash"] == best["state_hash"], (best, v2)
assert 4 * 1080 < best["touching"] < 6.5 * 1080 and best["listed"] >= best["touching"], best
assert best["wall_s"] > 0 and abs(best["particle_steps_per_s"] * best["wall_s"] / (1080 * 50) - 1) < 0.01, best
assert best["bytes_per_body"] > 0 and best["bytes_per_contact"] > 0 and best["peak_bytes"] > 0 and best["skin"] > 0 and best["list_builds"] >= 1, best
assert broad["bodies"] == 1000 and broad["size_ratio"] == 100 and broad["pairs"] > 0 and broad["ns_per_body"] > 0, broad
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
