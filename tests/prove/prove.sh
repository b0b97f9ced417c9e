#!/usr/bin/env bash
# The long verification campaign: writes docs/verification.md and docs/figures/verify-*.svg, then docs/contact-detection.md (contact_methods.sh). Builds nothing.
#
#     tests/prove/prove.sh [build folder]        build/release by default
#     PARTICLS_NARROW                            random pairs, trajectories, steps, one of how many is compared, one of how many of those is searched, for each pair of shapes
#     PARTICLS_KILLS                             runs to kill on each scene, 50 by default
#
# Exit status 1 when a comparison is out of tolerance or bits differ; the page is written all the same.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(realpath "${1:-$root/build/release}") # absolute: scripts run in folders of their own
program=$build/tests/prove/prove
particls=$build/bin/particls
figures=$root/docs/figures
page=$root/docs/verification.md

for needed in "$program" "$build/tests/prove/prove_narrow" "$particls" "$build"/tests/determinism/test_{threads,lists,restart,steps,solid_restart}; do
    [ -x "$needed" ] || { echo "prove.sh: $needed is missing: run make build first" >&2; exit 2; }
done
command -v gnuplot >/dev/null || { echo "prove.sh: gnuplot is missing: apt-get install gnuplot-nox" >&2; exit 2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$figures"

status=0
start=$SECONDS
OMP_WAIT_POLICY=passive "$program" "$scratch" >"$scratch/tables.md" || status=$?
[ "$status" -le 1 ] || { echo "prove.sh: $program failed" >&2; exit "$status"; }
known=$SECONDS

# The narrow phase against slow oracles: half an hour of processor time; PARTICLS_NARROW="2000 20 400 5 1" is a minute.
OMP_WAIT_POLICY=passive "$build/tests/prove/prove_narrow" ${PARTICLS_NARROW:-100000 200 400 5 11} >"$scratch/narrow.md" || status=1

# The example as users run it, against another program.
"$particls" run "$root/examples/uniaxial-compression/scene.yaml" -o "$scratch/compression" --quiet --threads 1
python3 "$root/tests/verify/compare_compression.py" "$scratch/compression" "$root/tests/data/compression_lammps.csv" "$scratch/compression.tsv" \
    >"$scratch/compression.md" || status=1
ended=$SECONDS

# The tests of equal bits, a row for each claim; then runs that are killed.
equal_bits() # <test of determinism> <what is compared>
{
    OMP_WAIT_POLICY=passive "$build/tests/determinism/test_$1" >"$scratch/claims" 2>&1 || { status=1; tail -n 5 "$scratch/claims" >&2; }
    awk -v what="$2" '
        /^\[       OK \]/ || /^\[  FAILED  \] [a-z]/ {
            claim = $NF; gsub("_", " ", claim)
            if (!(claim in seen)) print "| " what " | " claim " | " (/OK/ ? "yes" : "**no**") " |"
            seen[claim] = 1
        }' "$scratch/claims" >>"$scratch/bits.md"
}

equal_bits threads "threads: 1, 2, 3, 4"
equal_bits lists "skin: 0.1, 1, 3 times its own; order in memory: sorted or not"
equal_bits restart "restart after 1 to 300 steps, ten moments"
equal_bits solid_restart "restart of a pile of all shapes, three moments"
equal_bits steps "instruction set: v2, v3, v4; one run, pieces, single steps"

mkdir "$scratch/kill"
seed=${PARTICLS_SEED:-$$}
(cd "$scratch/kill" && OMP_WAIT_POLICY=passive PARTICLS_KILLS=${PARTICLS_KILLS:-50} PARTICLS_SEED=$seed PARTICLS=$particls \
    bash "$root/tests/faults/test_kill.sh") >"$scratch/kill.log" 2>&1 || { status=1; tail -n 5 "$scratch/kill.log" >&2; }
for scene in grows equal; do
    awk -v scene="$scene.yaml" '
        $1 == scene ":" && $3 == "runs" { killed = $2; interrupted = $5 }
        END { print "| " scene " | " (killed ? killed " | " interrupted " | yes |" : "| | **no** |") }' "$scratch/kill.log" >>"$scratch/kill.md"
done
repeated=$SECONDS

gnuplot -e "data='$scratch'; out='$figures'" "$root/tests/prove/figures.gp"

figure() # <name> <caption>: a figure of the page, if its data exist
{
    [ -f "$figures/verify-$1.svg" ] && printf '![%s](figures/verify-%s.svg)\n\n*%s*\n\n' "$2" "$1" "$2"
}

{
    cat <<TEXT
# Verification

Physics with known answers, run in full, and at the end [equal bits](#equal-bits). The tests run the same cases in short forms (\`tests/verify\`); this page is written by \`make prove\`
(\`tests/prove\`). References are formulas or calculations of the tests' own, for the [compression](#uniaxial-compression-of-16500-spheres-against-lammps) results of LAMMPS:
no reference comes from the library.
What the columns say: *error* is the distance of the measured value from the reference (*rel.*: divided by the reference; without a reference the
measured value is the error itself), *allowed* is the largest error with which the comparison counts as passed.

Orders are slopes of the error against the time step, or come from three runs at dt, dt/2, dt/4 (Richardson) where there is no closed solution.
Impacts start at many phases of the time grid, because a contact law has a kink, with a dashpot a jump, at first touch.

| | |
|---|---|
| version | $(sed -n 's/^#define PLS_VERSION_TEXT *"\(.*\)"/\1/p' "$root/include/particls/types.h") |
| processor | $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1) |
| took | $((known - start)) s, contacts and the compression $((ended - known)) s, equal bits $((repeated - ended)) s |

$(tail -qn 1 "$scratch/tables.md" "$scratch/compression.md" | awk '{ all += $1; failed += $3 } END { print all " comparisons, " failed " out of tolerance." }')

## Figures

TEXT
    figure oblique "Oblique impact: rebound of the tangential velocity over the angle of impact, sphere on plane, two spheres, disc on line"
    figure orders "Second order: error of energy after impacts and of the energy book, against the time step"
    figure rotation "Free rotation of an asymmetric body: spin about the intermediate axis and Jacobi's solution"
    figure rolling "Sliding turns to rolling"
    figure cloud "Energy book of a collapsing cloud of 500 spheres"
    figure compression "Uniaxial compression of 16,500 spheres: sum of sigma_zz V over contacts between grains, and LAMMPS's"
    printf '## Tables\n\n'
    head -n -1 "$scratch/tables.md"
    cat <<TEXT
### Uniaxial compression of 16,500 spheres, against LAMMPS

\`examples/uniaxial-compression\` as it stands; the reference is LAMMPS 29 Sep 2021 with the same packing, law, walls and step
(\`tests/data/README.md\`). Single instants are not compared: the packing yields in avalanches, and two programs that differ in the last digit part there.

TEXT
    head -n -2 "$scratch/compression.md"
    cat <<TEXT

## Depths of pairs of shapes

Every pair of shapes at random and along tumbling trajectories, from gaps of 5 % of the size to overlaps of 5 % (\`tests/support/narrow_oracle.c\`). Lengths are parts of the smaller
bounding radius. *depth*: worst error, of the overlap along the normal found, or by how much other directions may have less: over separating axes (polytopes), by bounds from both sides
(gaps; overlaps where a ball about a witness point lies in the other body), or by branch and bound over all directions (*searched*); a tenth of what is allowed is not looked into. *of depth*:
the same as part of the depth itself, of depths from 1e-6; *normal*: distance from one whose overlap is the depth, where that of the answer is not (a support point that jumps along a straight
line makes errors of the normal count in first order); *points*: distance of the witness points from their surfaces; *wrong*: errors of the depth above 1e-8 (polytopes) or 1e-6 (others) of the
depth itself, or points off by more than 1e-6 of it, but for 4e-15 of the size: coordinates are up to four sizes away from zero, each rounded to 4e-16, and some ten of them make a depth.
The *sdf-only cone* has values alone. Normals from differences of values are good to 1e-7 or so where curvature jumps; depths are not touched by that, as errors count squared in them.
Shapes that are not convex are not in the table: the depth is that of a place, of which there may be several, and no bound over directions holds for them; pairs of a compound's
parts are those of the table. Iterations, restarts (cold), fallbacks (to a slower method) and time per query are those of trajectories.
TEXT
    cat "$scratch/narrow.md"
    cat <<TEXT

## Equal bits

The same input gives the same bits. Compared are hashes over the state of all bodies, contacts and states, several times along the way of heaps of
several hundred to a few thousand spheres (\`tests/determinism\`): loose ones with radii 1 : 2.5, in which a sphere grows and a state drives the law; dense ones
without states, of equal spheres and of two sizes 1 : 2.5, in which whole vectors of contacts touch and steps run into each other; between walls and in
periodic boxes, in 2D and 3D; and piles of grains of all shapes in a box.

| compared | claim | equal |
|---|---|---|
TEXT
    cat "$scratch/bits.md"
    cat <<TEXT

Runs of the program are killed (SIGKILL, every other one again while it resumes) or interrupted (SIGINT) at random moments and resumed
(\`tests/faults/test_kill.sh\`, seed $seed). Series, frames and checkpoints must be those of an undisturbed run byte for byte, the summary but for wall times.
In \`grows.yaml\` a wall is driven and a sphere grows; in \`equal.yaml\` equal spheres fall and nothing is driven.

| scene | killed | interrupted | files equal |
|---|---:|---:|---|
TEXT
    cat "$scratch/kill.md"
} >"$page"
echo "$page"

bash "$root/tests/prove/contact_methods.sh" "$build" || status=1
exit "$status"
