"""What the spread of times says: which varies most, and how long the slow ones take.

How long it takes, as violins: how the times are spread, with their median and the tenth and ninetieth per cent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from opsim.kpi.window import in_window
from opsim.log import LEAVING_KINDS
from opsim.report.material import Material
from opsim.report.numbers import digits, quantity, rough, scale_of
from opsim.report.page import Block, Bullets, Chart, Folded, Grid, LegendEntry, Section, Words
from opsim.report.plot.plotly import ACCENT, FONT, INK, label, layout_of
from opsim.report.sections.common import worked_on
from opsim.report.sections.wip import jobs_inside
from opsim.subjects.stations.plan import STORE

Row = Mapping[str, Any]
TELLING = 20
"""Times below which a tenth of them is too few to speak of."""
MANY = 0.1
"""Jobs still inside at the end, to each that left: from here times of those that left alone mislead."""


def violin_sentences(rows: Sequence[Row], inside: int = 0, left: int = 0) -> list[str]:
    """Of the time in system, and of the work at stations.

    inside, left : jobs still inside at the end of the first replication, and those that left while it was counted
    """
    return [*_stay(rows), *_not_through(rows, inside, left), *_most_varied(rows)]


def _stay(rows: Sequence[Row]) -> Iterator[str]:
    stays = [row for row in rows if row["kpi"] == "time_in_system_s" and row["n"] >= TELLING]
    if not stays:
        return
    slow = max(stays, key=lambda row: row["quantiles"]["0.9"])
    middle, late = slow["quantiles"]["0.5"], slow["quantiles"]["0.9"]
    who = f"of {slow['subject']} " if slow["subject"] and len(stays) > 1 else ""
    often = f", {late / middle:.1f} times as long" if middle > 0 and late > 1.05 * middle else ""
    text = f"Of the jobs {who}that left, half were through within {rough(middle)}"
    yield f"{text}; one in ten took more than {rough(late)}{often}."


def _not_through(rows: Sequence[Row], inside: int, left: int) -> Iterator[str]:
    """What those that never left make of it: where they are many, times look shorter than they are."""
    if inside > MANY * left and any(row["kpi"] == "time_in_system_s" for row in rows):
        yield (
            f"At the end of the first replication {inside:,} jobs were still inside, against {left:,} that left while "
            "it was counted: with them the times in system would be longer than these."
        )


def _most_varied(rows: Sequence[Row]) -> Iterator[str]:
    works = [
        row for row in rows if row["kpi"] == "cycle_time_s" and row["n"] >= TELLING and row["quantiles"]["0.5"] > 0
    ]
    if len(works) < 2:
        return
    most = max(works, key=_spread)
    if _spread(most) > 0.02:
        low, high = (rough(most["quantiles"][q], of=most["quantiles"]["0.9"]) for q in ("0.1", "0.9"))
        yield (
            f"Of all stations the work at {most['subject']} is the least even: from {low} to {high} for eight in ten "
            "visits."
        )


def _spread(row: Row) -> float:
    """P90 less P10, as a share of the median."""
    return (row["quantiles"]["0.9"] - row["quantiles"]["0.1"]) / row["quantiles"]["0.5"]


TITLES = {
    "time_in_system_s": "Time in system, by product",
    "cycle_time_s": "Work a job gets, by station",
    "duration_s": "One performance, by task",
}
QUANTILES = ("0.05", "0.1", "0.25", "0.5", "0.75", "0.9", "0.95")
MOST_SAMPLES, MOST_ROWS = 300, 20
ALWAYS = 1e-5
"""Quantiles that lie nearer to each other, as a share of the largest: the time is always the same."""
FLAT, APART, MOST_CHARTS = 8.0, 2.5, 3
"""Times: where the longest is so much longer than the shortest, those so much longer than the next shorter one get a
chart of their own, as many as that at most."""
FILL = "rgba(0,114,178,0.32)"
LEGEND: list[LegendEntry] = [(FILL, "how often a time is found"), (INK, "solid", "P10 to P90, dot: median")]
NOTE = (
    "All replications together; times within a run depend on each other, so these pictures carry no intervals. A "
    "violin is as wide as times are frequent there; all have one greatest width, and the longest half per "
    "cent is left out."
)


def cycle_times_section(material: Material) -> Section | None:
    """A group of violins for each kind of time; None where nothing took any time."""
    rows = [row for row in material.result.summary.get("distributions", []) if row.get("n")]
    order = {material.plan.stations[rank].name: place for place, rank in enumerate(worked_on(material.plan))}
    blocks: list[Block] = [Bullets(violin_sentences(rows, *_through(material)))]
    for kpi, title in TITLES.items():
        of = sorted((row for row in rows if row["kpi"] == kpi), key=lambda row: order.get(row["subject"], 0))
        blocks += _group(kpi, title, of)
    if len(blocks) == 1:
        return None
    return Section("times", "How long it takes", [*blocks, Words(NOTE, muted=True)], "Times")


def _through(material: Material) -> tuple[int, int]:
    """(jobs inside at the end, jobs that left in the window) of the first replication; stock in stores is no delay."""
    log, plan = material.log, material.plan
    if log is None or any(station.kind == STORE for station in plan.stations):
        return 0, 0
    left = np.isin(log["kind"], list(LEAVING_KINDS)) & in_window(log["end_s"], plan)
    return int(jobs_inside(log).level[-1]), int(left.sum())


def _group(kpi: str, title: str, rows: Sequence[Row]) -> list[Block]:
    """Charts of what varies, words for what does not, and a table of all."""
    if not rows:
        return []
    varied = [row for row in rows if not is_always(row)]
    always = [f"{row['subject'] or 'all'} {quantity(row['quantiles']['0.5'], 's')}" for row in rows if is_always(row)]
    shown = sorted(varied, key=lambda row: -row["n"] * row["quantiles"]["0.5"])[:MOST_ROWS]
    shown = [row for row in varied if row in shown]
    blocks: list[Block] = []
    for place, part in enumerate(_of_like_length(shown)):
        heading = title if place == 0 else ""
        blocks.append(Chart(f"violins-{kpi}-{place}", _figure(part), _said(part), heading, LEGEND if not place else ()))
    if len(varied) > len(shown):
        blocks.append(Words(f"{len(varied) - len(shown)} more are in the table only.", muted=True))
    if always:
        blocks.append(Words(_always(title, always, alone=not shown)))
    return [*blocks, _table(title, rows)]


def _always(title: str, named: Sequence[str], *, alone: bool) -> str:
    """What does not vary. alone : whether no chart above says what it is about"""
    more = len(named) - MOST_ROWS
    words = "; ".join([*named[:MOST_ROWS], *([f"and {more} more"] if more > 0 else [])])
    return f"{title}: always the same: {words}." if alone else f"Always the same: {words}."


def is_always(row: Row) -> bool:
    """Whether all times of a distribution are as good as one."""
    values = list(row["quantiles"].values())
    return max(values) - min(values) < ALWAYS * max(values) and not row.get("beyond")


def _of_like_length(rows: Sequence[Row]) -> list[list[Row]]:
    """All in one chart, or cut where a time is much longer than the next shorter one: long ones press others flat."""
    by_length = sorted(rows, key=lambda row: row["quantiles"]["0.95"])
    lengths = [max(row["quantiles"]["0.95"], 1e-9) for row in by_length]
    if not rows or lengths[-1] < FLAT * lengths[0]:
        return [list(rows)] if rows else []
    gaps = sorted(((b / a, n) for n, (a, b) in enumerate(pairwise(lengths), 1) if b >= APART * a), reverse=True)
    cuts = sorted(n for _, n in gaps[: MOST_CHARTS - 1])
    parts = [by_length[low:high] for low, high in pairwise([0, *cuts, len(by_length)])]
    return [[row for row in rows if row in part] for part in parts]


def samples(row: Row, most: int = MOST_SAMPLES) -> np.ndarray:
    """(most,) times spread as those of a distribution's histogram, at even steps of their shares.

    NOTE: those of the histogram and no single times, as it holds all replications, and pictures need no more.
    """
    counts, edges = np.array(row["histogram"]["counts"], dtype=float), np.array(row["histogram"]["edges"])
    until = np.r_[0.0, np.cumsum(counts)] / counts.sum()
    return np.interp((np.arange(most) + 0.5) / most, until, edges)


def _figure(rows: Sequence[Row]) -> dict[str, Any]:
    longest = max(row["quantiles"]["0.95"] for row in rows)
    factor, unit = scale_of("s", longest)
    data = [_violin(place, row, factor) for place, row in enumerate(rows)]
    layout = layout_of(70 + 44 * len(rows)) | {"violingap": 0.1, "violinmode": "overlay"}
    layout["xaxis"] |= {"title": {"text": unit, "standoff": 6, "font": {**FONT, "size": 12}}, "rangemode": "tozero"}
    ends = [max(row["histogram"]["edges"][-1], row["quantiles"]["0.95"]) * factor for row in rows]
    layout["xaxis"] |= {"range": [0, 1.03 * max(ends)], "nticks": 7}
    names = [label(row["subject"] or "all") for row in rows]
    layout["yaxis"] |= {"tickvals": list(range(len(rows))), "ticktext": names, "showgrid": False}
    layout["yaxis"] |= {"range": [len(rows) - 0.45, -0.55]}
    layout["margin"] |= {"t": 6}
    return {"data": [*data, *_quantiles(rows, factor, unit)], "layout": layout}


def _violin(place: int, row: Row, factor: float) -> dict[str, Any]:
    return {
        "type": "violin",
        "orientation": "h",
        "x": [float(f"{value:.4g}") for value in (samples(row) * factor).tolist()],
        "y0": place,
        "width": 0.86,
        "points": False,
        "spanmode": "hard",
        "scalemode": "width",
        "fillcolor": FILL,
        "line": {"color": ACCENT, "width": 1.1},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def _quantiles(rows: Sequence[Row], factor: float, unit: str) -> list[dict[str, Any]]:
    """The line from P10 to P90, and the median on it."""
    at = {q: [row["quantiles"][q] * factor for row in rows] for q in QUANTILES}
    error = {
        "type": "data",
        "symmetric": False,
        "array": [high - middle for high, middle in zip(at["0.9"], at["0.5"])],
        "arrayminus": [middle - low for low, middle in zip(at["0.1"], at["0.5"])],
        "color": INK,
        "thickness": 2,
        "width": 5,
    }
    told = [
        f"{label(row['subject'] or 'all')}: median {digits(middle)}, P10 {digits(low)}, P90 {digits(high)} {unit}"
        for row, low, middle, high in zip(rows, at["0.1"], at["0.5"], at["0.9"])
    ]
    look = {"size": 8, "color": "#ffffff", "line": {"color": INK, "width": 2}}
    points = {"x": at["0.5"], "y": list(range(len(rows))), "error_x": error, "marker": look, "customdata": told}
    return [{"type": "scatter", "mode": "markers", **points, "hovertemplate": "%{customdata}<extra></extra>"}]


def _said(rows: Sequence[Row]) -> str:
    return "; ".join(
        f"{row['subject'] or 'all'}: median {quantity(row['quantiles']['0.5'], 's')}, "
        f"P10 {quantity(row['quantiles']['0.1'], 's')}, P90 {quantity(row['quantiles']['0.9'], 's')}"
        for row in rows
    )


def _table(title: str, rows: Sequence[Row]) -> Folded:
    columns = (
        "Of",
        *(("median" if q == "0.5" else f"P{100 * float(q):.0f}") for q in QUANTILES),
        "n",
        "beyond the picture",
    )
    cells = [
        [
            row["subject"] or "all",
            *(quantity(row["quantiles"][q], "s") for q in QUANTILES),
            f"{row['n']:,}",
            f"{row.get('beyond', 0):,}",
        ]
        for row in rows
    ]
    return Folded(f"Percentiles: {title[:1].lower()}{title[1:]}", [Grid(columns, cells, title)])
