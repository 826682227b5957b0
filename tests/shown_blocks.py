"""What a log shows of blocks about people: that it would be another without one, or what only that one does."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np
from checked_floors import differ, plan_of
from contests import stays_on
from made.floors import text_of

from opsim import log as kinds
from opsim.engine.floor.run import run_plan
from opsim.log import EventLog
from opsim.plan import Plan


def _without(section: str, key: str) -> Callable[[dict], dict]:
    """The scenario without a key in each entry of a section, or in the section itself."""

    def strip(values: dict) -> dict:
        found = deepcopy(values)
        for entry in (found.get(section, {}), *found.get(section, {}).values()):
            if isinstance(entry, dict):
                entry.pop(key, None)
        return found

    return strip


def _all_good(values: dict) -> dict:
    """The scenario with the pace of skills alone."""
    found = deepcopy(values)
    found["skill_levels"]["learner"].pop("quality")
    for worker in found["workers"].values():
        for station, level in worker["skills"].items():
            worker["skills"][station] = level["pace"] if isinstance(level, dict) else level
    return found


WITHOUT: dict[str, Callable[[dict], dict]] = {
    "choice_of_work": _without("allocation", "rule"),
    "levels": _all_good,
    "zones": _without("workers", "zone"),
    "floaters": _without("workers", "floater"),
    "station_priorities": _without("stations", "priority"),
    "limited": _without("allocation", "serve"),
    "work_sharing": _without("stations", "share"),
    "task_rules": _without("tasks", "interruption"),
    "station_hours": _without("stations", "shift"),
    "source_hours": lambda values: _without("release", "shift")(_without("sources", "shift")(values)),
}
"""Blocks that are contested where the log is another one without them."""


def _caused(*causes: int) -> Callable[[EventLog, Plan], bool]:
    return lambda log, _plan: bool(np.any(np.isin(log["cause"], causes)))


def _of(kind: int) -> Callable[[EventLog, Plan], bool]:
    return lambda log, _plan: bool(len(log.of(kind)))


SEEN: dict[str, Callable[[EventLog, Plan], bool]] = {
    "shifts": _of(kinds.OFF),
    "breaks": _of(kinds.BREAK),
    "meetings": _caused(kinds.MEETING),
    "absence": _of(kinds.ABSENT),
    "overtime": stays_on,
    "brigade": _caused(kinds.BEHIND),
    "rabbits": _caused(kinds.BEHIND),
    "indexed_line": _caused(kinds.TAKT, kinds.LINE_STOP, kinds.UNFINISHED),
    "moving_line": _caused(kinds.TAKT, kinds.LINE_STOP, kinds.UNFINISHED),
    "rotation": lambda log, plan: all(_posts_seen(log, turns) for turns in plan.rotations) and bool(plan.rotations),
}
"""Blocks that are contested where the log shows what only they do."""


def _posts_seen(log: EventLog, turns) -> bool:
    """Whether one of those who rotate has worked at two posts."""
    rows = log.of(kinds.WORK)
    posts = [
        {post for post, at in enumerate(turns.posts) if np.any(np.isin(_stations(rows, w), at))} for w in turns.workers
    ]
    return max(map(len, posts)) > 1


def _stations(rows: EventLog, worker: int) -> np.ndarray:
    return rows["station"][rows["worker"] == worker]


def shown(name: str, values: dict, log: EventLog, p: Plan) -> bool:
    """Whether a block about people is contested in a scenario."""
    if name in SEEN:
        return SEEN[name](log, p)
    stripped = WITHOUT[name](values)
    return stripped != values and differ(log, run_plan(plan_of(text_of(stripped)))) != []
