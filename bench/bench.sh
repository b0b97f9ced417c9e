#!/usr/bin/env bash
# The benchmarks: measures the programs of this folder, LAMMPS, libccd and Yade beside them in turn, and writes docs/performance.md with its figures.
#
#     bench/bench.sh [build folder]      without a folder: build/release, built first
#
# Environment: QUICK=1 runs everything in small to see that it works and leaves the page in bench/results/quick instead; ROUNDS=3 rounds of each comparison;
# LAMMPS_SKIN=0.015 its neighbour skin [m] (0.015 was its fastest).
#
# Every measurement is a line of JSON in bench/results/*.jsonl. Speeds of a machine drift, so what is compared runs in turn (A B A B A B) and is compared round
# by round. Exit status 1 when something failed; the page names it and is written all the same.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
quick=${QUICK:-0}
[ "$quick" = 0 ] || quick=1
skin=${LAMMPS_SKIN:-0.015}

if [ "$quick" = 1 ]; then
    rounds=${ROUNDS:-1}
    results=$here/results/quick page=$results/performance.md figures=$results/figures
    query_pairs=20 query_steps=10 settling=500 settling_steps=20 yade_grains=27 yade_steps=5 bond_side=12 bond_steps=20
    end=0.05 large=200000 large_steps=20 threads_steps=500 scaling_work=8000000 sizes=(1000 10000 100000 1000000)
else
    rounds=${ROUNDS:-3}
    results=$here/results page=$root/docs/performance.md figures=$root/docs/figures
    query_pairs=500 query_steps=100 settling=4000 settling_steps=400 yade_grains=216 yade_steps=20 bond_side=40 bond_steps=300
    end=0.5 large=1000000 large_steps=200 threads_steps=4000 scaling_work=36000000 sizes=(1000 3000 10000 30000 100000 300000 1000000)
fi

build=${1:-$root/build/release}
[ $# -gt 0 ] || make -C "$root" --no-print-directory build
compression=$build/bench/compression
broad_phase=$build/bench/broad_phase
contact_query=$build/bench/contact_query
polyhedra=$build/bench/polyhedra
peridynamics=$build/bench/peridynamics
for program in "$compression" "$broad_phase" "$contact_query" "$polyhedra" "$peridynamics"; do
    [ -x "$program" ] || { echo "bench.sh: $program is missing: run make build first" >&2; exit 2; }
done
for tool in gnuplot python3; do
    command -v $tool >/dev/null || { echo "bench.sh: $tool is missing: run scripts/install-packages" >&2; exit 2; }
done

peer=1
if ! command -v lmp >/dev/null; then
    "$root/scripts/install-packages" lammps || echo "bench.sh: installing lammps failed" >&2
    command -v lmp >/dev/null || { peer=0; echo "bench.sh: LAMMPS is missing (apt-get install lammps): going on without it" >&2; }
fi

yade=1
if ! command -v yade >/dev/null; then
    "$root/scripts/install-packages" yade || echo "bench.sh: installing yade failed" >&2
    command -v yade >/dev/null || { yade=0; echo "bench.sh: Yade is missing (apt-get install yade): going on without it" >&2; }
fi

# What is measured: the commit, and whether the tree differs from it in more than what this script writes.
commit=$(git -C "$root" log -1 --format=', commit %h' 2>/dev/null) || true
changes=$(git -C "$root" status --porcelain -- "$root" ":(exclude,top)docs/performance.md" ":(exclude,top)bench/machines.tsv" ":(exclude,top,glob)docs/figures/bench-*" 2>/dev/null) || true
[ -z "$changes" ] || commit+=" with uncommitted changes"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$results" "$figures"
rm -f "$results"/*.jsonl "$results/failures.txt"
: >"$results/failures.txt"
start=$SECONDS

failed() # <what>: tell and remember; the measurements go on
{
    echo "FAILED: $1" | tee -a "$results/failures.txt" >&2
    sed 's/^/    /' "$scratch/errors" >&2 || true
}

record() # <case> <round> <program>: a line of JSON from standard input goes to the case's file
{
    local line
    IFS= read -r line
    printf '{"case": "%s", "round": %s, "program": "%s", %s\n' "$1" "$2" "$3" "${line#\{}" >>"$results/$1.jsonl"
    printf '[%4d s] %s, round %s, %s: %s\n' $((SECONDS - start)) "$1" "$2" "$3" "$(grep -o '"[ab]": "[a-z0-9]*"\|"[a-z_]*_ns": [0-9.]*\|"bodies": [0-9]*\|"[a-z_]*_per_[a-z]*": [0-9.]*\|"wall_s": [0-9.]*' <<<"$line" | tr -d '"' | paste -sd ' ')"
}

ours() # <case> <round> <variant> <program> [option...]
{
    local case=$1 round=$2 variant=$3
    shift 3
    if "$@" >"$scratch/out" 2>"$scratch/errors"; then record "$case" "$round" "$variant" <"$scratch/out"; else failed "$case, round $round, $variant: ${*##*/}"; fi
}

