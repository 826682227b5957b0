"""What a sweep found of one figure: means at the points, what each factor does, a fitted response, the best point.

Which figures a sweep tells: those that are asked for, or what the scenario puts in front.

A sweep as plain values, for summary.json.

``opsim sweep`` as a pure function of answers: points, what each figure is there, and how it is told.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.kpi.catalogue import KPIS, AskedFigure, better_of, read_asked, subject_of
from opsim.problems import did_you_mean
from opsim.results import Key
from opsim.scenario.schema.sweep import SENSITIVITY
from opsim.scenario.variants import flow_text
from opsim.study.compare import remedy
from opsim.study.intervals import Interval, t_interval
from opsim.study.jobs import Job, Point
from opsim.study.sweep.designs import MORRIS_STEP, Sensitivity, morris_effects, sobol_indices
from opsim.study.sweep.effects import Found, Swing, best_of, effects_by_fit, main_effects, tornado
from opsim.study.sweep.factors import AS_IT_IS, UNCHANGED, Factor, Points, points_of
from opsim.study.sweep.response_surface import Response, block_error, fit_response

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

AGAINST_BASE, OVER_OTHERS, BY_FIT = "base", "mean", "fit"


def found_of(key: Key, better: str, points: Points, values: np.ndarray, seed: int) -> Found:
    """values : (P, n) of the figure, replications with common random numbers; seed : of the bootstrap's intervals."""
    means = tuple(t_interval(row) for row in values)
    known = [one for one in means if one.n]
    best = best_of(values, means, better) if better and len(known) > 1 else None
    found = Found(
        key, means, best=best, replications=values.shape[1], factors=points.factors, better=better, values=values
    )
    if points.design in SENSITIVITY:
        return replace(found, sensitivity=_sensitivity(points, means, seed), noise_share=_noise_share(values))
    if points.design == "one_at_a_time":
        return replace(found, how=AGAINST_BASE, swings=tuple(_against_base(points, values)))
    response, why = _response(points, values)
    complete = values[:, ~np.isnan(values).any(axis=0)]
    if points.design == "grid" and complete.size:
        how, swings = OVER_OTHERS, main_effects(points.array, complete, *_names(points.factors))
    else:
        how, swings = BY_FIT, [] if response is None else effects_by_fit(points.factors, response)
    return replace(found, how=how, swings=tuple(swings), response=response, no_response=why)


def _against_base(points: Points, values: np.ndarray) -> list[Swing]:
    ends = {}
    for column, factor in enumerate(points.factors):
        rows = [row for row in range(1, len(values)) if points.values[row][column] is not UNCHANGED]
        ends[factor.path] = {factor.words(points.values[row][column]): values[row] for row in rows}
    bases = {path: _base_name(points.bases.get(path), of) for path, of in ends.items()}
    return tornado(values[0], ends, bases)


def _base_name(said: str | None, ends: Mapping[str, object]) -> str:
    """What the scenario has, in words: an end where it is one of them."""
    if said is None or said in ends:
        return AS_IT_IS if said is None else said
    return f"{said} ({AS_IT_IS})"


def _names(factors: Sequence[Factor]) -> tuple[list[str], list[list[str]]]:
    return [f.path for f in factors], [[f.words(value) for value in f.grid_values()] for f in factors]


def _response(points: Points, values: np.ndarray) -> tuple[Response | None, str]:
    """The fit, or why there is none."""
    spans = [factor.span if not factor.categories else (0.0, 1.0) for factor in points.factors]
    low, high = zip(*spans)
    categories = [factor.categories for factor in points.factors]
    try:
        return fit_response(points.numbers(), values, low=low, high=high, categories=categories), ""
    except ValueError as error:
        return None, str(error)


def _sensitivity(points: Points, means: Sequence[Interval], seed: int) -> tuple[Sensitivity, ...]:
    """Nothing where a point has no value: the designs need all of theirs."""
    y = np.array([one.mean for one in means])
    if np.isnan(y).any():
        return ()
    n = len(points.factors)
    if points.design == "morris":
        return tuple(morris_effects(points.array, y, n, seed, [_moved(factor) for factor in points.factors]))
    return tuple(sobol_indices(y, n, seed))


def _moved(factor: Factor) -> float:
    """By which share of its range a factor moves at a step of Morris' paths; values without order change as a whole."""
    if factor.categories > 1:
        return 1.0
    return round(MORRIS_STEP * factor.steps) / factor.steps if factor.steps else MORRIS_STEP


def _noise_share(values: np.ndarray) -> float:
    known = values[~np.isnan(values).any(axis=1)]
    if len(known) < 2 or known.shape[1] < 2 or np.ptp(known.mean(axis=1)) == 0:
        return float("nan")
    return min(1.0, block_error(known) / known.shape[1] / float(known.mean(axis=1).var(ddof=1)))


SECTIONS = {"worker": "workers", "station": "stations", "task": "tasks", "product": "products"}
MOST_BY_ITSELF = 6
"""Figures that a sweep chooses, where nobody does."""


def kept_of(figures: Sequence[str] | None, outputs: Sequence[str]) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    return tuple(dict.fromkeys(read_asked(text).kpi for text in figures)) if figures else tuple(dict.fromkeys(outputs))


