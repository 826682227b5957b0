"""Walking in a scenario: minutes of walking posture, times, steps, and feet that stay where they bear."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

SCENARIO = "walking_cell"
REPLICATIONS = 3
MOST_SLIDE_MM, MOST_TIMES = 3.0, 12
Line = tuple[str, str, bool]


def evidence(motion: Path, out: Path) -> Iterator[Line]:
    """(claim, found, holds); pictures of a walk of each worker go into ``out``."""
    from opsim.engine.floor.run import run_plan
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    plan = compile_plan(read_scenarios(SCENARIO)["base"])
    logs = [run_plan(plan, replication) for replication in range(REPLICATIONS)]
    yield from _rows(plan, logs)
    yield from _minutes(plan, logs)
    yield from _times(plan, logs)
    yield from _steps(plan, logs)
    yield from _feet(plan, logs[0], out)
    yield from _cost(plan)


def _rows(plan: Any, logs: list[Any]) -> Iterator[Line]:
    from opsim.engine.floor.run import run_plan

    without = [run_plan(replace(plan, walking=None), log.replication) for log in logs]
    same = all(
        np.array_equal(log[name], other[name], equal_nan=True)
        for log, other in zip(logs, without)
        for name in log.columns
    )
    rows = sum(len(log) for log in logs)
    yield (
        "the rows of a run are the same with and without walking postures",
        f"{rows:,} rows, {'all' if same else 'not all'} equal",
        same,
    )


def _minutes(plan: Any, logs: list[Any]) -> Iterator[Line]:
    from opsim.ergonomics.walking import walking_exposure
    from opsim.log import WALK

    found, rows = [walking_exposure(log, plan) for log in logs], [log.of(WALK) for log in logs]
    measured_s = sum(one.exposure.measured_s.sum() for one in found)
    in_rows_s = sum(one.clipped_s(*plan.window_s).sum() for one in rows)
    hours = len(logs) * len(plan.workers) * (plan.horizon_s - plan.warm_up_s) / 3600
    seen = (
        f"{measured_s / 60 / hours:.2f} minutes of each hour of a worker; rows of walking {in_rows_s / 60 / hours:.2f}"
    )
    yield "minutes of walking posture are the time workers walk", seen, bool(abs(measured_s / in_rows_s - 1) < 1e-9)


def _drawn(plan: Any, log: Any) -> Iterator[tuple[int, np.ndarray, np.ndarray, Any]]:
    """(worker, metres, drawn seconds of his walks, the walks) block by block."""
    from opsim.ergonomics.walking import drawn_walks
    from opsim.history import walks_of
    from opsim.streams import BLOCK

    walks = walks_of(log, plan)
    for rows, block in drawn_walks(walks, plan, log.replication):
        some = block[walks.k[rows] % BLOCK]
        yield int(walks.worker[rows[0]]), walks.distance_m[rows], np.asarray(some.duration_s), some


def _times(plan: Any, logs: list[Any]) -> Iterator[Line]:
    from opsim.history import walks_of

    worst = 0.0
    for log in logs:
        walks = walks_of(log, plan)
        whole = walks.end_s < plan.horizon_s
        speed = np.array([worker.walk_m_per_s for worker in plan.workers])[walks.worker]
        worst = max(worst, float(np.abs(walks.end_s - walks.start_s - walks.distance_m / speed)[whole].max()))
    yield (
        "a walk of the run takes distance / speed",
        f"to {1e6 * worst:.1f} microseconds (the grid of time)",
        worst < 2**-19,
    )
    for rank, worker in enumerate(plan.workers):
        ratio = np.concatenate(
            [s * worker.walk_m_per_s / m for log in logs for who, m, s, _ in _drawn(plan, log) if who == rank]
        )
        error = ratio.std(ddof=1) / np.sqrt(ratio.size)
        seen = f"{ratio.mean():.4f} +- {1.96 * error:.4f} of it, {ratio.size} walks, spread {ratio.std():.3f}"
        yield f"drawn walks of {worker.name} take distance / speed on average", seen, bool(abs(ratio.mean() - 1) < 0.02)


def _steps(plan: Any, logs: list[Any]) -> Iterator[Line]:
    from opsim.kpi import figures
    from opsim.kpi.catalogue import WALKING

    found = [{f[:3]: f.value for f in figures(log, plan, WALKING)} for log in logs]
    length_m = {w.name: np.mean([one["step_length_m", w.name, ""] for one in found]) for w in plan.workers}
    cadence = {w.name: np.mean([one["cadence_per_min", w.name, ""] for one in found]) for w in plan.workers}
    slow, fast = sorted(plan.workers, key=lambda w: w.walk_m_per_s)[:: len(plan.workers) - 1]
    seen = "; ".join(
        f"{w.name} ({w.body.height_m} m, {w.walk_m_per_s} m/s) {length_m[w.name]:.2f} m, {cadence[w.name]:.0f} a minute"
        for w in (slow, fast)
    )
    holds = length_m[fast.name] > 1.1 * length_m[slow.name] and cadence[fast.name] > cadence[slow.name]
    yield "step length and cadence follow the worker", seen, bool(holds)


def _feet(plan: Any, log: Any, out: Path) -> Iterator[Line]:
    from opsim.report.sections.walking import FootWalk as Walk
    from opsim.report.sections.walking import draw_walk

    slid = []
    for rank, metres, _, walks in _drawn(plan, log):
        speed = plan.workers[rank].walk_m_per_s
        for i in range(min(12, len(walks))):
            one, seconds = walks[i], float(metres[i]) / speed
            n_times = round(60 * seconds) + 1
            joints_m, contact = one.positions_m(n_times=n_times)[0], one.contact(n_times=n_times)[0]
            name, way_m = plan.workers[rank].name, float(metres[i])
            walk = Walk(name, "a walk of the run", way_m, seconds, joints_m, contact, walks.skeleton)
            slid.append(walk.slide_mm)
            picture = out / f"walk_{name}.svg"
            if not picture.exists() and 4 < way_m < 7:
                picture.write_bytes(draw_walk(walk, way_m))
    seen = f"at most {max(slid):.2f} mm in a stance, {np.median(slid):.2f} mm at the median, {len(slid)} walks"
    yield f"no bearing foot slides by more than {MOST_SLIDE_MM:g} mm", seen, bool(max(slid) < MOST_SLIDE_MM)


def _cost(plan: Any) -> Iterator[Line]:
    from opsim.engine.floor.run import run_plan
    from opsim.kpi import figures
    from opsim.kpi.catalogue import POSTURE

    day = replace(plan, horizon_s=8 * 3600.0)
    log = run_plan(day)

    def seconds(of: Any) -> float:
        start = time.process_time()
        figures(log, of, POSTURE)
        return time.process_time() - start

    off_s, on_s = np.array([(seconds(replace(day, walking=None)), seconds(day)) for _ in range(3)]).min(axis=0)
    claim = f"figures of posture of a day cost at most {MOST_TIMES} times those without walking"
    yield claim, f"{on_s / off_s:.1f} times", bool(on_s < MOST_TIMES * off_s)