lammps() # <case> <round> <steps> <option of compression...>
{
    local case=$1 round=$2 steps=$3 variables bodies seconds energy
    shift 3
    [ $peer = 1 ] || return 0
    if [ "$(cat "$scratch/packing.key" 2>/dev/null)" != "$*" ]; then
        if ! "$compression" "$@" --lammps-data "$scratch/packing.data" >"$scratch/variables" 2>"$scratch/errors"; then
            failed "$case: writing the packing for LAMMPS"
            return 0
        fi
        echo "$*" >"$scratch/packing.key"
    fi
    read -ra variables <"$scratch/variables"
    if ! (cd "$scratch" && OMP_NUM_THREADS=1 lmp -in "$here/peers/compression.lammps.in" -log none -var data packing.data -var skin "$skin" -var steps "$steps" \
        "${variables[@]}" >lammps.out 2>errors); then
        tail -5 "$scratch/lammps.out" >>"$scratch/errors"
        failed "$case, round $round, LAMMPS"
        return 0
    fi
    read -r seconds bodies < <(sed -n 's/^Loop time of \([0-9.e+]*\) on 1 procs for [0-9]* steps with \([0-9]*\) atoms.*/\1 \2/p' "$scratch/lammps.out") || true
    energy=$(sed -n 's/^kinetic energy //p' "$scratch/lammps.out")
    if [ -z "${seconds:-}" ] || [ -z "$energy" ]; then
        tail -5 "$scratch/lammps.out" >"$scratch/errors"
        failed "$case, round $round, LAMMPS: no loop time in its output"
        return 0
    fi
    awk -v n="$bodies" -v steps="$steps" -v s="$seconds" -v e="$energy" 'BEGIN {
        printf "{\"bodies\": %d, \"steps\": %d, \"threads\": 1, \"wall_s\": %s, \"particle_steps_per_s\": %.0f, \"kinetic_energy\": %s}\n", n, steps, s, n * steps / s, e }' |
        record "$case" "$round" lammps
}

