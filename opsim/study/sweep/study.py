"""``opsim sweep`` as a pure function of answers: points, what each figure is there, and how it is told."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from opsim.results import Key
from opsim.study.jobs import Job, Point
from opsim.study.sweep.factors import UNCHANGED
from opsim.study.sweep.figures import check_figures, chosen, kept_of
from opsim.study.sweep.found import found_of
from opsim.study.sweep.points import Points, points_of
from opsim.study.sweep.summary import summary_of

MOST_CHECKED = 200
"""Points that are checked whole before the first run, beside every value of every factor by itself."""


def kept(asked: Any) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication.

    It is asked for first of all, so that what is wrong with figures and points is said before there is a folder.
    Raises ValueError with everything that is wrong with them.
    """
    outputs, figures = asked.loaded.scenario.outputs, asked.block.figures
    check_figures(figures or (), asked.loaded.scenario)
    points_of(asked.block, _seed(asked))
    return kept_of(figures, outputs)


def study(asked: Any, answers: Any) -> tuple[dict[str, Any], Any]:
    """(content of summary.json, StudyPage). asked : what the command line and the file ask; answers : Answers

    Raises ScenarioError with everything that is wrong with points before the first run, ValueError where a part of a
    figure is in no replication.
    """
    from opsim.report.sweep_page import sweep_page

    scenario, figures, seed = asked.loaded.scenario, asked.block.figures, _seed(asked)
    points = with_bases(points_of(asked.block, seed), asked.loaded.resolved)
    runs = points.points(asked.variant)
    answers.check(to_be_checked(points, runs, asked.variant))
    jobs = [Job(point, replication) for point in dict.fromkeys(runs) for replication in range(asked.replications)]
    answers.ensure(jobs)
    keys = chosen(figures, scenario.outputs, answers.keys(jobs))
    values = values_of(answers, runs, [key for key, _ in keys], asked.replications)
    found = [found_of(key, better, points, values[:, :, place], seed) for place, (key, better) in enumerate(keys)]
    name = scenario.name or asked.loaded.file.stem
    return summary_of(points, found, asked.replications), sweep_page(name, points, found, asked.replications, seed)


def _seed(asked: Any) -> int:
    seed = asked.loaded.scenario.run.seed if asked.source.seed is None else asked.source.seed
    return int(seed)


def with_bases(points: Points, resolved: Mapping[str, Any]) -> Points:
    """The points, with what the scenario itself has of each factor. resolved : it as plain values"""
    bases: dict[str, str] = {}
    for factor in points.factors:
        value: Any = resolved
        for part in factor.path.split("."):
            value = value.get(part, UNCHANGED) if isinstance(value, Mapping) else UNCHANGED
        if value is not UNCHANGED:
            bases[factor.path] = factor.words(value)
    return replace(points, bases=bases)


def to_be_checked(points: Points, runs: Sequence[Point], variant: str | None) -> list[Point]:
    """Each value of each factor by itself, and the first points as they are."""
    alone = [
        Point(f"{factor.path} = {factor.words(value)}", {factor.path: value}, variant)
        for factor in points.factors
        for value in factor.ends
        if value is not UNCHANGED
    ]
    return list(dict.fromkeys([*alone, *runs[:MOST_CHECKED]]))


def values_of(answers: Any, runs: Sequence[Point], keys: Sequence[Key], replications: int) -> np.ndarray:
    """(P, n, K) figures of points that may be there more than once."""
    jobs = [Job(point, replication) for point in runs for replication in range(replications)]
    return np.asarray(answers.values(jobs, keys)).reshape(len(runs), replications, len(keys))
