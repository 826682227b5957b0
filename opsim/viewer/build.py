"""What stands at the foot of a replay: which run it is, whose movements these are, and what is not drawn from any.

How far people come on the floor: a first picture that shows all of it leaves nobody out.

What stands on the floor through the shift: queues, jobs in work and states of stations, what lies in stores.

From a run that was opened again to a scene: everything that a page shows of one replication of one variant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from opsim.layout import ways as ways_of_layout
from opsim.log import BLOCKED, DOWN, HELD, OFF, QUEUE, REPAIR, SETUP, STOCK, WORK, EventLog
from opsim.plan import Plan
from opsim.study.run import Reopened
from opsim.subjects.stations.plan import STATION, STORE
from opsim.task_model import behind
from opsim.viewer.floor import floor_of, roads_of
from opsim.viewer.playback import FAR_M, with_walking
from opsim.viewer.pose import standing
from opsim.viewer.routes import Routes, WayList
from opsim.viewer.scene import Courses, Performed, Scene, Segments, Ways
from opsim.viewer.scores import rula
from opsim.viewer.segments import SHOWN_STATES, People, is_gone, moves, people
from opsim.viewer.skeletons import path_of


def notes_of(summaries: Mapping[str, Mapping[str, Any]], replication: int) -> list[tuple[str, str]]:
    """(topic, words) of the variants that are shown, by name; each as in ``summary.json``."""
    seeds = sorted({summary["seed"] for summary in summaries.values()})
    run = f"replication {replication}, seed {', '.join(map(str, seeds))}: one course of luck, not the average"
    tasks = [row for summary in summaries.values() for row in summary["tasks"]]
    walks = [summary["walking"] for summary in summaries.values() if summary.get("walking")]
    return [
        ("Run", run),
        *_movements([*(row for row in tasks if row.get("emulated")), *walks]),
        *_without_body(tasks),
        ("Licences", "; ".join(_once(row["licence"] for row in [*tasks, *walks] if row.get("licence")) or ["none"])),
    ]


def _movements(rows: list[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Whose movements the people make, each source once with all that was learned from it."""
    said = []
    for source in _once(row["source"] for row in rows):
        learned = {(row["library"], row["library_task"]): row for row in rows if row["source"] == source}.values()
        n_workers = max(row["n_workers"] for row in learned)
        said.append(f"{source} ({behind(source, sum(row['n_sequences'] for row in learned), n_workers)})")
    drawn = "emulated, each performance as the run drew it, from"
    return [("Movements", f"{drawn} {'; '.join(said)}")] if said else []