def check_figures(figures: Sequence[str], scenario: Scenario) -> None:
    """Raises ValueError with everything that is wrong with the figures, before anything is run."""
    wrong = [words for text in figures if (words := _wrong(read_asked(text), scenario))]
    if wrong:
        raise ValueError("\n".join(wrong))


def chosen(figures: Sequence[str] | None, outputs: Sequence[str], keys: Sequence[Key]) -> list[tuple[Key, str]]:
    """The figures and which way of each is better. keys : of all that the replications have

    Raises ValueError where one that was asked for is in no replication.
    """
    if figures:
        return [_found(read_asked(text), keys) for text in figures]
    whole = [key for kpi in outputs for key in keys if key[0] == kpi and not key[1] and not key[2]]
    if not whole:
        raise ValueError("the scenario's outputs are of single things: name figures, such as --figure throughput_per_h")
    return [(key, better_of(key[0], key[2])) for key in whole[:MOST_BY_ITSELF]]


def _found(asked: AskedFigure, keys: Sequence[Key]) -> tuple[Key, str]:
    for key in keys:
        if key[:3] == (asked.kpi, asked.subject, asked.part):
            return key, asked.better
    of = [AskedFigure(*key[:3]).name for key in keys if key[0] == asked.kpi]
    if of:
        raise ValueError(f"no figure {asked.name!r}; {did_you_mean(asked.name, of, otherwise='there are')}")
    raise ValueError(f"no figure {asked.name!r}; {remedy(asked.kpi, {key[0] for key in keys})}")


def _wrong(asked: AskedFigure, scenario: Scenario) -> str:
    """What is wrong with one figure; nothing where all is well."""
    if asked.kpi not in KPIS:
        return f"no figure {asked.kpi!r}; {did_you_mean(asked.kpi, KPIS)}"
    kind = subject_of(asked.kpi)
    names = list(getattr(scenario, SECTIONS.get(kind, ""), None) or ())
    if kind and not asked.subject:
        such = f", such as {asked.kpi}/{names[0]}" if names else f": {asked.kpi}/NAME"
        return "" if asked.part else f"{asked.kpi}: it is of each {kind}: say which{such}"
    if kind in SECTIONS and asked.subject and asked.subject not in (*names, "none"):
        return f"{asked.name}: no {kind} {asked.subject!r}; {did_you_mean(asked.subject, names)}"
    return ""


def summary_of(points: Points, found: Sequence[Found], replications: int) -> dict[str, Any]:
    """For machines: the points, and of every figure what ``Found`` says."""
    return {
        "design": points.design,
        "replications": replications,
        "factors": [_factor(factor) for factor in points.factors],
        "points": [
            {f.path: value for f, value in zip(points.factors, values) if value is not UNCHANGED}
            for values in points.values
        ],
        "figures": [_figure(one) for one in found],
        "words": [*points.words, *points.warned],
    }


def _factor(factor: Factor) -> dict[str, Any]:
    values = [value for value in factor.values if value is not UNCHANGED]
    return {"path": factor.path, **({"from": values[0], "to": values[1]} if factor.is_range else {"values": values})}


def _figure(found: Found) -> dict[str, Any]:
    said: dict[str, Any] = dict(zip(("kpi", "subject", "part", "unit"), found.key))
    said["points"] = [_interval(one) for one in found.means]
    if found.swings:
        said["against"] = found.how
        said["factors"] = [
            {
                "path": one.name,
                "lowest_at": one.levels[one.least].name,
                "highest_at": one.levels[one.most].name,
                "difference": _interval(one.rise),
                "clear": one.clear,
                "levels": [
                    {"value": level.name, "mean": _interval(level.mean), "change": _interval(level.change)}
                    for level in one.levels
                ],
            }
            for one in found.swings
        ]
    if found.sensitivity:
        said["sensitivity"] = [
            {"path": f.path, **{k: getattr(one, k) for k in ("alone", "alone_half", "total", "total_half", "spread")}}
            for f, one in zip(found.factors, found.sensitivity)
        ]
        said["noise_share"] = found.noise_share
    if found.response is not None:
        said["response"] = _response_as_json(found)
    if found.best is not None:
        said["best"] = {
            "point": found.best.row + 1,
            "better": found.best.better,
            "not_told_from_it": found.best.like_it,
        }
    return said


def _response_as_json(found: Found) -> dict[str, Any]:
    response = found.response
    assert response is not None
    return {
        "kind": response.kind,
        "centre": response.room.centre.tolist(),
        "half_range": response.room.half.tolist(),
        "terms": [
            {
                "of": [_part(found.factors, part) for part in term],
                "coefficient": float(value),
                "half_width": float(half),
            }
            for term, value, half in zip(response.terms, response.coefficients, response.half_widths)
        ],
        **{k: getattr(response, k) for k in ("loo_rmse", "noise", "r2", "r2_predicted", "lack_of_fit_p", "trusted")},
    }


def _part(factors: Sequence[Factor], part: tuple[int, int]) -> dict[str, Any]:
    factor, what = factors[part[0]], part[1]
    return {"path": factor.path, **({"power": what} if what > 0 else {"is": flow_text(factor.values[-what])})}


def _interval(one: Interval) -> dict[str, Any]:
    return {"mean": one.mean, "low": one.low, "high": one.high, "sd": one.sd, "n": one.n}


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
    from opsim.report.studies.sweep import sweep_page

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
