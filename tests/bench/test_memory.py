"""The most memory that 200 and 2,000 replications of a small model take, as runs with their events and as a study."""

import pytest
from bench.made_line import line
from bench.whole_command import opsim

SWEPT = ("--vary", "release.every=26 s,30 s", "--figure", "throughput_per_h")


@pytest.mark.parametrize("processes", [1, 2])
def test_of_a_run(tmp_path, processes):
    file = line(tmp_path, horizon="30 min")
    few, many = (_most_mb(tmp_path, "run", file, n, processes) for n in (200, 2000))
    print(f"\nopsim run, {processes} process(es): {few[0]:.0f} MB with 200 replications, {many[0]:.0f} MB with 2,000")
    print(f"largest other process: {few[1]:.0f} MB, {many[1]:.0f} MB")


@pytest.mark.parametrize("processes", [1, 2])
def test_of_a_study(tmp_path, processes):
    file = line(tmp_path, horizon="30 min")
    few, many = (_most_mb(tmp_path, "sweep", file, n // 2, processes, *SWEPT) for n in (200, 2000))
    print(f"\nopsim sweep, {processes} process(es): {few[0]:.0f} MB with 200 replications, {many[0]:.0f} MB with 2,000")
    print(f"largest other process: {few[1]:.0f} MB, {many[1]:.0f} MB")


def _most_mb(folder, verb, file, n, processes, *more):
    out = folder / f"{verb}_{n}"
    words = (verb, file, "-o", out, "--replications", n, "--processes", processes, *more)
    used = opsim(folder / "caches", *words)
    assert (out / ("base/summary.json" if verb == "run" else "summary.json")).exists()
    return used.own_mb, used.largest_child_mb
