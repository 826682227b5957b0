"""How people tire and learn through the first replication: a curve each over the clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from opsim.log import EventLog
from opsim.plan import Plan
from opsim.report.clock_curves import Curve, curves_figure, curves_legend, thinned
from opsim.report.human_words import learned_over_all, tired_over_all
from opsim.report.material import Material
from opsim.report.section import Block, Chart, Section, Words
from opsim.report.words import listing

MOST = 8
"""Curves of a figure: of those who tire or learn most."""
PAUSE_S, PAUSES, STEPS = 600.0, 40, 16
"""In pauses longer than this, the longest so many of them, recovery is drawn at so many steps, closer at first."""


def section(material: Material) -> Section | None:
    """What becomes of people as they work; None where nobody tires or learns."""
    if material.log is None or (material.plan.human.fatigue is None and material.plan.human.learning is None):
        return None
    curves = curves_of(material.log, material.plan, material.summary["start"])
    more = {
        "curve_fatigue": tired_over_all(material.rows("fatigue_most")),
        "curve_learning": learned_over_all(material.rows("learned_share")),
    }
    blocks: list[Block] = []
    for one in curves:
        blocks += [Words(one.note), *map(Words, more[one.id]), replace(one, note="")]
    return Section("effects", "What becomes of people as they work", blocks, "Effects") if blocks else None


def curves_of(log: EventLog, plan: Plan, start: str) -> list[Chart]:
    """Of a log: fatigue where people tire, times where they learn; what it says in words is the chart's note."""
    found = []
    if plan.human.fatigue is not None:
        found.append(_shown("fatigue", "Fatigue over the clock", _fatigue(log, plan), start, _tired_words))
    if plan.human.learning is not None:
        found.append(_shown("learning", "Learning over the clock", _learning(log, plan), start, _learned_words))
    return [one for one in found if one.legend]


def _shown(name: str, title: str, curves: Sequence[Curve], start: str, words: Any) -> Chart:
    top = sorted(curves, key=lambda curve: -float(np.ptp(curve.value)))[:MOST]
    kept = [curve for curve in curves if curve in top]
    left = len(curves) - len(kept)
    more = f" {left} more {'is' if left == 1 else 'are'} not shown." if left else ""
    unit = "% of full fatigue" if name == "fatigue" else "% of the first time"
    said = "; ".join(f"{curve.name}: {100 * curve.value[-1]:.0f} % at the end" for curve in kept)
    figure = curves_figure(kept, start, unit)
    return Chart(f"curve_{name}", figure, said, title, curves_legend(kept), words(curves) + more)


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
    ends = listing([f"{curve.name} {100 * curve.value[-1]:.0f} %" for curve in curves[:MOST]])
    return (
        f"Most tired is {worst.name}: {100 * worst.value.max():.0f} % of full fatigue at the highest. As the last work "
        f"ends it is: {ends}. What the model says, for the first replication; nobody measured it."
    )


def _learned_words(curves: Sequence[Curve]) -> str:
    if not curves:
        return ""
    best = min(curves, key=lambda curve: float(curve.value[-1] - curve.value[0]))
    return (
        f"Furthest comes {best.name}: from {100 * best.value[0]:.0f} % of the time of a first repetition to "
        f"{100 * best.value[-1]:.0f} %. What the model says, for the first replication."
    )
