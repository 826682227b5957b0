"""What exposure costs: a day of 24 hours and 20 people, drawn, decoded, measured, scored and booked on one core.

Looked at are the last two hours of everybody's day, a twelfth: the time of work that is done in a second of the
processor is the same for all of it, and the log that is gone through is that of the whole day.
"""

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from bench.cpu import best_s

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.measures import measures_of, n_cells
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.ledger import Booking
from opsim.kpi.window import inside_s
from opsim.log import WORK
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder

N_WORKERS, HORIZON_H, LOOKED_H = 20, 24, 2
FASTER_THAN_WORK, MOST_US_PER_CELL, MOST_MB = 10_000, 3.0, 64
TASKS = (
    *("bench/pick", "bench/place", "bench/fasten", "bench/inspect", "bench/lift", "bench/stoop", "bench/reach"),
    *("moves/deep_squat", "moves/side_lunge", "moves/shoulder_scaption", "moves/sit_to_stand"),
)


def day() -> str:
    """Twenty people at a post each, with four movements each that all have bodies, busy all day."""
    ranks = range(N_WORKERS)
    tasks = [f"  t{i}: {{emulator: {name}, load: 6 kg}}" for i, name in enumerate(TASKS)]
    some = [", ".join(f"t{(3 * i + step) % len(TASKS)}" for step in range(4)) for i in ranks]
    return "\n".join(
        [
            "opsim: 1",
            "name: A day of twenty",
            f"run: {{horizon: {HORIZON_H} h, warm_up: {HORIZON_H - LOOKED_H} h, seed: 4}}",
            "libraries: {bench: libraries/bench_work.npz, moves: libraries/public_movements.npz}",
            "layout: {places: {" + ", ".join(f"p{i}: [{3 * i} m, 0 m]" for i in ranks) + "}}",
            "tasks:",
            *tasks,
            "stations:",
            *(f"  s{i}: {{at: p{i}, tasks: [{some[i]}], buffer: 1}}" for i in ranks),
            "products: {" + ", ".join(f"q{i}: {{route: [s{i}]}}" for i in ranks) + "}",
            "sources: {" + ", ".join(f"f{i}: {{kind: saturated, products: [q{i}]}}" for i in ranks) + "}",
            "workers: {" + ", ".join(f"w{i}: {{skills: {{s{i}: 1.0}}}}" for i in ranks) + "}",
        ]
    )


@pytest.fixture(scope="module")
def looked_at():
    """Plan, log, and seconds that people worked in the two hours."""
    plan = compile_plan(scenarios_in(day().encode(), Path(shipped_folder() / "day.yaml"))["base"])
    log = run_plan(plan)
    rows = np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0))
    return plan, log, float(inside_s(log, rows, plan).sum())


def booked(plan, log):
    booking = Booking(plan.start_s)
    fold(log, plan, [booking])
    return booking.close().together()


def test_a_day_of_twenty_people_is_scored_ten_thousand_times_as_fast_as_it_is_worked(looked_at):
    plan, log, worked_s = looked_at
    found = booked(plan, log)
    assert worked_s > 0.99 * N_WORKERS * LOOKED_H * 3600 and found.seconds[0] == pytest.approx(worked_s)
    assert found.unmeasured_s[0] == 0 and 0 < found.from_s("rula", 5)[0] <= found.from_s("rula_at_most", 5)[0]
    spent_s = best_s(lambda: booked(plan, log), rounds=2)[0]
    times = worked_s / spent_s
    print(f"\n{worked_s / 3600:.0f} h of work in {spent_s:.1f} s: {times:,.0f} times (target {FASTER_THAN_WORK:,})")
    assert times > FASTER_THAN_WORK


def test_exposure_holds_little_at_a_time(looked_at):
    plan, log, _ = looked_at
    tracemalloc.start()
    booked(plan, log)
    peak_mb = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    print(f"\npeak {peak_mb:.0f} MB (target {MOST_MB})")
    assert peak_mb < MOST_MB


def test_decoding_and_measuring_cost_at_most_three_microseconds_a_posture(looked_at):
    """Beside them the floor: decoding alone."""
    plan, *_ = looked_at
    blocks = [task.model.sample(64, np.random.default_rng(0)) for task in plan.tasks]
    cells = sum(64 * n_cells(block) for block in blocks)
    middles = [(np.arange(n_cells(block)) + 0.5) / n_cells(block) * block.duration_s[:, None] for block in blocks]
    assert all(np.isfinite(measures_of(block, range(64))).all() for block in blocks)
    all_s, decoding_s = best_s(
        lambda: [measures_of(block, range(64)) for block in blocks],
        lambda: [block.directions(times_s=at_s) for block, at_s in zip(blocks, middles)],
    )
    print(f"\n{all_s / cells * 1e6:.2f} us a posture, of which decoding {decoding_s / cells * 1e6:.2f}")
    assert all_s / cells * 1e6 < MOST_US_PER_CELL
