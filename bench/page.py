#!/usr/bin/env python3
"""Writes the page of `make bench` to standard output and the figures' data beside the measurements: page.py <results folder> <notes> [machines].

`machines` is a table of the main ratios, a row per processor: this processor's row is made anew in it, and the page shows them all.

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


SHAPES = {"polyhedron32": "polyhedron, 32 corners", "polyhedron128": "polyhedron, 128 corners", "sdf": "SDF alone", "rounded-box": "rounded box",
          "rounded-polyhedron": "rounded polyhedron, 32 corners", "prism": "hexagonal prism", "rounded-rectangle": "rounded rectangle", "polygon": "polygon, 8 corners"}


def medians(lines, keys):
    """Lines of the same pair of shapes as one: the median of each number that all have."""
    return {key: statistics.median(line[key] for line in lines) for key in keys if all(key in line for line in lines)}


def contact_queries(results):
    """A row per pair of shapes, and one per pair and number of nodes; pairs of depth that disagree."""
    groups = {}
    for line in load(results, "contact-query"):
        groups.setdefault((line["a"], line["b"]), []).append(line)
    rows, node_rows = [], []
    for (a, b), lines in groups.items():
        m = medians(lines, ("warm_ns", "cold_ns", "manifold_ns", "iterations", "fallbacks", "failures", "gjk_epa_ns", "gjk_epa_mean", "mpr_ns", "mpr_mean", "ours_above"))
        pair = f"{SHAPES.get(a, a)} - {SHAPES.get(b, b)}"
        queries = lines[0]["pairs"] * (lines[0]["steps"] - 1)
        theirs = ["-"] * 6
        if "gjk_epa_ns" in m:
            ratio_epa = statistics.median(line["gjk_epa_ns"] / line["warm_ns"] for line in lines)
            ratio_mpr = statistics.median(line["mpr_ns"] / line["warm_ns"] for line in lines)
            theirs = [f"{m['gjk_epa_ns']:,.0f}", f"**{ratio_epa:.1f}**", f"{m['gjk_epa_mean']:.0e}", f"{m['mpr_ns']:,.0f}", f"{ratio_mpr:.1f}", f"{m['mpr_mean']:.0e}"]
        rows.append([pair, f"**{m['warm_ns']:,.0f}**", f"{m['cold_ns']:,.0f}", f"{m['manifold_ns']:,.0f}", f"{m['iterations']:.2f}", f"{1e3 * m['fallbacks'] / queries:.2g}", f"{m['failures']:.0f}"]
                    + theirs + [f"{m['ours_above']:.0e}" if "ours_above" in m else "-"])
        for n in (100, 500, 2000):
            if f"nodes_{n}_ns" in lines[0]:
                own = medians(lines, ("warm_ns", f"nodes_{n}_ns", f"nodes_{n}_mean", f"nodes_{n}_worst"))
                node_rows.append([pair, f"{n:,}", f"{own[f'nodes_{n}_ns']:,.0f}", f"**{own[f'nodes_{n}_ns'] / own['warm_ns']:,.0f}**",
                                  f"{100 * own[f'nodes_{n}_mean']:.2f} %", f"{100 * own[f'nodes_{n}_worst']:.2f} %"])
    table(["pair", "ours, warm [ns]", "cold [ns]", "with `manifold` [ns]", "iterations", "fallbacks in 1,000", "failures", "GJK/EPA [ns]", "ours faster", "its error", "MPR [ns]",
           "ours faster", "its error", "ours above"], rows)
    print("P1's claim that optimisation beats n points of the boundary: the deepest of n even nodes of one body in the SDF of the other, without any search by boxes.\n"
          "Its error is that of the depth, in sizes, where it finds the contact at all.\n")
    table(["pair", "n", "nodes [ns]", "ours faster", "mean error of depth", "worst"], node_rows)


def settling(results):
    lines = load(results, "settling")
    names = {"particls": "particls", "yade": "Yade, Polyhedra", "particls-point": "particls, point law", "particls-many": "particls, point law"}
    base, rows = speeds(lines, "yade"), []
    for program in programs(lines):
        own = [line for line in lines if line["program"] == program]
        contacts = own[0]["touching"] / own[0]["bodies"]
        rows.append([names[program], f"{own[0]['bodies']:,}", str(len(own)), f"{contacts:.2f}", f"{statistics.median(line['particle_steps_per_s'] for line in own):,.0f}",
                     f"{statistics.median(1e6 / line['particle_steps_per_s'] * line['bodies'] / line['touching'] for line in own):,.2f}"]
                    + (["1", ""] if program == "yade" else ratio(speeds(lines, program), base)))
    table(["", "grains", "rounds", "contacts per grain", "particle-steps/s", "us per contact and step", "ratio (median)", "least to most"], rows)


def bonds(results):
    """Steps per second of the cube of a linear peridynamic solid, and of other laws on the same points."""
    lines = load(results, "bonds")
    names = {"particls-v4": "particls, AVX-512", "particls-v3": "particls, AVX2", "particls-best": "particls", "lammps": "LAMMPS, peri/lps", "particls-2": "particls, two threads",
             "bond_based": "particls, bond_based", "beam": "particls, beams of nearest neighbours"}
    def rates(program):
        return {line["round"]: 1e3 / line["step_ms"] for line in lines if line["program"] == program}
    base, rows = rates("lammps"), []
    for program in programs(lines):
        own = [line for line in lines if line["program"] == program]
        bonds = own[0].get("bonds")
        rows.append([names.get(program, program), f"{own[0]['points']:,}", f"{bonds:,}" if bonds else "", str(len(own)), f"{statistics.median(line['step_ms'] for line in own):.2f}",
                     f"{statistics.median(line['bonds_per_s'] for line in own) / 1e6:,.0f}" if bonds else "", f"{own[0]['bytes_per_bond']:.1f}" if bonds else ""]
                    + (["1", ""] if program == "lammps" else ["", ""] if program in ("bond_based", "beam") else ratio(rates(program), base)))
    table(["", "points", "bonds, of either direction", "rounds", "ms per step", "million bonds/s", "bytes per bond", "ratio (median)", "least to most"], rows)
    one = rates("particls-v4") or rates("particls-v3") or rates("particls-best")
    median, span = ratio(rates("particls-2"), one)
    print(f"Two threads against one: {median} ({span}).\n")


MACHINES = ("processor", "date", "particls", "16,500 spheres, AVX-512 / LAMMPS", "AVX2 / LAMMPS", "a million, AVX-512 / LAMMPS", "two threads / one, 16,500",
            "polyhedra / Yade")


def machines(results, path, whole):
    """The main ratios, median and range over the rounds, on each processor that was measured; this one's are put into the table if the run was `whole`."""
    facts = dict(line.split("\t", 1) for line in (results / "machine.tsv").read_text().splitlines())
    row = [facts["processor"].split(",")[0], facts["date"], facts["particls"]]
    for case, program, reference in (("example", "particls-v4", "lammps"), ("example", "particls-v3", "lammps"), ("large", "particls-v4", "lammps"),
                                     ("threads", "particls-2", "particls-1"), ("settling", "particls", "yade")):
        median, span = ratio(speeds(load(results, case), program), speeds(load(results, case), reference))
        row.append(median if median == "-" else f"{median.strip('*')} ({span})")
    rows = [line.split("\t") for line in path.read_text().splitlines()[1:]] if path.exists() else []
    if whole:
        old = next((other for other in rows if other[0] == row[0]), row)
        row = [before if now == "-" else now for before, now in zip(old, row)]
        rows = sorted([other for other in rows if other[0] != row[0]] + [row])
        path.write_text("".join("\t".join(line) + "\n" for line in [MACHINES, *rows]))
    print("## On every processor so far\n\nThe main ratios of speeds as the last `make bench` that went through on each left them (`bench/machines.tsv`).\n")
    table(MACHINES, rows)


