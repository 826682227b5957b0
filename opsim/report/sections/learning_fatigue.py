"""How tired people get, and how far they learn, over all replications: what the curves of one cannot say.

Curves over the clock of a run, told apart by colour and by dashes.

How people tire and learn through the first replication: a curve each over the clock.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np

from opsim.log import EventLog
from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import clock, digits, is_number, listing
from opsim.report.page import Block, Chart, Section, Words
from opsim.report.plot.plotly import FONT, label, layout_of

Row = Mapping[str, Any]
MOST_SAID = 3


def tired_over_all(rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``fatigue_most`` of the summary"""
    own = sorted(_known(rows, part=False), key=lambda row: -row["mean"])[:MOST_SAID]
    if own:
        said = "; ".join(f"{row['subject']} {_share(row)}" for row in own)
        yield f"The highest fatigue in the mean over {own[0]['n']} replications, with intervals: {said}."


def learned_over_all(rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``learned_share`` of the summary"""
    own = sorted(_known(rows, part=True), key=lambda row: -row["mean"])[:MOST_SAID]
    if own:
        said = "; ".join(f"{row['subject']}, {row['part']} {_share(row)}" for row in own)
        yield (
            "What the last repetition takes of the time of a first one, in the mean over "
            f"{own[0]['n']} replications, with intervals: {said}."
        )


def _known(rows: Sequence[Row], *, part: bool) -> list[Row]:
    """Of workers, by task or of all tasks, where there is an interval."""
    return [
        row
        for row in rows
        if row["subject"] and bool(row.get("part")) is part and is_number(row["mean"]) and is_number(row.get("low"))
    ]


def _share(row: Row) -> str:
    half = 50 * (row["high"] - row["low"])
    mean, low, high = (digits(100 * max(row[name], 0.0), half) for name in ("mean", "low", "high"))
    return f"{mean} % ({low} to {high})"


COLOURS = ("#0072B2", "#D55E00", "#009E73", "#B5578F", "#B07C00", "#2A9BD6", "#333333", "#7E6BA8")
"""Okabe and Ito's, darkened so that a thin line stands out."""
DASHES = ("solid", "dash", "dot", "dashdot")
MOST_POINTS = 700
STEPS_S = (600.0, 900.0, 1800.0, 3600.0, 7200.0, 14400.0, 21600.0, 43200.0, 86400.0, 172800.0, 604800.0)
MOST_TICKS = 6


@dataclass(frozen=True, eq=False)
class Curve:
    """``value`` (T,), a share, at ``at_s`` (T,) of the run."""

    name: str
    at_s: np.ndarray
    value: np.ndarray


def thinned(at_s: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """At most MOST_POINTS of some points in the order of time: the lowest and the highest of each stretch."""
    if at_s.size <= MOST_POINTS:
        return at_s, value
    edges = np.linspace(0, at_s.size, MOST_POINTS // 2 + 1).astype(int)
    stretches = [slice(first, last) for first, last in pairwise(edges.tolist())]
    ends = {0, at_s.size - 1}
    for stretch in stretches[1:-1]:
        ends |= {stretch.start + int(value[stretch].argmin()), stretch.start + int(value[stretch].argmax())}
    kept = sorted(ends)
    return at_s[kept], value[kept]


def curves_figure(curves: Sequence[Curve], start: str, unit: str) -> dict[str, Any]:
    """A line a curve, in per cent. start : when the run began; unit : what the axis says"""
    data = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": escape(curve.name, quote=False),
            "x": [round(float(at_s), 1) for at_s in curve.at_s],
            "y": [round(100 * float(value), 3) for value in curve.value],
            "line": {"color": colour, "width": 1.8, "dash": dash},
            "hovertemplate": f"{label(curve.name)}: %{{y:.1f}} %<extra></extra>",
        }
        for curve, (colour, dash) in zip(curves, _looks(len(curves)))
    ]
    layout = layout_of(300)
    ends_s = [end for curve in curves for end in (curve.at_s[0], curve.at_s[-1])]
    at_s = ticks_s(start, float(min(ends_s, default=0.0)), float(max(ends_s, default=1.0)))
    layout["xaxis"] |= {"tickvals": at_s, "ticktext": [_tick(start, one, at_s) for one in at_s]}
    layout["yaxis"] |= {"rangemode": "tozero", "title": {"text": unit, "standoff": 8, "font": {**FONT, "size": 12}}}
    return {"data": data, "layout": layout}


def curves_legend(curves: Sequence[Curve]) -> list[tuple[str, str, str]]:
    """(colour, CSS border style, name) of each."""
    css = {"solid": "solid", "dash": "dashed", "dot": "dotted", "dashdot": "dashed"}
    return [(colour, css[dash], curve.name) for curve, (colour, dash) in zip(curves, _looks(len(curves)))]


def _looks(n: int) -> list[tuple[str, str]]:
    """Neighbours differ in both, so that nobody has to tell colours apart."""
    return [(COLOURS[i % len(COLOURS)], DASHES[i % len(DASHES)]) for i in range(n)]


def ticks_s(start: str, low_s: float, high_s: float) -> list[float]:
    """Round times of the clock within some seconds of the run; few enough to be read."""
    step_s = next((step for step in STEPS_S if (high_s - low_s) / step <= MOST_TICKS), STEPS_S[-1])
    words = clock(start, 0).split()
    hours, _, minutes = words[-1].partition(":")
    begin_s = int(hours) * 3600 + int(minutes) * 60 if hours.isdigit() and minutes.isdigit() else 0
    first = int(np.ceil((begin_s + low_s) / step_s - 1e-9))
    last = int(np.floor((begin_s + high_s) / step_s + 1e-9))
    return [step_s * n - begin_s for n in range(first, last + 1)]


def _tick(start: str, at_s: float, all_s: Sequence[float]) -> str:
    """``07:30``; with the day where they are a day apart, and at the first."""
    day, _, time = clock(start, at_s).partition(" ")
    if len(time) != 5:
        return f"{at_s / 3600:g} h"
    apart_s = all_s[1] - all_s[0] if len(all_s) > 1 else 0.0
    return (
        day
        if apart_s >= 86400 and time == "00:00"
        else f"{day} {time}"
        if at_s == all_s[0] or time == "00:00"
        else time
    )


MOST = 8
"""Curves of a figure: of those who tire or learn most."""
PAUSE_S, PAUSES, STEPS = 600.0, 40, 16
"""In pauses longer than this, the longest so many of them, recovery is drawn at so many steps, closer at first."""


def learning_and_fatigue_section(material: Material) -> Section | None:
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
    from opsim.history import levels_at, tiredness

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
    from opsim.history import practice

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
