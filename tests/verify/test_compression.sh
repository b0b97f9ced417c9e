#!/usr/bin/env bash
# The compression of 16,500 spheres gives LAMMPS's stress and kinetic energy while the plate meets the packing, t = 0.2 to 0.3 s; `make prove` compares the whole run.
# Runs in an empty folder with PARTICLS (the program) and PARTICLS_SOURCE (the source tree).
set -euo pipefail

if [ -n "${PARTICLS_SANITIZE:-}" ]; then
    echo "12,000 steps of 16,500 spheres take too long under a sanitizer; examples/examples runs the same scene shortly"
    exit 77
fi

"$PARTICLS" run "$PARTICLS_SOURCE/examples/uniaxial-compression/scene.yaml" -o compression --quiet --threads 1 --set time.end=0.3
python3 "$PARTICLS_SOURCE/tests/verify/compare_compression.py" compression "$PARTICLS_SOURCE/tests/data/compression_lammps.csv"
