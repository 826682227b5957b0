"""How fast a replication of twenty workers becomes OCEL 2.0, and how little of it is in the memory at once.

Small: one replication of 8 h, 75,348 rows. Measured, of processor: JSON (37 MB) 1.2 s, SQLite (23 MB)
1.8 s; of memory 57 MB.
"""

import json
import time
import tracemalloc

import pytest

from opsim.engine.floor.run import run_plan
from opsim.export.ocel import object_log, write_ocel_json, write_ocel_sqlite
from opsim.export.tables import RunClock
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

WORKERS = 20


def big():
    """A saturated line of twenty stations with a worker at each, as YAML."""
    ranks = range(WORKERS)
    lines = (
        "opsim: 1\nname: Big\nrun: {horizon: 8 h, seed: 7, posture: off}",
        f"layout: {{places: {{{', '.join(f'p{i}: [{3 * i} m, 0 m]' for i in ranks)}}}}}",
        "tasks: {take: {fixed: 3 s}, put: {dist: lognormal, mean: 20 s, cv: 0.25}}",
        f"stations: {{{', '.join(f's{i}: {{at: p{i}, tasks: [take, put], buffer: 6}}' for i in ranks)}}}",
        f"products: {{carton: {{route: [{', '.join(f's{i}' for i in ranks)}]}}}}",
        "release: {kind: saturated}",
        f"workers: {{{', '.join(f'w{i}: {{skills: {{s{i}: 1.0}}}}' for i in ranks)}}}",
        "outputs: [throughput_per_h]",
    )
    return "\n".join(lines)


@pytest.mark.parametrize("write", [write_ocel_json, write_ocel_sqlite])
def test_a_shift_of_twenty_workers_as_ocel(write, tmp_path):
    plan = compile_plan(scenarios_in(big().encode(), tmp_path / "big.yaml")["base"])
    log = run_plan(plan, 0)
    begun_s = time.process_time()
    made = object_log(log, plan, RunClock(plan.start_s))
    write(made, tmp_path / "log")
    took_s = time.process_time() - begun_s
    tracemalloc.start()
    write(made, tmp_path / "log")
    most_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    size = (tmp_path / "log").stat().st_size
    of = f"{write.__name__}: {len(log):,} rows, {size / 1e6:.1f} MB"
    print(f"\n{of}: {took_s:.1f} s of processor, {most_bytes / 1e6:.0f} MB of memory at most")
    if write is write_ocel_json:
        assert len(json.loads((tmp_path / "log").read_text())["events"]) == len(log)
