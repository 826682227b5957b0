"""A study of 1,000 points, two replications each: gone on with when nothing is left to do, merged from two shards."""

from bench.made_line import line
from bench.whole_command import opsim

SWEPT = ("--vary", "release.every=25 s..40 s", "--design", "grid", "--levels", 1000, "--figure", "throughput_per_h")
SHARED = ("summary.json", "figures.parquet", "sweep.html")


def test_a_thousand_points(tmp_path):
    file, caches = line(tmp_path, horizon="20 min"), tmp_path / "caches"
    words = ("sweep", file, *SWEPT, "--replications", 2, "--processes", 2)
    whole, halves, merged = tmp_path / "whole", [tmp_path / "one", tmp_path / "two"], tmp_path / "merged"
    first = opsim(caches, *words, "-o", whole)
    before = [(whole / name).read_bytes() for name in SHARED]
    again = opsim(caches, *words, "-o", whole)
    for part, half in enumerate(halves, 1):
        opsim(caches, *words, "-o", half, "--shard", f"{part}/2")
    merging = opsim(caches, "merge", *halves, "-o", merged)
    assert [(whole / name).read_bytes() for name in SHARED] == before
    assert [(merged / name).read_bytes() for name in SHARED] == before
    for name, used in (("computed", first), ("nothing left to do", again), ("two shards merged", merging)):
        print(
            f"\n1,000 points x 2, {name}: {used.wall_s:.1f} s, {used.own_s:.1f} s of CPU, {used.own_mb:.0f} MB", end=""
        )
    print()
