"""A labour study, as a function of answers: what is asked first, all at once, and what is made of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.plan import Plan
from opsim.problems import ScenarioError
from opsim.results import Key
from opsim.scenario.read import Loaded
from opsim.study.jobs import Answers, Point
from opsim.study.labour.budget import FigureBudget, figure_budget
from opsim.study.labour.buy_back import BoughtBack, bought_back, curve_of
from opsim.study.labour.candidates import Candidate, more_skills, more_workers
from opsim.study.labour.day_asked import DayAsked, DayFound, day_asked, day_found
from opsim.study.labour.parts import VarianceParts, variance_parts
from opsim.study.labour.points import Points, points_of
from opsim.study.labour.refused import refuse_nothing, too_few_days
from opsim.study.labour.sources import VariabilitySource, sources_on
from opsim.study.labour.tables import THROUGHPUT, Tables, figures_of


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
        from opsim.frames import frame_of_rows

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
