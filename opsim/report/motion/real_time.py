"""The page of ``opsim motion judge --page``: drawn movements beside recorded ones in real time, offline in one file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import write_text
from opsim.report.page import asset, template
from opsim.report.plot.body import Strip
from opsim.report.plot.svg_chart import SmallChart, around, panels
from opsim.report.sections.motions import draw_strips

RECORDED, DRAWN = "#5b6570", "#B85000"
N_STRIPS, N_PATHS = 3, 12
BAND = (0.1, 0.5, 0.9)
RATES = {1: ("Speed of the fastest joint, m/s", "speed"), 3: ("Jerk of the jerkiest joint, m/s³", "jerk")}
NO_MARKS = np.empty(0)


@dataclass(frozen=True, eq=False)
class Movements:
    """positions_m : n arrays (T, J, 3) at even times of duration_s (n,); rates : order -> (n, 101) over own time;
    foot_paths_m : for each movement, for each foot (T, 2) over the floor
    """

    positions_m: Sequence[np.ndarray]
    duration_s: np.ndarray
    rates: Mapping[int, np.ndarray]
    foot_paths_m: Sequence[Sequence[np.ndarray]]


@dataclass(frozen=True, eq=False)
class Task:
    """One task by one emulator: words and a table (headings, rows), and movements recorded (unseen) and drawn."""

    name: str
    scheme: str
    words: Sequence[str]
    table: tuple[Sequence[str], Sequence[Sequence[str]]]
    skeleton: Any
    recorded: Movements
    drawn: Movements


def write_real_time(path: Path, tasks: Sequence[Task], meaning: Mapping[str, str], seed: int) -> None:
    """Write the page of these tasks."""
    page = template("real_time.html.jinja").render(
        style=asset("report.css"),
        sections=[_section(task) for task in tasks],
        meaning=meaning,
        n_paths=N_PATHS,
        seed=seed,
        recorded=RECORDED,
        drawn=DRAWN,
    )
    write_text(path, page)


def _section(task: Task) -> dict[str, Any]:
    return {
        "title": f"{task.name}, {task.scheme}",
        "words": task.words,
        "table": task.table,
        "strips": _strips(task),
        "charts": panels(charts_of(task)),
    }


def _strips(task: Task) -> str:
    """Recorded and drawn movements in turn, in real time; empty for a skeleton that is not drawn as a person."""
    if not {"left_hip", "right_hip"} <= set(task.skeleton.names):
        return ""
    rows = []
    for number in range(N_STRIPS):
        for word, side in (("recorded", task.recorded), ("drawn", task.drawn)):
            at = _spread(len(side.duration_s), N_STRIPS)
            if number < len(at):
                i = at[number]
                rows.append(Strip(f"{word} {number + 1}", side.positions_m[i], float(side.duration_s[i]), NO_MARKS))
    return draw_strips(rows, skeleton=task.skeleton).decode()


def charts_of(task: Task) -> list[SmallChart]:
    """Bands of speed and jerk over a movement's own time, and the ways of the feet seen from above."""
    charts = []
    for order, (title, word) in RATES.items():
        bands = {
            colour: np.quantile(side.rates[order], BAND, axis=0)
            for colour, side in ((RECORDED, task.recorded), (DRAWN, task.drawn))
        }
        top = max(float(band.max()) for band in bands.values())
        tops = " and ".join(f"{band[1].max():.3g}" for band in bands.values())
        chart = SmallChart(title, (0, 100), around([0.0, top], True), "% of its time", f"{word}: at most {tops}")
        for colour, (low, middle, high) in bands.items():
            across = np.linspace(0, 100, len(middle))
            chart.band(across.tolist(), low.tolist(), high.tolist(), colour, 0.22)
            chart.line(across, middle, colour, 2.0)
        charts.append(chart)
    return charts + _feet(task)


def _feet(task: Task) -> list[SmallChart]:
    """Recorded and drawn feet on one scale; none for a body without feet."""
    sides = (("recorded", RECORDED, task.recorded), ("drawn", DRAWN, task.drawn))
    every = [way for *_, side in sides for ways in side.foot_paths_m for way in ways]
    if not every:
        return []
    low, high = (getattr(np.concatenate(every), which)(axis=0) for which in ("min", "max"))
    span_x, span_y = around([low[0], high[0]]), around([low[1], high[1]])
    charts = []
    for word, colour, side in sides:
        chart = SmallChart(f"Feet seen from above, {word}, m", span_x, span_y, "ahead, m", f"ways of {word} feet")
        for i in _spread(len(side.foot_paths_m), N_PATHS):
            for way in side.foot_paths_m[i]:
                chart.line(way[:, 0], way[:, 1], colour, 0.9)
        charts.append(chart)
    return charts


def _spread(n: int, most: int) -> list[int]:
    """At most so many of n, evenly from the first to the last."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(int)).tolist()
