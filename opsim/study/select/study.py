"""``studies: select:`` from what is asked to what was found: a pure function of the answers.

What was found, as summary.json has it: numbers as they are, nothing that lives in memory only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from opsim.kpi.catalogue import read_asked
from opsim.kpi.targets import amount, percent, read_limit
from opsim.problems import ScenarioError
from opsim.results import Key
from opsim.study.compare import paired
from opsim.study.intervals import t_interval
from opsim.study.jobs import Answers, Job, Point
from opsim.study.jobs.evaluate import loaded_of
from opsim.study.select.kn import kn
from opsim.study.select.ocba import ocba
from opsim.study.select.search import (
    Candidates,
    Changes,
    Found,
    Fresh,
    Search,
    Searched,
    Trial,
    best_trials,
    called,
    named,
    searched,
    short_names,
)
from opsim.study.select.selection import (
    Ask,
    Limit,
    Replications,
    Selection,
    key_of,
    limit_of,
    name_of,
    nothing_seen,
    sign_of,
)
from opsim.study.select.two_stage import dudewicz_dalal, rinott

MOST, MOST_OF_EACH = 1000, 100
"""Replications of each variant, and of each on average where a budget is shared."""
TRIALS_AT_ONCE = 4


def kept_of(block: Any) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    texts = [read_asked(block.figure).kpi, *(read_limit(text).asked.kpi for text in block.subject_to)]
    return tuple(dict.fromkeys(texts))


def choose(block: Any, candidates: Candidates, answers: Answers, search: Search | None = None) -> Found:
    """Who is best. search : where the candidates are still to be found.

    Raises ScenarioError with everything that is wrong with a point, ValueError: no such figure, a wrong unit.
    """
    answers.check([*candidates.points, candidates.base, *_ends(candidates)])
    asked, texts = read_asked(block.figure), [read_limit(text) for text in block.subject_to]
    known = answers.keys([Job(candidates.base, 0)])
    key, keys = key_of(asked, known), tuple(key_of(text.asked, known) for text in texts)
    limits = tuple(limit_of(text, of) for text, of in zip(texts, keys))
    looking = Replications(answers, (candidates.base,), (key, *keys), 0)
    indifference, first = _indifference(block, key, looking)
    tried, points = None, candidates.points
    if search is not None:
        tried, points = _search(block, candidates, replace(looking, first=first), limits, asked.better, search)
        first += block.trial_replications
    apart = block.procedure != "kn"
    chosen = replace(looking, points=points, first=first, apart=apart)
    most = block.most_replications or (MOST if block.procedure != "ocba" else MOST_OF_EACH * len(points))
    selection = _selected(block, chosen, indifference, asked.better, limits, most) if len(points) > 1 else None
    winner = points[0].name if selection is None else selection.winner
    fresh = None
    if winner:
        point = next(one for one in points if one.name == winner)
        after = first if selection is None else chosen.after(selection.asked)
        fresh = _fresh(replace(chosen, points=(point, candidates.base), first=after, apart=False), block.replications)
    paths = [factor.path for factor in candidates.factors]
    return Found(
        key=key,
        better=asked.better,
        keys=keys,
        limits=limits,
        indifference=indifference,
        indifference_said=str(block.indifference),
        confidence=block.confidence,
        procedure=block.procedure,
        base=candidates.base.name,
        changes={point.name: dict(point.changes) for point in points},
        first=first,
        apart=apart,
        selection=selection,
        winner=winner,
        most=most,
        fresh=fresh,
        searched=tried,
        factors=dict(zip(short_names(paths), paths)),
        called={} if tried is None else {point.name: _called(candidates, point) for point in points},
    )


def _called(candidates: Candidates, point: Point) -> str:
    return called(candidates.factors, [point.changes[factor.path] for factor in candidates.factors])


def _ends(candidates: Candidates) -> list[Point]:
    """Each value of a search's factors by itself: what is wrong with one is found before the first run."""
    base = candidates.base
    if candidates.points:
        return []
    return [Point(base.name, {of.path: value}, base.variant) for of in candidates.factors for value in of.ends]


def _indifference(block: Any, key: Key, looking: Replications) -> tuple[float, int]:
    """(value, the first replication number for the choice): ``1 %`` is of the base, looked at on numbers of its own."""
    share = percent(block.indifference, key[3])
    if share is None:
        return amount(block.indifference, key[3], name_of(key)), 0
    [values] = looking.observe([Ask(0, 0, block.first)])
    mean = abs(float(values[:, 0].mean()))
    if mean == 0:
        base = looking.points[0].name
        raise ValueError(f"indifference: {block.indifference} of nothing: {name_of(key)} is 0 in {base}; give a number")
    return share * mean, block.first


def _selected(
    block: Any, chosen: Replications, indifference: float, better: str, limits: tuple[Limit, ...], most: int
) -> Selection:
    names = [point.name for point in chosen.points]
    how: dict[str, Any] = {"indifference": indifference, "confidence": block.confidence, "better": better}
    how["first_stage"] = min(block.first, most)
    if block.procedure == "kn":
        return kn(chosen.observe, names, limits=limits, batch=block.batch, most=most, **how)
    if block.procedure == "ocba":
        return ocba(chosen.observe, names, batch=block.batch * 2, budget=most, **how)
    procedure = rinott if block.procedure == "rinott" else dudewicz_dalal
    return procedure(chosen.observe, names, most=most, **how)


def _fresh(looking: Replications, n: int) -> Fresh:
    """looking : the chosen one, then the base"""
    same = looking.points[0] == looking.points[1]
    both = looking.observe([Ask(system, 0, n) for system in range(1 if same else 2)])
    chosen, base = both[0], both[-1]
    difference, p, _ = paired(chosen[:, 0].tolist(), base[:, 0].tolist())
    intervals = [tuple(t_interval(column) for column in of.T) for of in (chosen, base)]
    if same:
        return Fresh(looking.first, n, intervals[0], intervals[1], None)
    return Fresh(looking.first, n, intervals[0], intervals[1], difference, float(p))


