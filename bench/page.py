#!/usr/bin/env python3
"""Writes the page of `make bench` to standard output and the figures' data beside the measurements: page.py <results folder> <notes>.

Exit status 1 when runs that must agree do not: the state's hash on any instruction set and number of threads.
"""
import json
import pathlib
import statistics
import sys


def load(results, case):
    path = results / f"{case}.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" + "---:|" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def speeds(lines, program):
    return {line["round"]: line["particle_steps_per_s"] for line in lines if line["program"] == program}


def millions(values):
    return f"{statistics.median(values) / 1e6:.2f}" if values else "failed"


def ratio(ours, theirs):
    """Median, least and most of the ratios of each round that has both."""
    values = [ours[k] / theirs[k] for k in sorted(ours) if k in theirs]
    if not values:
        return ["-", "-"]
    return [f"**{statistics.median(values):.2f}**", f"{min(values):.2f} to {max(values):.2f}"]


def programs(lines):
    return list(dict.fromkeys(line["program"] for line in lines))


NAMES = {
    "particls-v4": "particls, AVX-512",
    "particls-v3": "particls, AVX2",
    "particls-best": "particls",
    "lammps": "LAMMPS",
    "particls-1": "one thread",
    "particls-2": "two threads",
}


def comparison(results, case, reference):
    """Speeds of a case and their ratio to those of the reference, round by round."""
    lines = load(results, case)
    if not lines:
        print("Nothing was measured.\n")
        return
    rows = []
    base = speeds(lines, reference)
    for program in programs(lines):
        own = speeds(lines, program)
        first = next(line for line in lines if line["program"] == program)
        rows.append([NAMES[program], str(len(own)), millions(own.values())] + (["1", ""] if program == reference else ratio(own, base))
                    + [f"{first['kinetic_energy']:.6g}"])
    if reference == "lammps" and not base:
        print("LAMMPS was not measured here.\n")
    one = lines[0]
    print(f"{one['bodies']:,} spheres, {one['steps']:,} steps; at the end {one['touching']:,} contacts touch, {one['listed']:,} pairs are listed.\n"
          if "touching" in one else f"{one['bodies']:,} spheres, {one['steps']:,} steps.\n")
    table(["", "rounds", "million particle-steps/s", "ratio (median)", "least to most", "kinetic energy at the end [J]"], rows)


def memory(results):
    rows = []
    for case, name in (("example", "compression"), ("large", "pressed")):
        lines = [line for line in load(results, case) if "bytes_per_body" in line]
        if not lines:
            continue
        line = lines[0]
        per_contact = line["bytes_per_contact"]
        per_listed = per_contact * line["touching"] / line["listed"] if per_contact else None
        rows.append([name, f"{line['bodies']:,}", f"{line['bytes_per_body']:.0f}", f"{per_contact:.0f}" if per_contact else "-",
                     f"{per_listed:.0f}" if per_listed else "-", f"{line['peak_bytes'] / line['bodies']:.0f}", f"{line['peak_bytes'] / 2**20:.0f}"])
    table(["", "spheres", "bytes per sphere", "bytes per touching contact", "bytes per listed pair", "peak bytes per sphere, all included", "peak [MiB]"], rows)


def by_size(lines, value):
    sizes = {}
    for line in lines:
        sizes.setdefault(line["bodies"], []).append(value(line))
    return {size: statistics.median(values) for size, values in sorted(sizes.items())}


def scaling(results):
    lines = load(results, "scaling")
    nanoseconds = by_size(lines, lambda line: 1e9 / line["particle_steps_per_s"])
    (results / "scaling.tsv").write_text("".join(f"{size}\t{value:.6g}\n" for size, value in nanoseconds.items()))
    rows = []
    for size, value in nanoseconds.items():
        line = next(line for line in lines if line["bodies"] == size)
        rows.append([f"{size:,}", f"{line['steps']:,}", f"{line['touching'] / size:.2f}", f"{line['list_builds']}", f"{line['setup_s']:.2f}", f"{value:.1f}", f"{1e3 / value:.2f}"])
    table(["spheres", "steps", "contacts per sphere", "lists made", "set-up [s]", "ns per particle-step", "million particle-steps/s"], rows)


