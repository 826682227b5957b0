"""Answers as tables of workforces x replications, and which figures are asked for.

Scenarios that have nothing to split, each with the reason and the way out; and what is too little to be sure.

A labour study, as a function of answers: what is asked first, all at once, and what is made of it.

What a labour study found, as JSON: numbers as they are, in SI, none of them rounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.kpi.catalogue import EXPOSURE, POSTURE, read_asked
from opsim.plan import Plan
from opsim.problems import ScenarioError
from opsim.results import Key
from opsim.scenario.schema.scenario import Loaded
from opsim.study.intervals import Interval
from opsim.study.jobs import Answers, Job, Point
from opsim.study.labour.budget import (
    BETWEEN,
    LEFT,
    FigureBudget,
    VariabilitySource,
    figure_budget,
    people_differ,
    sources_on,
)
from opsim.study.labour.daily_output import DayAsked, DayFound, day_asked, day_found
from opsim.study.labour.interventions import (
    BoughtBack,
    Candidate,
    Points,
    bought_back,
    curve_of,
    jobs_of,
    more_skills,
    more_workers,
    points_of,
)
from opsim.study.labour.variance_components import CROSSED, VariancePart, VarianceParts, variance_parts

THROUGHPUT: Key = ("throughput_per_h", "", "", "1/h")
ALWAYS = (THROUGHPUT[0], "work_in_progress")
BY_THEMSELVES = {*POSTURE, *EXPOSURE, "fatigue_mean", "fatigue_most", "rest_taken_min_per_h"} - {
    "posture_measured_share"
}
"""Outputs that are figures of the budget where nobody names any: of all people, and of the one with most."""
NO_PARTS = ("", "worst")
MOST_FIGURES = 6
"""As many as a table of a page has room for."""


class Tables:
    """(W, R) tables of figures of points."""

    def __init__(self, answers: Answers, block: Any):
        self._answers, self._shape = answers, (block.workforces, block.replications)
        self._design = block.design

    def ask(self, points: Sequence[Point]) -> None:
        """Have all jobs of some points computed, in one go."""
        self._answers.ensure([job for point in points for job in self.jobs(point)])

    def jobs(self, point: Point) -> list[Job]:
        """Of a point, one workforce after the other."""
        return jobs_of(point, *self._shape, self._design)

    def of(self, point: Point, key: Key) -> np.ndarray:
        """(W, R) of one figure; nan where it was not observed."""
        return self._answers.values(self.jobs(point), [key]).reshape(self._shape)

    def keys(self, point: Point) -> list[Key]:
        """Of the figures that a point has."""
        return self._answers.keys(self.jobs(point))


def kept_figures(block: Any, loaded: Loaded) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    asked = block.figures or [name for name in loaded.scenario.outputs or () if name in BY_THEMSELVES]
    names = [*ALWAYS, *(read_asked(name).kpi for name in asked), day_asked(block.target, None).kpi]
    return tuple(dict.fromkeys(names))


def figures_of(block: Any, loaded: Loaded, known: Sequence[Key]) -> tuple[list[Key], list[str]]:
    """(keys of the figures that are split and budgeted, what is left out in words).

    Throughput, jobs inside, then what was asked for; else what the outputs say of bodies. Raises ValueError for a
    figure that these runs have not.
    """
    always = [key for name in ALWAYS for key in known if key[:3] == (name, "", "")]
    if block.figures:
        asked = [key for name in block.figures for key in _named(name, known)]
    else:
        outputs = BY_THEMSELVES.intersection(loaded.scenario.outputs or ())
        asked = [key for key in known if key[0] in outputs and not key[1] and key[2] in NO_PARTS]
    found = list(dict.fromkeys([*always, *asked]))
    left = ["/".join(key[:3]).rstrip("/") for key in found[MOST_FIGURES:]]
    words = [f"not told: {', '.join(left)}; name the figures that are wanted under 'figures'"] if left else []
    return found[:MOST_FIGURES], words


def _named(name: str, known: Sequence[Key]) -> list[Key]:
    one = read_asked(name)
    of = [key for key in known if key[:2] == (one.kpi, one.subject)]
    found = [key for key in of if (key[2] == one.part if one.part else key[2] in NO_PARTS)]
    if not found:
        there = sorted({"/".join(key[:3]).rstrip("/") for key in known if key[0] == one.kpi})
        hint = f"there are {', '.join(there[:8])}" if there else "these runs have none of it"
        raise ValueError(f"figures: no {one.name!r}; {hint}")
    return found


def refuse_nothing(loaded: Loaded, plan: Plan) -> None:
    """Raises ValueError where there is nobody, or people do not differ."""
    if not plan.workers:
        raise ValueError(f"{loaded.file}: there are no workers, so nobody is hired; 'opsim sweep' asks of machines")
    said = loaded.scenario.run.variability
    if BETWEEN not in LEFT[said]:
        raise ValueError(
            f"{loaded.file}: run.variability is {said}: differences between people are switched off already; take full"
        )
    if not people_differ(plan):
        raise ValueError(
            f"{loaded.file}: people do not differ in any task, so there is nothing to split; say how much of the "
            "spread of a time lies between them, such as 'between_share: 0.4' beside its cv, or take emulated tasks"
        )


FEWEST_DAYS = 3
"""Replications of a crossed design whose intervals hold what they say."""


def too_few_days(design: str, replications: int) -> str:
    """What to say of a crossed design whose intervals are too narrow; "" otherwise."""
    if design != CROSSED or replications >= FEWEST_DAYS:
        return ""
    return (
        "Two days cannot tell how much days differ, so the intervals here are too narrow (95 % ones hold 9 times in "
        "10): take --replications 4, or --design nested."
    )


@dataclass(frozen=True, slots=True)
class LabourFound:
    """What a labour study found; ``parts`` by figure, throughput first; budget and bought are empty where not asked.

    words : what was left out, and why; warning : why intervals are not to be trusted, "" where they are
    """

    design: str
    workforces: int
    replications: int
    parts: dict[Key, VarianceParts]
    day: DayFound
    sources: tuple[VariabilitySource, ...]
    budget: tuple[FigureBudget, ...]
    bought: BoughtBack | None
    words: tuple[str, ...]
    warning: str = ""

    def to_frame(self) -> Any:
        """The parts of each figure's variance as a pandas DataFrame. Raises ImportError where pandas is absent."""
        from opsim.results import frame_of_rows

        names = ("kpi", "subject", "part", "unit", "of", "variance", "low", "high", "share")
        rows = [
            (*key, one.name, one.variance, one.low, one.high, found.share(one.name))
            for key, found in self.parts.items()
            for one in found.parts
        ]
        return frame_of_rows(names, rows)


