#!/usr/bin/env bash
# The long verification campaign: writes docs/verification.md and docs/figures/verify-*.svg. Builds nothing.
#
#     tests/prove/prove.sh [build folder]        build/release by default
#
# Exit status 1 when a comparison is out of tolerance; the page is written all the same.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
program=$build/tests/prove/prove
particls=$build/bin/particls
figures=$root/docs/figures
page=$root/docs/verification.md

for needed in "$program" "$particls"; do
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

# The example as users run it, against another program.
"$particls" run "$root/examples/uniaxial-compression/scene.yaml" -o "$scratch/compression" --quiet --threads 1
python3 "$root/tests/verify/compare_compression.py" "$scratch/compression" "$root/tests/data/compression_lammps.csv" "$scratch/compression.tsv" \
    >"$scratch/compression.md" || status=1
ended=$SECONDS

gnuplot -e "data='$scratch'; out='$figures'" "$root/tests/prove/figures.gp"

figure() # <name> <caption>: a figure of the page, if its data exist
{
    [ -f "$figures/verify-$1.svg" ] && printf '![%s](figures/verify-%s.svg)\n\n*%s*\n\n' "$2" "$1" "$2"
}

{
    cat <<TEXT
# Verification

Physics with known answers, run in full. The tests run the same cases in short forms (\`tests/verify\`); this page is written by \`make prove\`
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
| took | $((known - start)) s, the compression $((ended - known)) s |

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
} >"$page"
echo "$page"
exit "$status"