def broad_phase(results):
    lines = load(results, "broad-phase")
    columns = {}
    for size_ratio in (1, 100):
        own = [line for line in lines if line["size_ratio"] == size_ratio]
        per_body, per_pair = by_size(own, lambda line: line["ns_per_body"]), by_size(own, lambda line: 1e9 * line["wall_s"] / max(line["pairs"], 1))
        columns[size_ratio] = {size: (per_body[size], per_pair[size], next(line["pairs"] for line in own if line["bodies"] == size) / size) for size in per_body}
    sizes = sorted(set(columns[1]) | set(columns[100]))
    missing = (float("nan"),) * 3
    text, rows = "", []
    for size in sizes:
        one, many = columns[1].get(size, missing), columns[100].get(size, missing)
        text += f"{size}\t{one[0]:.6g}\t{many[0]:.6g}\n"
        rows.append([f"{size:,}"] + [f"{v:.{d}f}" for v, d in zip(one + many, (0, 0, 2) * 2)])
    (results / "broad-phase.tsv").write_text(text)
    table(["bodies", "one size: ns per body", "ns per pair", "pairs per body", "1:100: ns per body", "ns per pair", "pairs per body"], rows)


def differing(results):
    """Cases whose runs end in different states."""
    groups = {}
    for path in sorted(results.glob("*.jsonl")):
        for line in load(results, path.stem):
            if "state_hash" in line:
                groups.setdefault((line["bodies"], line["pressed"], line["steps"]), set()).add(line["state_hash"])
    return groups, [key for key, hashes in groups.items() if len(hashes) > 1]


def figure(name, caption):
    print(f"![{caption}](figures/{name}.png)\n\n*{caption}*\n")


def main():
    results, notes = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    print("# Performance\n\nWritten by `make bench` (`bench/`). Speeds of virtual machines drift by a fifth, so programs run in turn and are compared round by round:\n"
          "the ratios are the result, the speeds belong to this machine and hour. Only stepping is timed. LAMMPS runs the same packing, law, walls and step\n"
          "(`bench/peers`) in one process with one thread and reports its own loop time; the kinetic energies show that the jobs are the same.\n")
    print("| | |\n|---|---|")
    for line in (results / "machine.tsv").read_text().splitlines():
        print("| " + " | ".join(line.split("\t", 1)) + " |")
    print()
    failures = (results / "failures.txt").read_text().splitlines()
    groups, different = differing(results)
    for line in failures:
        print(f"* {line}")
    for key in different:
        text = f"{key[0]:,} spheres, {key[2]:,} steps: the final state depends on the instruction set or the number of threads"
        print(f"* FAILED: {text}")
        print(text, file=sys.stderr)
    if failures or different:
        print()
    else:
        print(f"All runs went through. In each of {len(groups)} jobs every run ended in the same state, bit for bit, on any instruction set and number of threads.\n")
    print("## Uniaxial compression\n\nThe packing of 22 x 25 x 30 spheres of `examples/uniaxial-compression`, one thread. Before the plate arrives at t = 0.19 s grains just touch.\n")
    comparison(results, "example", "lammps")
    print("## Many spheres, pressed\n\nThe same packing, larger, shrunk by 2 % with its box, so that all contacts exist from the first step; one thread.\n")
    comparison(results, "large", "lammps")
    print("## Two threads against one\n")
    comparison(results, "threads", "particls-1")
    comparison(results, "threads-large", "particls-1")
    print("## Memory\n\nArrays of bodies and of pairs, all lists included, at the end of the run; the peak is of all the library held at once.\n")
    memory(results)
    print("## From a thousand to a million spheres\n\nPressed packings, one thread, median of the rounds. Set-up is all before the first step: bodies, first list, check of the time step.\n")
    scaling(results)
    figure("bench-scaling", "Time per particle and step against the number of spheres")
    print("## Broad phase\n\nThe search for near pairs alone, one thread: bodies of one size, and sizes of 1:100 with equal volume in equal intervals of log r. The median of\n"
          "repeated calls. With few bodies of 1:100 the largest one fills most of the box, hence few pairs.\n")
    broad_phase(results)
    figure("bench-broad-phase", "Broad phase: time per body against the number of bodies")
    print(notes.read_text(), end="")
    return 1 if different else 0


sys.exit(main())
