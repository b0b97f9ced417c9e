#!/usr/bin/env python3
"""Compare a run of examples/uniaxial-compression with LAMMPS: compare_compression.py RUN REFERENCE [CURVES]

Means over windows of 0.1 s, from t = 0.2 s (the plate arrives at 0.19 s) to the end of the run: a packing that yields is chaotic, so single values part where
means do not. Prints a Markdown table with a row per comparison and a line with their number; exit status 1 when one is out of tolerance. With CURVES it writes
time, sum of sigma_zz V and the reference's into that file for a plot.
"""
import csv
import sys

WINDOW = 0.1  # [s]
SAMPLES = 20  # per window: both programs write every 0.005 s
FIRST = 2     # windows before the plate has arrived hold nothing to compare
QUANTITIES = (("sum of sigma_zz V over contacts between grains [J]", "stress", 0.005), ("kinetic energy [J]", "kinetic", 0.03))


def table(path, **wanted):
    """Columns of a series, by time in units of the sampling interval."""
    with open(path, newline="") as file:
        rows = csv.DictReader(file)
        return {round(float(row["time [s]"]) * SAMPLES / WINDOW): {name: float(row[column]) for name, column in wanted.items()} for row in rows}


def mean(rows, window, name):
    return sum(rows[k][name] for k in range(window * SAMPLES, (window + 1) * SAMPLES)) / SAMPLES


def main():
    run, reference = sys.argv[1:3]
    ours = table(f"{run}/series/grains.csv", stress="sigma_zz [Pa]")  # the scene gives it the volume 1
    for k, row in table(f"{run}/series/all.csv", kinetic="energy_kinetic [J]").items():
        ours[k].update(row)
    theirs = table(reference, stress="sum_sigma_zz_V [J]", kinetic="kinetic_energy [J]")
    if len(sys.argv) > 3:
        with open(sys.argv[3], "w") as file:
            for k in sorted(ours):
                file.write(f"{k * WINDOW / SAMPLES:.3f}\t{ours[k]['stress']:.9g}\t{theirs[k]['stress']:.9g}\n")

    print("| what | measured | reference | error | allowed | |\n|---|---:|---:|---:|---:|---|")
    count = failed = 0
    for what, name, allowed in QUANTITIES:
        for window in range(FIRST, max(ours) // SAMPLES):
            measured, expected = mean(ours, window, name), mean(theirs, window, name)
            error = abs(measured / expected - 1)
            good = error <= allowed  # false for NaN
            print(f"| {what}, mean over t = {window * WINDOW:.1f} to {(window + 1) * WINDOW:.1f} s | {measured:.9g} | {expected:.9g} | {error:.1e} rel. | {allowed:.1e} "
                  f"| {'yes' if good else '**no**'} |")
            count, failed = count + 1, failed + (not good)
    print(f"\n{count} comparisons, {failed} out of tolerance.")
    return 0 if count > 0 and failed == 0 else 1


sys.exit(main())