isas=()
case $(uname -m) in x86_64) if grep -qw avx2 /proc/cpuinfo; then isas=(v3); fi ;; esac
if grep -qw avx512f /proc/cpuinfo && grep -qw avx512vl /proc/cpuinfo; then isas=(v4 "${isas[@]}"); fi
[ ${#isas[@]} -gt 0 ] || isas=(best)

compare() # <case> <steps> <option of compression...>: each instruction set and LAMMPS in turn, one thread
{
    local case=$1 steps=$2 round isa
    shift 2
    for ((round = 1; round <= rounds; ++round)); do
        for isa in "${isas[@]}"; do ours "$case" "$round" "particls-$isa" env PARTICLS_ISA="$isa" "$compression" "$@" --steps "$steps"; done
        lammps "$case" "$round" "$steps" "$@"
    done
}

compare example "$(awk -v end=$end 'BEGIN { printf "%.0f", end / 2.5e-5 }')" --bodies 16500
compare large "$large_steps" --bodies $large --pressed 0.02

for ((round = 1; round <= rounds; ++round)); do
    for threads in 1 2; do
        ours threads "$round" "particls-$threads" "$compression" --bodies 16500 --pressed 0.02 --steps $threads_steps --threads $threads
        ours threads-large "$round" "particls-$threads" "$compression" --bodies $large --pressed 0.02 --steps $((large_steps / 2)) --threads $threads
    done
done

for ((round = 1; round <= rounds; ++round)); do
    for size in "${sizes[@]}"; do
        # About the same work for each, but no more than 2,000 steps: 1.75 % of strain, so that all are pressed alike.
        steps=$((scaling_work / size))
        ((steps <= 2000)) || steps=2000
        ours scaling "$round" particls "$compression" --bodies "$size" --pressed 0.02 --steps "$steps"
        for ratio in 1 100; do ours broad-phase "$round" "ratio-$ratio" "$broad_phase" "$size" $ratio; done
    done
done

# Each pair of shapes once; distances that are searched for in values alone take a thousand times longer, so fewer of them.
solids='sphere box capsule cylinder ellipsoid superquadric rounded-box rounded-polyhedron prism polyhedron32 polyhedron128 sdf plane'
flats='disc rectangle rounded-rectangle stadium ellipse superellipse polygon half-plane'
queries() # <round> <shape...>, the last one a plane
{
    local round=$1 a b pairs
    shift
    for ((a = 1; a < $#; ++a)); do
        for ((b = a; b <= $#; ++b)); do
            pairs=$query_pairs
            case ${!a}-${!b} in *sdf*) pairs=$(((query_pairs + 99) / 100)) ;; esac
            ours contact-query "$round" particls "$contact_query" "${!a}" "${!b}" "$pairs" "$query_steps"
        done
    done
}
for ((round = 1; round <= rounds; ++round)); do
    queries "$round" $solids
    queries "$round" $flats
done

# Polyhedra that settle: our step and Yade's on the same grains, law and places; ours by penetration depth, and with many more of them.
yade_polyhedra() # <round> <state>
{
    [ $yade = 1 ] || return 0
    if (cd "$scratch" && STATE="$2" STEPS=$yade_steps OMP_NUM_THREADS=1 yade -j1 -n -x "$here/peers/polyhedra.yade.py" >yade.out 2>errors) &&
        grep '^{' "$scratch/yade.out" >"$scratch/out"; then
        record settling "$1" yade <"$scratch/out"
    else
        tail -5 "$scratch/yade.out" >>"$scratch/errors"
        failed "settling, round $1, Yade"
    fi
}
for ((round = 1; round <= rounds; ++round)); do
    ours settling "$round" particls "$polyhedra" --bodies $yade_grains --steps $((settling_steps * 10)) --state "$scratch/settled"
    yade_polyhedra "$round" "$scratch/settled"
    ours settling "$round" particls-point "$polyhedra" --bodies $yade_grains --steps $((settling_steps * 10)) --faces point
    ours settling "$round" particls-many "$polyhedra" --bodies $settling --steps $settling_steps --faces point
done

# Bonds: each instruction set and LAMMPS in turn on one thread; then the same on two, and other laws. LAMMPS takes twenty times as long, so it does a tenth of the steps.
lammps_bonds() # <round>
{
    local seconds points
    [ $peer = 1 ] || return 0
    if ! (cd "$scratch" && OMP_NUM_THREADS=1 lmp -in "$here/peers/peridynamics.lammps.in" -log none -var side $bond_side -var steps $((bond_steps / 10)) >lammps.out 2>errors); then
        tail -5 "$scratch/lammps.out" >>"$scratch/errors"
        failed "bonds, round $1, LAMMPS"
        return 0
    fi
    read -r seconds points < <(sed -n 's/^Loop time of \([0-9.e+]*\) on 1 procs for [0-9]* steps with \([0-9]*\) atoms.*/\1 \2/p' "$scratch/lammps.out" | tail -1) || true
    if [ -z "${seconds:-}" ]; then
        failed "bonds, round $1, LAMMPS: no loop time in its output"
        return 0
    fi
    awk -v s="$seconds" -v n="$((bond_steps / 10))" -v points="$points" 'BEGIN { printf "{\"points\": %d, \"steps\": %d, \"threads\": 1, \"wall_s\": %.6g, \"step_ms\": %.6g}\n", points, n, s, 1e3 * s / n }' >"$scratch/out"
    record bonds "$1" lammps <"$scratch/out"
}
for ((round = 1; round <= rounds; ++round)); do
    for isa in "${isas[@]}"; do ours bonds "$round" "particls-$isa" env PARTICLS_ISA="$isa" OMP_NUM_THREADS=1 "$peridynamics" --side $bond_side --steps $bond_steps; done
    lammps_bonds "$round"
    ours bonds "$round" particls-2 env OMP_NUM_THREADS=2 "$peridynamics" --side $bond_side --steps $bond_steps
    for law in bond_based beam; do ours bonds "$round" "$law" env OMP_NUM_THREADS=1 "$peridynamics" --side $bond_side --steps $bond_steps --law $law; done
done

version=$(sed -n 's/^#define PLS_VERSION_TEXT *"\(.*\)"/\1/p' "$root/include/particls/types.h")
compiler=$(sed -n 's/^CMAKE_C_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
cat >"$results/machine.tsv" <<TEXT
date	$(date -u +%Y-%m-%d)
took	$((SECONDS - start)) s
processor	$(LC_ALL=C lscpu | awk -F ': *' '/^ *Model name:/ { name = $2 } /^ *CPU family:/ { family = $2 } /^ *Model:/ { model = $2 } END { printf "%s (family %s model %s)", name, family, model }'), $(nproc) processors online, instruction sets measured: ${isas[*]}
caches	$(LC_ALL=C lscpu | sed -n 's/^\(L[1-3][di]*\) cache: */\1 /p' | paste -sd ',' | sed 's/,/, /g')
memory	$(awk '/^MemTotal/ { printf "%.1f GiB", $2 / 1048576 }' /proc/meminfo)
kernel	$(uname -sr)
particls	$version$commit
compiler	$("$(readlink -f "${compiler:-$(command -v cc)}")" --version | head -1)
LAMMPS	$(if [ $peer = 1 ]; then (lmp -h 2>/dev/null || true) | sed -n "s/^Large-scale.*Simulator - \(.*\)/\1, neighbour skin $skin m/p" | head -1; else echo "missing (apt-get install lammps): nothing is compared with it"; fi)
libccd	$(ldconfig -p 2>/dev/null | sed -n 's/.*=> .*\/libccd\.so\.//p' | head -1 | grep . || echo "missing (apt-get install libccd-dev): nothing is compared with it")
Yade	$(if [ $yade = 1 ]; then yade --version 2>/dev/null | sed -n 's/^Yade version: *//p' | head -1; else echo "missing (apt-get install yade): nothing is compared with it"; fi)
TEXT

status=0
machines=()
[ $quick = 1 ] || machines=("$here/machines.tsv")
python3 "$here/page.py" "$results" "$here/performance_notes.md" "${machines[@]}" >"$scratch/page.md" 2>"$scratch/errors" || { status=1; failed "page.py"; }
gnuplot -e "data='$results'; out='$figures'" "$here/figures.gp" 2>"$scratch/errors" || { status=1; failed "figures.gp"; }
cp "$scratch/page.md" "$page"
[ ! -s "$results/failures.txt" ] || status=1
echo "$page"
exit $status
