"""What the fast engine costs before its first row, by the clock and by CPU, and how much memory it holds."""

import pytest
from bench.fast_runs import in_a_process

from opsim.shipped import shipped_folder

STATE_MB, COLD_S, WARM_S = 50, 20, 1


def test_memory_of_a_hundred_stations_and_a_hundred_workers():
    for name, found in in_a_process("memory").items():
        told = ", ".join(f"{key.replace('_mb', '')} {value:.1f} MB" for key, value in found.items() if key != "rows")
        print(
            f"\n{name} of 100 stations and 100 workers, 8 h, {found['rows']} rows: {told} (target {STATE_MB})", end=""
        )
        assert found["arena_mb"] + found["frozen_mb"] < STATE_MB


@pytest.mark.parametrize("name", ["line", "two_shift_plant"])
def test_first_run(tmp_path, name):
    """With nothing compiled, on all cores, and with all on disk, the best of three."""
    file = name if name == "line" else shipped_folder() / f"{name}.yaml"
    cold, *warm = [in_a_process("first_row", file, cache=tmp_path / "cache") for _ in range(4)]
    assert cold["compiled"] > 0 and all(one["compiled"] == 0 for one in warm)
    best = min(warm, key=lambda one: one["ready_cpu_s"] + one["run_cpu_s"])
    _told(f"{name}, nothing compiled", cold, COLD_S)
    _told(f"{name}, all on disk", best, WARM_S)


def _told(what, one, target):
    to_first, cpu_s = (sum(one[f"{step}{of}_s"] for step in ("ready", "run")) for of in ("", "_cpu"))
    print(f"\n{what}: {to_first:.2f} s by the clock, {cpu_s:.2f} s of CPU from a plan to its rows (target {target})")
    print(f"ready {one['ready_s']:.2f} s, {one['compiled']} parts compiled; first run {one['run_s']:.2f} s, ", end="")
    print(f"next {one['again_s']:.3f} s; CPU {one['ready_cpu_s']:.2f} s and {one['run_cpu_s']:.2f} s")
    print(f"before: read {one['read_s']:.2f} s, engine imported {one['import_s']:.2f} s, ", end="")
    print(f"CPU {one['before_cpu_s']:.2f} s; whole process {one['whole_s']:.2f} s", end="")
