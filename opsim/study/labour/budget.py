"""The variability budget: what each source costs, all together, and what they do to each other.

Each number is a figure with something switched off minus the full one, of the same workforce on the same day. So the
parts and the interaction add up to the whole, workforce by workforce and day by day.

Whether people differ in a scenario, and changes of who they are.

Sources of variability that a scenario has on, and what it is to switch each of them off.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from statistics import fmean
from typing import Any

import numpy as np

from opsim.plan import Plan
from opsim.results import Key
from opsim.scenario.schema.scenario import Loaded
from opsim.study.compare import ROUNDING
from opsim.study.intervals import CONFIDENCE, Interval
from opsim.study.labour.variance_components import CROSSED, mean_interval


@dataclass(frozen=True, slots=True)
class FigureBudget:
    """Of one figure: each an interval of "off minus full".

    full, all_off : the figure itself; parts : by source, switched off alone; whole : all off; interaction : whole minus
    the sum of the parts; alone : by source, where asked: what the source changes where it is the only one
    """

    key: Key
    full: Interval
    all_off: Interval
    parts: dict[str, Interval]
    interaction: Interval
    whole: Interval
    alone: dict[str, Interval]


def figure_budget(
    key: Key,
    full: np.ndarray,
    off: Mapping[str, np.ndarray],
    all_off: np.ndarray,
    alone: Mapping[str, np.ndarray] | None = None,
    design: str = CROSSED,
) -> FigureBudget:
    """All arrays (W, R), of the same workforces and days; nan where a figure was not observed."""
    crossed = design == CROSSED
    whole = all_off - full
    changes = {name: table - full for name, table in off.items()}
    left = whole - sum(changes.values(), np.zeros_like(whole))
    return FigureBudget(
        key,
        table_interval(full, crossed),
        table_interval(all_off, crossed),
        {name: difference_interval(table, full, crossed) for name, table in changes.items()},
        difference_interval(left, full, crossed),
        difference_interval(whole, full, crossed),
        {name: difference_interval(all_off - table, full, crossed) for name, table in (alone or {}).items()},
    )


def difference_interval(
    apart_by: np.ndarray, of: np.ndarray, crossed: bool, confidence: float = CONFIDENCE
) -> Interval:
    """Of a table of paired differences; what is only the order in which numbers were added is 0."""
    if np.abs(apart_by).max(initial=0) <= ROUNDING * np.abs(of).max(initial=0):
        apart_by = np.zeros_like(apart_by)
    return table_interval(apart_by, crossed, confidence)


def table_interval(table: np.ndarray, crossed: bool, confidence: float = CONFIDENCE) -> Interval:
    """``mean_interval``, or nan where something is missing: a table with holes is told as not known."""
    if not np.isfinite(table).all():
        return Interval(np.nan, np.nan, np.nan, int(np.count_nonzero(np.isfinite(table))))
    return mean_interval(table, crossed, confidence)


def whole_workers(loaded: Loaded, edits: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Changes that say all workers anew, by name, each with some keys replaced; names that are new are added.

    All of them are said: who is ``like`` another, or one of a workforce, would otherwise change with him.
    """
    workers: dict[str, Any] = {name: {**said} for name, said in loaded.resolved["workers"].items()}
    for name, keys in edits.items():
        workers[name] = {**workers.get(name, {}), **keys}
    changes: dict[str, Any] = {"workers": workers}
    if loaded.scenario.workforce is not None:
        changes["workforce"] = None
    return changes


def people_differ(plan: Plan) -> bool:
    """Whether another workforce takes other times: whether a task that people do draws an effect for its worker.

    Who is a recorded person is the same in every workforce.
    """
    drawn = [number for number, worker in enumerate(plan.workers) if not _recorded(worker.body)]
    by_hand = [task for task in plan.tasks if not task.automatic]
    return any(plan.worker_effect(drawn[0], task, workforce=1) is not None for task in by_hand if drawn)


def _recorded(body: Any) -> bool:
    person = body.get("person") if isinstance(body, Mapping) else getattr(body, "person", None)
    return person is not None


BETWEEN, WITHIN = "between workers", "within workers"
LEFT = {
    "full": {BETWEEN, WITHIN},
    "shuffled": {BETWEEN, WITHIN},
    "within_only": {WITHIN},
    "between_only": {BETWEEN},
    "none": set(),
}
"""Which of the two a switch of ``run: variability`` leaves on."""
SWITCH = {(True, True): "full", (True, False): "between_only", (False, True): "within_only", (False, False): "none"}
EFFECTS = {
    "pace": (("state_pace",), "nobody is quicker or slower by what waits for him"),
    "learning": (("learning", "forgetting"), "everybody takes the times of the file from the first repetition on"),
    "forgetting": (("forgetting",), "what was learned stays"),
    "fatigue": (("fatigue", "rest", "errors"), "nobody tires; rest by need and errors of the tired go with it"),
    "rest by need": (("rest",), "nobody rests but in breaks"),
    "errors": (("errors",), "who is tired errs no more than who is fresh"),
    "time of day": (("circadian",), "the hour of the day changes nothing"),
}
"""By source: the keys of ``human`` that are null where it is off, the source's own first, and what that means."""
RATINGS, ABSENCE, BREAKS = "skill ratings", "absence", "breaks"