def differing(results):
    """Cases whose runs end in different states."""
    groups = {}
    for path in sorted(results.glob("*.jsonl")):
        for line in load(results, path.stem):
            if "state_hash" in line and "pressed" in line:
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
    if len(sys.argv) > 3:
        machines(results, pathlib.Path(sys.argv[3]), not failures and not different)
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
    print("## Contact queries\n\nOne pair of bodies at a time, warm, as a step asks: poses of pairs that tumble over each other by a thousandth of the size per step, overlapping by up to 2 %.\n"
          "Beside ours libccd's GJK/EPA and MPR with our support functions, its tolerance at 1e-6. *Error* is the mean difference of its depth from ours, in sizes; *ours above* is\n"
          "the most by which our depth exceeds the overlap along a normal that libccd found: round-off, if ours is the least of all. MPR finds a depth, not the least one.\n")
    contact_queries(results)
    print("## Polyhedra that settle\n\nGrains of 28 corners with the volume law, falling into a box, one thread, time of the processor; Yade is given the same grains at the same places.\n")
    settling(results)
    print("## Bonds\n\nA cube of 40 points along each edge, horizon 3.015 spacings, being pulled apart; LAMMPS does the same job. Beams join nearest neighbours only.\n")
    bonds(results)
    print(notes.read_text(), end="")
    return 1 if different else 0


sys.exit(main())