def labour(block: Any, loaded: Loaded, plan: Plan, variant: str | None, answers: Answers) -> LabourFound:
    """block : of ``studies: labour``; variant : of the file, None for its first.

    Raises ValueError where there is nothing to split, ScenarioError where a point is wrong.
    """
    refuse_nothing(loaded, plan)
    sources = sources_on(loaded)
    candidates, not_tried = _candidates(block, loaded, plan, variant, answers)
    points = points_of(loaded, variant, sources, candidates, budget=block.budget, alone=block.alone)
    answers.check(points.every)
    tables = Tables(answers, block)
    tables.ask(points.every)
    keys, not_told = figures_of(block, loaded, tables.keys(points.full))
    full = {key: tables.of(points.full, key) for key in keys}
    _refuse_holes(full.get(THROUGHPUT))
    return LabourFound(
        block.design,
        block.workforces,
        block.replications,
        {key: variance_parts(table, block.design) for key, table in full.items() if np.isfinite(table).all()},
        _day(day_asked(block.target, plan), tables, points.full, block.design),
        sources,
        tuple(_budget(key, points, tables, block.design) for key in keys) if block.budget else (),
        _bought(points, tables, block.design),
        (*not_tried, *not_told),
        too_few_days(block.design, block.replications),
    )


def _refuse_holes(table: np.ndarray | None) -> None:
    n = 0 if table is None else int(np.count_nonzero(~np.isfinite(table)))
    if table is None or n:
        of = "the" if table is None else f"{n} of {table.size}"
        raise ValueError(f"{of} runs have no throughput per hour: is the floor ever open within the run?")


def _candidates(
    block: Any, loaded: Loaded, plan: Plan, variant: str | None, answers: Answers
) -> tuple[list[Candidate], list[str]]:
    """What may buy the loss back, without what the scenario cannot take, and what that was in words."""
    if block.buy_back is None:
        return [], []
    people, words = more_workers(loaded, block.buy_back.most_workers, block.buy_back.like)
    found = []
    for one in [*people, *more_skills(loaded, plan, block.buy_back.most_skills)]:
        why = _why_not(one, variant, answers)
        if why and block.buy_back.like is not None and one in people:
            raise ValueError(f"studies.labour.buy_back.like: {one.name}: {why}")
        if why:
            words.append(f"Not tried: {one.name}: {why}.")
        else:
            found.append(one)
    return found, words


def _why_not(candidate: Candidate, variant: str | None, answers: Answers) -> str:
    try:
        answers.check(Point(candidate.name, changes, variant) for _, changes in candidate.steps)
    except ScenarioError as error:
        return error.problems[0].message
    return ""