@dataclass(frozen=True, slots=True)
class VariabilitySource:
    """A source that is on. ``off``: what switching it off means; ``keeps_mean``: it leaves all mean times of tasks."""

    name: str
    off: str
    keeps_mean: bool = False


def sources_on(loaded: Loaded) -> tuple[VariabilitySource, ...]:
    """The sources that a scenario has on, in a fixed order; people differ in some task beyond their ratings."""
    left = LEFT[loaded.scenario.run.variability]
    found = []
    if BETWEEN in left:
        found.append(VariabilitySource(BETWEEN, "everybody has the mean time of all people", True))
    if WITHIN in left:
        found.append(VariabilitySource(WITHIN, "each takes his own mean time, again and again", True))
    if _levelled(loaded):
        found.append(VariabilitySource(RATINGS, "at each station everybody has the mean pace of those there", True))
    human = loaded.scenario.human
    found += [VariabilitySource(name, off) for name, (keys, off) in EFFECTS.items() if getattr(human, keys[0])]
    if human.absence or any(worker.absence for worker in loaded.scenario.workers.values()):
        found.append(VariabilitySource(ABSENCE, "everybody comes to every shift: more hours are worked", True))
    if any(shift.breaks or shift.meetings for shift in loaded.scenario.shifts.values()):
        found.append(VariabilitySource(BREAKS, "breaks and meetings are worked through: more hours are worked", True))
    return tuple(found)


def changes_off(loaded: Loaded, off: Iterable[str]) -> dict[str, Any]:
    """The changes that switch some sources off together: dotted paths and plain values."""
    names = set(off)
    changes: dict[str, Any] = {}
    variability = loaded.scenario.run.variability
    left = LEFT[variability] - names
    if left != LEFT[variability]:
        changes["run.variability"] = SWITCH[BETWEEN in left, WITHIN in left]
    for name, (keys, _) in EFFECTS.items():
        if name in names:
            changes |= {f"human.{key}": None for key in keys if getattr(loaded.scenario.human, key) is not None}
    if BREAKS in names:
        changes |= _no_breaks(loaded)
    if ABSENCE in names and loaded.scenario.human.absence is not None:
        changes["human.absence"] = None
    edits = [edit for name, edit in _EDITS.items() if name in names]
    if edits:
        changes |= whole_workers(loaded, _edited(loaded, edits))
    return changes


def _no_breaks(loaded: Loaded) -> dict[str, Any]:
    return {
        f"shifts.{name}.{key}": {}
        for name, shift in loaded.scenario.shifts.items()
        for key in ("breaks", "meetings")
        if getattr(shift, key)
    }


def _edited(loaded: Loaded, edits: Iterable[Callable[[Loaded], Mapping[str, Any]]]) -> dict[str, dict[str, Any]]:
    workers: dict[str, dict[str, Any]] = {name: {} for name in loaded.resolved["workers"]}
    for edit in edits:
        for name, keys in edit(loaded).items():
            workers[name] |= keys
    return workers


def _all_come(loaded: Loaded) -> dict[str, dict[str, Any]]:
    return {name: {"absence": 0} for name, worker in loaded.scenario.workers.items() if worker.absence}


def _levelled(loaded: Loaded) -> dict[str, dict[str, Any]]:
    """By worker, the keys that change where at each station all who have the skill have one pace.

    It is the pace of which the mean time is that of theirs: 1 / mean of (1 / pace).
    """
    workers = loaded.scenario.workers
    paces: dict[str, list[float]] = {}
    for worker in workers.values():
        for station, skill in worker.skills.items():
            paces.setdefault(station, []).append(pace_of(skill))
    level = {station: 1 / fmean(1 / pace for pace in of) for station, of in paces.items() if len(set(of)) > 1}
    return {
        name: {"skills": {station: _repaced(skill, level.get(station)) for station, skill in worker.skills.items()}}
        for name, worker in workers.items()
        if any(station in level for station in worker.skills)
    }


_EDITS: dict[str, Callable[[Loaded], dict[str, dict[str, Any]]]] = {ABSENCE: _all_come, RATINGS: _levelled}


def pace_of(skill: Any) -> float:
    """The pace of a skill, which is a number or has a pace and a quality."""
    return float(getattr(skill, "pace", skill))


def _repaced(skill: Any, pace: float | None) -> Any:
    """A skill as plain YAML, with another pace where there is one."""
    quality = getattr(skill, "quality", None)
    rated = pace_of(skill) if pace is None else pace
    return rated if quality is None else {"pace": rated, "quality": quality}
