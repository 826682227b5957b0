"""From a run that was opened again to a scene: everything that a page shows of one replication of one variant."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from opsim.layout import ways as ways_of_layout
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.plan.station import STATION
from opsim.study.reopened import Reopened
from opsim.viewer.floor import floor_of, roads_of
from opsim.viewer.moves import moves
from opsim.viewer.reach import reach_m
from opsim.viewer.scene import Scene
from opsim.viewer.scores import rula
from opsim.viewer.segments import SHOWN_STATES, People, is_gone, people
from opsim.viewer.series import STATION_STATES, stations, stores
from opsim.viewer.standing import standing
from opsim.viewer.walked import with_walking
from opsim.viewer.ways import Routes, WayList

Progress = Callable[[int, int], None]
"""Called with (done, total) as the work goes on."""


def scene_of(
    opened: Reopened,
    replication: int = 0,
    window_s: tuple[float, float] | None = None,
    progress: Progress | None = None,
    *,
    scores: bool = True,
    like: Reopened | None = None,
) -> Scene:
    """The scene of a replication, all of it or what lies between two times of its clock, in seconds.

    scores : whether RULA is looked at, which takes most of the time
    like : another variant that is shown too: its benches and these face the same way, where nothing near differs
    Raises ValueError for a replication that is not there, times outside the run or in the wrong order, or a task whose
    model draws what is no time; OSError for rows that cannot be read.
    """
    log, plan = opened.log(replication), opened.plan
    low_s, high_s = _window(window_s, log)
    measures = scores and plan.posture
    steps = 2 + measures * len(plan.workers)
    told = progress or (lambda done, total: None)
    layout = opened.loaded.scenario.layout
    told(0, steps)
    beside = None if like is None else (like.plan, like.loaded.scenario.layout)
    floor, ways = floor_of(plan, layout, beside), WayList()
    routes = Routes(ways_of_layout(layout), layout, [(bench.x_m, bench.y_m) for bench in floor.benches])
    walking, stand_in = with_walking(plan)
    who = people(log, walking, floor, routes, ways, low_s, high_s)
    under_way = moves(log, plan, floor, routes, ways, low_s, high_s)
    told(1, steps)
    drawn_ways, stands = ways.close(), standing(walking, replication)
    known = _known(log, who.segments.task, who.segments.performance, len(plan.tasks))
    told(2, steps)
    measured = rula(log, plan, low_s, high_s, lambda worker: told(2 + worker, steps)) if measures else None
    told(steps, steps)
    return Scene(
        name=opened.result.summary["variant"],
        title=plan.name,
        replication=replication,
        start_s=plan.start_s,
        low_s=low_s,
        high_s=high_s,
        states=SHOWN_STATES,
        station_states=STATION_STATES,
        places=tuple((name, *layout.places[name]) for name in plan.places),
        roads=roads_of(layout),
        benches=floor.benches,
        piles=floor.piles,
        belts=floor.belts,
        products=tuple(product.name for product in plan.products),
        tasks=tuple((task.name, bool(known[rank])) for rank, task in enumerate(plan.tasks)),
        workers=tuple((worker.name, worker.body.height_m) for worker in plan.workers),
        segments=who.segments,
        ways=drawn_ways,
        performed=who.performed,
        standing=stands,
        stations=stations(log, plan, low_s, high_s),
        stores=stores(log, plan, low_s, high_s),
        moves=under_way,
        rula=measured,
        reach_m=reach_m(who.segments, drawn_ways, who.performed, ~is_gone(who.segments.state)),
        notes=tuple(_notes(plan, who, stand_in)),
    )


def _window(window_s: tuple[float, float] | None, log: EventLog) -> tuple[float, float]:
    """The times shown. Raises ValueError where there are none between them, or they lie outside the run."""
    if window_s is None:
        return 0.0, log.horizon_s
    low_s, high_s = window_s
    if not 0 <= low_s < high_s <= log.horizon_s:
        raise ValueError(f"from {low_s:g} s to {high_s:g} s: expected times in order from 0 to {log.horizon_s:g} s")
    return float(low_s), float(high_s)


def _known(log: EventLog, task: np.ndarray, performance: np.ndarray, n_tasks: int) -> np.ndarray:
    """(n_tasks,) whether bodies are known of each task that is performed."""
    known = np.zeros(n_tasks, bool)
    known[task[(performance >= 0) & (task >= 0)]] = True
    return known


def _notes(plan: Plan, who: People, stand_in: str | None) -> Iterator[tuple[str, str]]:
    """What is shown otherwise than it was, in words."""
    if stand_in is not None and who.walks_shown:
        yield (
            "Walking",
            f"the scenario names no walking emulator: people walk as {stand_in} has it, in the time of the run",
        )
    if who.walks_drawn < who.walks_shown:
        share = f"{who.walks_drawn:,} of {who.walks_shown:,} walks are drawn"
        yield "Repeated walks", f"{share}; the others are shown by one of the same person that is about as long"
    if who.tasks_lead:
        yield (
            "Tasks that lead somewhere",
            "they end at their bench, or lead away and back; where no task leads back, nobody is seen to go",
        )
    if any(line.moves for line in plan.lines):
        yield "Moving lines", "the place of a station is taken as the beginning of its stretch of the line"
    if any(station.kind == STATION for station in plan.stations):
        yield "Benches", "the scenario says where stations are; how they stand and face there is the viewer's choice"