def _budget(key: Key, points: Points, tables: Tables, design: str) -> FigureBudget:
    assert points.all_off is not None
    off = {name: tables.of(point, key) for name, point in points.off.items()}
    alone = {name: tables.of(point, key) for name, point in points.alone.items()}
    return figure_budget(key, tables.of(points.full, key), off, tables.of(points.all_off, key), alone, design)


def _bought(points: Points, tables: Tables, design: str) -> BoughtBack | None:
    if not points.more:
        return None
    full, equal = (tables.of(point, THROUGHPUT) for point in (points.full, points.equal))
    tried = sum(len(steps) for _, steps in points.more)
    curves = []
    for one, steps in points.more:
        made = [(count, tables.of(point, THROUGHPUT)) for (count, _), point in zip(one.steps, steps)]
        curves.append(curve_of(one.name, one.kind, made, full, equal, design, tried))
    return bought_back(full, equal, curves, design)


def _day(asked: DayAsked, tables: Tables, full: Point, design: str) -> DayFound:
    known = tables.keys(full)
    key = next((key for key in known if key[:3] == (asked.kpi, asked.subject, asked.part)), None)
    if key is None:
        there: Sequence[str] = sorted({"/".join(k[:3]).rstrip("/") for k in known if k[0] == asked.kpi})
        hint = f"there are {', '.join(there[:8])}" if there else "these runs have none of it"
        raise ValueError(f"target: no figure {asked.name!r}; {hint}")
    return day_found(asked, key, tables.of(full, key), design)


KEY = ("kpi", "subject", "part", "unit")


def labour_summary(found: LabourFound) -> dict[str, Any]:
    """The content of summary.json."""
    return {
        "design": found.design,
        "workforces": found.workforces,
        "replications": found.replications,
        "variance": [_parts(key, parts) for key, parts in found.parts.items()],
        "sources": [{"name": s.name, "off": s.off, "keeps_mean": s.keeps_mean} for s in found.sources],
        "budget": [_budget_as_json(one) for one in found.budget],
        "bought_back": None if found.bought is None else _bought_as_json(found.bought),
        "day": _day_as_json(found.day),
        "warning": found.warning or None,
        "notes": list(found.words),
    }


def _parts(key: Key, parts: VarianceParts) -> dict[str, Any]:
    every = parts.parts if parts.run in parts.parts else (*parts.parts, parts.run)
    return {**dict(zip(KEY, key)), "mean": parts.mean, "parts": {part.name: _part(part, parts) for part in every}}


def _part(part: VariancePart, parts: VarianceParts) -> dict[str, Any]:
    return {
        "sd": part.sd,
        "low_sd": part.low_sd,
        "high_sd": part.high_sd,
        "estimate_of_variance": part.estimate,
        "truncated": part.truncated,
        "share": parts.share(part.name),
    }


def _budget_as_json(one: FigureBudget) -> dict[str, Any]:
    return {
        **dict(zip(KEY, one.key)),
        "as_it_is": _interval(one.full),
        "all_off": _interval(one.all_off),
        "parts": {name: _interval(of) for name, of in one.parts.items()},
        "interaction": _interval(one.interaction),
        "whole": _interval(one.whole),
        "alone": {name: _interval(of) for name, of in one.alone.items()},
    }


def _bought_as_json(bought: BoughtBack) -> dict[str, Any]:
    return {
        "loss": _interval(bought.loss),
        "without_the_loss": _interval(bought.equal),
        "ways": [
            {
                "name": curve.name,
                "kind": curve.kind,
                "first_enough": None if curve.first is None else curve.first.count,
                "steps": [
                    {
                        "more": s.count,
                        "gained": _interval(s.gained),
                        "beyond": _interval(s.beyond),
                        "enough": s.enough,
                        "sure": s.surely,
                    }
                    for s in curve.steps
                ],
            }
            for curve in bought.curves
        ],
    }


def _day_as_json(day: DayFound) -> dict[str, Any]:
    met = day.chance
    return {
        "figure": "good units of a day" if day.asked.a_day else day.asked.name,
        "hours": day.asked.hours if day.asked.a_day else None,
        "quantiles": [{"q": q.q, "estimate": q.estimate, "low": q.low, "high": q.high} for q in day.quantiles],
        "target": None if day.asked.target is None else day.asked.target.words,
        "chance": None
        if met is None
        else {
            "estimate": met.estimate,
            "low": met.low,
            "high": met.high,
            "count": met.count,
            "n": met.n,
            "counts_as": met.counts_as,
        },
    }


def _interval(of: Interval) -> dict[str, float]:
    return {"mean": of.mean, "half_width": of.half_width, "low": of.low, "high": of.high}
