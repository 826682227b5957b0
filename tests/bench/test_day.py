"""A day of twenty people, from the file to the report: memory and time of ``opsim run`` in a process of its own."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

LIBRARY = Path(__file__).parents[2] / "scenarios" / "libraries" / "bench_work.npz"
MOST_MB, N_STATIONS, N_WORKERS, HORIZON_H, REPLICATIONS = 500, 18, 20, 24, 2

MEASURED = """
import json, resource, subprocess, sys, time
started = time.monotonic()
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
spent = resource.getrusage(resource.RUSAGE_CHILDREN)
peak_kb = spent.ru_maxrss / (1024 if sys.platform == "darwin" else 1)
print(json.dumps([peak_kb / 1024, spent.ru_utime + spent.ru_stime, time.monotonic() - started]))
"""
"""NOTE: a small process between, since on Linux a child's peak begins at the size of the process that started it."""


def day() -> str:
    """A line of eighteen stations; a worker each and two who help everywhere; about 20-60 s of work a visit."""
    ranks = range(1, N_STATIONS + 1)
    tasks = [
        "  pick:   {emulator: bench/pick}",
        "  place:  {emulator: bench/place}",
        "  fasten: {emulator: bench/fasten, repeat: 4}",
        "  press:  {fixed: 20 s, automatic: true}",
        *(f"  t{i}: {{dist: lognormal, mean: {20 + 2 * (i % 5)} s, cv: 0.25, between_share: 0.5}}" for i in ranks),
    ]
    work = ("pick, place, t{0}", "pick, fasten, t{0}", "t{0}, press")
    stations = [
        f"  s{i}: {{at: p{i}, tasks: [{work[i % 3].format(i)}], servers: {1 + (i % 3 == 1)}, buffer: 3}}" for i in ranks
    ]
    own = [f"  w{i}: {{skills: {{s{i}: 1.0}}}}" for i in ranks]
    everywhere = ", ".join(f"s{i}: 0.9" for i in ranks)
    helpers = [f"  w{i}: {{skills: {{{everywhere}}}}}" for i in range(N_STATIONS + 1, N_WORKERS + 1)]
    return "\n".join(
        [
            "opsim: 1",
            "name: A day of twenty",
            f"run: {{horizon: {HORIZON_H} h, warm_up: 1 h, replications: {REPLICATIONS}, seed: 4}}",
            f"libraries: {{bench: {LIBRARY.name}}}",
            "layout: {places: {" + ", ".join(f"p{i}: [{3 * i} m, 0 m]" for i in ranks) + "}}",
            "tasks:",
            *tasks,
            "stations:",
            *stations,
            "products: {pump: {route: [" + ", ".join(f"s{i}" for i in ranks) + "]}}",
            "release: {kind: saturated}",
            "workers:",
            *own,
            *helpers,
            "outputs: [throughput_per_h, time_in_system_s, worker_states, station_states, walked_m]",
        ]
    )


@pytest.mark.slow
def test_a_day_of_twenty_people_stays_below_500_mb(tmp_path):
    shutil.copy(LIBRARY, tmp_path)
    (tmp_path / "day.yaml").write_text(day())
    opsim = [sys.executable, "-c", "from opsim.cli import main; main()"]
    run = [*opsim, "run", "day.yaml", "-o", "out", "--processes", "1"]
    call = [sys.executable, "-c", MEASURED, *run]
    printed = subprocess.run(call, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    peak_mb, cpu_s, wall_s = json.loads(printed)
    throughput_per_h = _throughput_per_h(tmp_path / "out")
    print(
        f"\n{HORIZON_H} h x {N_WORKERS} workers, {REPLICATIONS} replications, 1 process: peak {peak_mb:.0f} MB "
        f"(target {MOST_MB}), {cpu_s:.1f} s CPU, {wall_s:.1f} s"
    )
    assert 60 < throughput_per_h < 110  # the slowest station takes some 40 s a job
    assert peak_mb < MOST_MB


def _throughput_per_h(folder: Path) -> float:
    figures = json.loads(next(folder.rglob("summary.json")).read_text())["kpis"]
    return next(f["mean"] for f in figures if f["kpi"] == "throughput_per_h")
