"""200 replications of a model of 50 ms, the whole command: one process against two.

The ratio by the clock needs two quiet cores. That by CPU is what two such cores could give at best: all CPU of the run
on one process over (CPU of the parent + half of that of the others) of the run on two. A busy machine tells it, too.
"""

from bench.made_line import line
from bench.whole_command import opsim

ROUNDS = 4
TARGET = 1.8


def test_two_processes_against_one(tmp_path):
    file, caches = line(tmp_path), tmp_path / "caches"
    opsim(caches, "run", file, "-o", tmp_path / "warm", "--replications", 3, "--processes", 2)
    rounds = [[_run(tmp_path, file, caches, n, k) for n in (1, 2)] for k in range(ROUNDS)]
    one_s, two_s = (min(used.wall_s for used in column) for column in zip(*rounds))
    alone, both = (min(column, key=lambda used: used.own_s + used.children_s) for column in zip(*rounds))
    at_best = alone.own_s / (both.own_s + both.children_s / 2)
    print(f"\n200 replications: {one_s:.2f} s on one process, {two_s:.2f} s on two")
    print(f"by the clock: {one_s / two_s:.2f} x (target {TARGET})")
    print(f"by CPU: {alone.own_s:.2f} s; {both.own_s:.2f} s + {both.children_s:.2f} s of children: {at_best:.2f} x")


def _run(folder, file, caches, processes, round_):
    """What a run used; its results are those of every other one, to the last byte."""
    out = folder / f"{round_}_{processes}"
    used = opsim(caches, "run", file, "-o", out, "--processes", processes)
    first = folder / "0_1" / "base"
    names = [
        "summary.json",
        "kpis.parquet",
        "report.html",
        *(f"events/replication_{r:05d}.parquet" for r in (0, 77, 199)),
    ]
    assert all((out / "base" / name).read_bytes() == (first / name).read_bytes() for name in names)
    return used
