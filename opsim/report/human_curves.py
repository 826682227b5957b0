"""How people tire and learn through the first replication: a curve each over the clock."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.log import EventLog
from opsim.plan import Plan
from opsim.report.clock_curves import Curve, curves_figure, curves_legend, thinned
from opsim.report.words import listing

MOST = 8
"""Curves of a figure: of those who tire or learn most."""
PAUSE_S, PAUSES, STEPS = 600.0, 40, 16
"""In pauses longer than this, the longest so many of them, recovery is drawn at so many steps, closer at first."""


def curves_section(loaded: Any, result: Any) -> list[dict[str, Any]]:
    """What to show, each with ``id``, ``title``, ``words``, ``said``, ``legend`` and ``figure``; none without effects.

    loaded : the variant that was read; result : its results, with the rows of its first replication
    Raises ValueError or OSError as reading does.
    """
    from opsim.log_store import read_events
    from opsim.plan import compile_plan

    if not result.events_files:
        return []
    plan = compile_plan(loaded, seed=result.summary["seed"])
    if plan.human.fatigue is None and plan.human.learning is None:
        return []
    return curves_of(read_events(result.events_files[0]), plan, loaded.scenario.run.start)


def curves_of(log: EventLog, plan: Plan, start: str) -> list[dict[str, Any]]:
    """Of a log: fatigue where people tire, times where they learn."""
    found = []
    if plan.human.fatigue is not None:
        found.append(_shown("fatigue", "Fatigue over the clock", _fatigue(log, plan), start, _tired_words))
    if plan.human.learning is not None:
        found.append(_shown("learning", "Learning over the clock", _learning(log, plan), start, _learned_words))
    return [one for one in found if one["legend"]]


def _shown(name: str, title: str, curves: Sequence[Curve], start: str, words: Any) -> dict[str, Any]:
    top = sorted(curves, key=lambda curve: -float(np.ptp(curve.value)))[:MOST]
    kept = [curve for curve in curves if curve in top]
    left = len(curves) - len(kept)
    more = f" {left} more {'is' if left == 1 else 'are'} not shown." if left else ""
    return {
        "id": f"curve_{name}",
        "title": title,
        "words": words(curves) + more,
        "said": "; ".join(f"{curve.name}: {curve.value[-1]:.0%} at the end" for curve in kept),
        "legend": curves_legend(kept),
        "figure": curves_figure(kept, start, "% of full fatigue" if name == "fatigue" else "% of the first time"),
    }


def _fatigue(log: EventLog, plan: Plan) -> list[Curve]:
    """A curve a worker: at the beginning and at the end of each piece of work, and through long pauses."""
    from opsim.tiredness import levels_at, tiredness

    found, curves = tiredness(log, plan), []
    worker = log["worker"][found.row]
    for rank, person in enumerate(plan.workers):
        own = worker == rank
        at_s = np.stack([log["start_s"][found.row[own]], log["end_s"][found.row[own]]], axis=1).ravel()
        if not at_s.size:
            continue
        value = np.stack([found.begin[own], found.end[own]], axis=1).ravel()
        pause_s = _pauses_s(at_s)
        paused = levels_at(log, plan, rank, pause_s) if pause_s.size else pause_s
        curves.append(_merged(person.name, thinned(at_s, value), (pause_s, paused)))
    return curves


def _pauses_s(at_s: np.ndarray) -> np.ndarray:
    """(P,) times within the long pauses between pieces of work, in their order. at_s : beginnings and ends in turn"""
    begin_s, end_s = at_s[1:-1:2], at_s[2::2]
    long = np.flatnonzero(end_s - begin_s > PAUSE_S)
    long = np.sort(long[np.argsort(begin_s[long] - end_s[long], kind="stable")[:PAUSES]])
    share = np.linspace(0, 1, STEPS + 1) ** 2
    return (begin_s[long, None] + (end_s - begin_s)[long, None] * share).ravel()


def _merged(name: str, *parts: tuple[np.ndarray, np.ndarray]) -> Curve:
    at_s, value = (np.concatenate([part[side] for part in parts]) for side in (0, 1))
    order = np.argsort(at_s, kind="stable")
    return Curve(name, at_s[order], value[order])


def _learning(log: EventLog, plan: Plan) -> list[Curve]:
    """A curve a worker and task: what share of the time of the first repetition each one takes."""
    from opsim.practice import practice

    found, curves = practice(log, plan), []
    worker, task = log["worker"][found.row], log["task"][found.row]
    share = found.multiplier / plan.human.learning.multiplier(1.0)
    for rank, person in enumerate(plan.workers):
        for at in np.unique(task[worker == rank]).tolist():
            own = np.flatnonzero((worker == rank) & (task == at))
            name = f"{person.name}, {plan.tasks[at].name}"
            curves.append(Curve(name, *thinned(log["start_s"][found.row[own]], share[own])))
    return curves


def _tired_words(curves: Sequence[Curve]) -> str:
    if not curves:
        return ""
    worst = max(curves, key=lambda curve: float(curve.value.max()))
    ends = listing([f"{curve.name} {curve.value[-1]:.0%}" for curve in curves[:MOST]])
    return (
        f"Most tired is {worst.name}: {worst.value.max():.0%} of full fatigue at the highest. As the last work ends it "
        f"is: {ends}. What the model says, for the first replication; nobody measured it."
    )


def _learned_words(curves: Sequence[Curve]) -> str:
    if not curves:
        return ""
    best = min(curves, key=lambda curve: float(curve.value[-1] - curve.value[0]))
    return (
        f"Furthest comes {best.name}: from {best.value[0]:.0%} of the time of a first repetition to "
        f"{best.value[-1]:.0%}. What the model says, for the first replication."
    )