def _without_body(tasks: list[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Tasks whose times were spent and whose movements nobody knows."""
    names = _once(row["task"] for row in tasks if not row.get("emulated") and not row.get("automatic"))
    if not names:
        return []
    return [("Without movement", f"{', '.join(names)}: times without a body; who does them is drawn standing")]


def _once(words: Any) -> list[str]:
    return list(dict.fromkeys(words))


LOOKED_AT, SHARES = 4, np.linspace(0.0, 1.0, 9)
"""How many performances stand for all of a model, and when in them they are looked at."""

Box = tuple[float, float, float, float]
"""West, south, east and north end, in metres."""


def reach_m(segments: Segments, ways: Ways, performed: Performed, there: np.ndarray) -> Box | None:
    """The box round all ways, and round all places of those who are ``there`` (R,), a task's own walks included."""
    stays = there & (segments.way < 0)
    x, y = (np.concatenate(pair) for pair in ((segments.x_m[stays], ways.x_m), (segments.y_m[stays], ways.y_m)))
    doing = np.flatnonzero(stays & (segments.performance >= 0))
    model = performed.model[segments.performance[doing]]
    for number in np.unique(model).tolist():
        own = _own_m(performed.drawn[number].blocks[0])
        if np.abs(own).max() > FAR_M:
            rows = doing[model == number]
            c, s = np.cos(segments.yaw_rad[rows])[:, None], np.sin(segments.yaw_rad[rows])[:, None]
            x = np.r_[x, (segments.x_m[rows, None] + c * own[:, 0] - s * own[:, 1]).ravel()]
            y = np.r_[y, (segments.y_m[rows, None] + s * own[:, 0] + c * own[:, 1]).ravel()]
    if not x.size:
        return None
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _own_m(block: Any) -> np.ndarray:
    """(points, 2) where roots of a few performances of a model are, in their own frame."""
    some = block[np.arange(min(len(block.duration_s), LOOKED_AT))]
    path = np.asarray(path_of(some, np.asarray(some.duration_s)[:, None] * SHARES))
    return path[..., :2].reshape(-1, 2)


STATION_STATES = ("starved", "work", "setup", "blocked", "waiting", "down", "repair", "closed")
"""What a station does, as a whole; further to the right in ``_BEFORE`` goes before."""
_BEFORE = ("waiting", "blocked", "closed", "setup", "work", "down", "repair")


def stations(log: EventLog, plan: Plan, low_s: float, high_s: float) -> Courses:
    """Of each station: ``queue``, jobs that wait in front; ``busy``, servers at work; ``state``."""
    of_job, of_station = log["job"] >= 0, (log["job"] < 0) & (log["worker"] < 0)
    kind = log["kind"]
    masks = {
        "queue": (kind == QUEUE) & of_job & (log["cause"] != STOCK),
        "work": (kind == WORK) & of_job,
        "setup": kind == SETUP,
        "blocked": (kind == BLOCKED) & of_job,
        "waiting": (kind == HELD) & of_job,
        "down": (kind == DOWN) & of_station,
        "repair": (kind == REPAIR) & of_station,
        "closed": (kind == OFF) & of_station,
    }
    found = []
    for rank, station in enumerate(plan.stations):
        if station.kind == STATION:
            here = {name: np.flatnonzero(mask & (log["station"] == rank)) for name, mask in masks.items()}
            at_s, counts = levels(log, here, low_s, high_s)
            busy = np.minimum(counts["work"] + counts["setup"], station.servers)
            found.append((at_s, {"queue": counts["queue"], "busy": busy, "state": _state(counts)}))
    return _courses(found, ("queue", "busy", "state"))


def _state(counts: Mapping[str, np.ndarray]) -> np.ndarray:
    """Of each moment the number of STATION_STATES that says most."""
    found = np.zeros(counts["work"].size, dtype=int)
    for name in _BEFORE:
        found[counts[name] > 0] = STATION_STATES.index(name)
    return found


def stores(log: EventLog, plan: Plan, low_s: float, high_s: float) -> Courses:
    """Of each store: ``level``, the jobs that lie there."""
    lying = (log["kind"] == QUEUE) & (log["cause"] == STOCK)
    found = []
    for rank, store in enumerate(plan.stations):
        if store.kind == STORE:
            here = {"level": np.flatnonzero(lying & (log["station"] == rank))}
            found.append(levels(log, here, low_s, high_s))
    return _courses(found, ("level",))


def levels(
    log: EventLog, rows: Mapping[str, np.ndarray], low_s: float, high_s: float
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """(times (R,), counts (R,) by name) of the rows that are open, from each of these times on; on change only."""
    edges = [np.r_[log["start_s"][some], log["end_s"][some]] for some in rows.values()]
    times_s = np.unique(np.clip(np.concatenate([[low_s], *edges]), low_s, high_s))
    times_s = times_s[times_s < high_s] if high_s > low_s else times_s[:1]
    counts = {name: _open(log, some, times_s) for name, some in rows.items()}
    table = np.array(list(counts.values()))
    changed = np.r_[True, (np.diff(table, axis=1) != 0).any(axis=0)]
    return times_s[changed], {name: column[changed] for name, column in counts.items()}


def _open(log: EventLog, rows: np.ndarray, times_s: np.ndarray) -> np.ndarray:
    """(R,) how many rows have begun and not ended at each time."""
    begun = np.searchsorted(np.sort(log["start_s"][rows]), times_s, side="right")
    return begun - np.searchsorted(np.sort(log["end_s"][rows]), times_s, side="right")


def _courses(found: list[tuple[np.ndarray, dict[str, np.ndarray]]], names: tuple[str, ...]) -> Courses:
    first = np.cumsum([0, *(at_s.size for at_s, _ in found)])
    at_s = np.concatenate([np.zeros(0), *(at_s for at_s, _ in found)])
    columns = {name: np.concatenate([np.zeros(0, int), *(own[name] for _, own in found)]) for name in names}
    return Courses(first, at_s, columns)


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