def _search(
    block: Any, candidates: Candidates, looking: Replications, limits: Sequence[Limit], better: str, search: Search
) -> tuple[Searched, tuple[Point, ...]]:
    """What was tried, and the points that go on. Raises ValueError where not one could be run."""
    sign, n, variant = sign_of(better), block.trial_replications, candidates.base.variant or ""

    def point_of(changes: Changes) -> Point:
        return named(candidates.factors, [changes[factor.path] for factor in candidates.factors], variant)

    def look(asked: Sequence[Changes]) -> list[Trial]:
        points = [point_of(changes) for changes in asked]
        refused = [_refused(looking.answers, point) for point in points]
        jobs = [Job(p, looking.first + r) for p, no in zip(points, refused) if not no for r in range(n)]
        values = iter(looking.answers.values(jobs, looking.keys).reshape(-1, n, len(looking.keys)))
        return [
            Trial(changes, np.nan, (), no) if no else _trial(point, next(values), looking, limits)
            for changes, point, no in zip(asked, points, refused)
        ]

    trials = searched(search, look, candidates.trials, TRIALS_AT_ONCE, sign)
    best = best_trials(trials, block.finalists, sign)
    if not best:
        raise ValueError(f"not one of {len(trials)} trials could be run; the first: {trials[0].refused}")
    places = [trials.index(trial) for trial in best]
    points = tuple(replace(point_of(trials[place].changes), name=f"trial {place + 1}") for place in places)
    finalists = {point.name: place for point, place in zip(points, places)}
    return Searched(tuple(trials), n, finalists), points


def _trial(point: Point, values: np.ndarray, looking: Replications, limits: Sequence[Limit]) -> Trial:
    """values : (n, 1 + limits)"""
    for row, column in np.argwhere(np.isnan(values))[:1]:
        return Trial(
            point.changes, np.nan, (), nothing_seen(Job(point, looking.first + int(row)), looking.keys[column])
        )
    means = values.mean(axis=0)
    over = tuple(float(limit.over(means[place])) / limit.tolerance for place, limit in enumerate(limits, 1))
    return Trial(point.changes, float(means[0]), over, half_width=t_interval(values[:, 0]).half_width)


def _refused(answers: Answers, point: Point) -> str:
    """Why a combination cannot be run; "" where it can."""
    try:
        loaded_of(answers.source, point)
    except ScenarioError as error:
        return str(error.problems[0].message)
    return ""


def summary_of(found: Any) -> dict[str, Any]:
    """What stands in summary.json, numbers as they are."""
    selection, fresh = found.selection, found.fresh
    return {
        "figure": dict(zip(("kpi", "subject", "part", "unit"), found.key)),
        "better": found.better,
        "procedure": found.procedure,
        "confidence": found.confidence,
        "indifference": found.indifference,
        "limits": [
            {"figure": one.name, "sense": one.sense, "bound": one.bound, "tolerance": one.tolerance, "unit": key[3]}
            for one, key in zip(found.limits, found.keys)
        ],
        "winner": found.winner or None,
        "ended": None if selection is None else selection.ended,
        "promise": "" if selection is None else selection.promise,
        "assumes": [] if selection is None else list(selection.assumes),
        "tied": [] if selection is None else list(selection.tied),
        "open_pairs": [] if selection is None else [list(pair) for pair in selection.open_pairs],
        "open_limits": [] if selection is None else [list(pair) for pair in selection.open_limits],
        "posterior": None if selection is None or selection.posterior is None else list(selection.posterior),
        "first_replication": found.first,
        "numbers_of_their_own": found.apart,
        "candidates": [] if selection is None else [_candidate(found, i) for i in range(len(selection.systems))],
        "stages": [] if selection is None else [{"n": one.n, "left": list(one.left)} for one in selection.stages],
        "fresh": None if fresh is None else _fresh_summary(found),
        "search": None if found.searched is None else _search_summary(found),
    }


def _candidate(found: Any, i: int) -> dict[str, Any]:
    selection, name = found.selection, found.selection.systems[i]
    out = next((one for one in selection.out if one.system == name), None)
    return {
        "name": name,
        "changes": dict(found.changes[name]),
        "mean": selection.means[i],
        "limits": list(selection.limited[i]),
        "n": selection.n[i],
        "asked": selection.asked[i],
        "needed": selection.needed[i] if selection.needed else None,
        "out_after": None if out is None else out.n,
        "out_by": None if out is None else out.by or None,
        "out_limit": None if out is None else out.limit or None,
    }


def _fresh_summary(found: Any) -> dict[str, Any]:
    fresh = found.fresh
    by = fresh.difference
    return {
        "first": fresh.first,
        "replications": fresh.n,
        "chosen": [_interval(one) for one in fresh.chosen],
        "base": None if by is None else {"name": found.base, "figures": [_interval(one) for one in fresh.base]},
        "difference": None if by is None else {**_interval(by), "p": fresh.p},
    }


def _interval(one: Any) -> dict[str, float]:
    return {"mean": one.mean, "half_width": one.half_width, "sd": one.sd, "n": one.n}


def _search_summary(found: Any) -> dict[str, Any]:
    tried = found.searched
    return {
        "replications": tried.replications,
        "finalists": dict(tried.finalists),
        "trials": [
            {
                "changes": dict(one.changes),
                "mean": one.mean,
                "over_in_tolerances": list(one.over),
                "refused": one.refused or None,
            }
            for one in tried.trials
        ],
    }
