"""Rows of the summary as bars: of each subject the minutes at RULA 7, at 5 or more, and at most.

Bars of minutes at high scores: what is sure, and what may be; with the interval over replications.

What bodies went through in plain words: who, where, when, and from which region of the body it comes.

Limits of lifting, holding, reaching and rest that people are beyond, as the figures that were asked for tell it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.kpi.parts import REGION_NAMES
from opsim.report.numbers import digits, is_number, listing
from opsim.report.plot.plotly import FONT, INK, label, layout_of
from opsim.report.sections.summary import find, with_interval

Row = Mapping[str, Any]
LEVELS = (("rula_from_7", ""), ("rula_from_5", ""), ("rula_from_5", "at_most"))
NOWHERE = "none"
REGION = "exposure_by_region"


@dataclass(frozen=True, slots=True)
class Bar:
    """Minutes of an hour, means over replications. most : at RULA 5 or more, if all that is not said were at its worst

    low, high : interval of ``five``; nan where there is none
    """

    subject: str
    seven: float
    five: float
    most: float
    low: float = float("nan")
    high: float = float("nan")

    @property
    def is_open(self) -> bool:
        """Whether there may be more than is sure."""
        return self.most > self.five + 1e-9


def bars_of_workers(rows: Sequence[Row]) -> list[Bar]:
    """A bar a worker, in their order; none where RULA was not asked for, or never known."""
    found = {(row["kpi"], row["subject"], row["part"]): row for row in rows}
    names = [subject for kpi, subject, part in found if (kpi, part) == ("rula_from_5_min_per_h", "") and subject]
    return _made((name, [found.get((f"{kpi}_min_per_h", name, part)) for kpi, part in LEVELS]) for name in names)


def bar_of_all(rows: Sequence[Row]) -> Bar | None:
    """All workers together, in an hour of all workers' time."""
    found = {(row["kpi"], row["part"]): row for row in rows if not row["subject"]}
    made = _made([("all", [found.get((f"{kpi}_min_per_h", part)) for kpi, part in LEVELS])])
    return made[0] if made else None


def bars_by(rows: Sequence[Row], kpi: str) -> list[Bar]:
    """A bar a subject of ``exposure_by_...``; what is at no station, or with no task, only where it is something."""
    own = {(row["subject"], row["part"]): row for row in rows if row["kpi"] == kpi}
    subjects = dict.fromkeys(subject for subject, _ in own)
    made = _made((s, [own.get((s, "_".join(filter(None, level)))) for level in LEVELS]) for s in subjects)
    return [bar for bar in made if bar.subject != NOWHERE or bar.most > 0]


def bars_of_regions(rows: Sequence[Row]) -> list[Bar]:
    """A bar a region, the longest first, those without any left out; what only may be is not dealt out."""
    own = {(row["subject"], row["part"]): row for row in rows if row["kpi"] == REGION}
    levels = ("rula_from_7", "rula_from_5", "rula_from_5")
    made = _made((s, [own.get((s, level)) for level in levels]) for s in dict.fromkeys(subject for subject, _ in own))
    return sorted((bar for bar in made if bar.five > 0), key=lambda bar: -bar.five)


def _made(found: Any) -> list[Bar]:
    """found : (subject, its rows at RULA 7, at 5 and at most) each; left out where one is not known"""
    return [
        Bar(subject, seven["mean"], five["mean"], max(most["mean"], five["mean"]), *map(_number(five), ("low", "high")))
        for subject, (seven, five, most) in found
        if all(row is not None and is_number(row["mean"]) for row in (seven, five, most))
    ]


def _number(row: Row) -> Callable[[str], float]:
    return lambda edge: row[edge] if is_number(row.get(edge)) else float("nan")


SEVEN, FIVE, PERHAPS = ("#8F2D06", "RULA 7"), ("#EBA02A", "RULA 5 or 6"), ("#F7DFAE", "perhaps 5 or more")
"""Colours that differ in lightness too, and their words."""


def level_bars(bars: Sequence[Bar], *, upright: bool = False) -> dict[str, Any]:
    """One stacked bar a subject. upright : bars stand on an axis of time, else they lie below each other"""
    parts = {
        SEVEN: [bar.seven for bar in bars],
        FIVE: [max(bar.five - bar.seven, 0.0) for bar in bars],
        PERHAPS: [bar.most - bar.five for bar in bars],
    }
    data = [_stack(bars, values, *look, upright) for look, values in parts.items() if max(values, default=0.0) > 1e-9]
    if not data:
        data = [_stack(bars, [0.0] * len(bars), *FIVE, upright)]
    return {"data": [*data, *_intervals(bars, upright)], "layout": _layout(bars, upright)}


def bar_legend(bars: Sequence[Bar]) -> list[tuple[str, str]]:
    """(colour, words) of what the bars show."""
    there = {
        SEVEN: any(bar.seven > 0 for bar in bars),
        FIVE: any(bar.five > bar.seven for bar in bars),
        PERHAPS: any(bar.is_open for bar in bars),
    }
    return [look for look, is_there in there.items() if is_there]


def said(bars: Sequence[Bar]) -> str:
    """The figure in words."""
    return "; ".join(
        f"{bar.subject}: {digits(bar.seven)} minutes of an hour at RULA 7, {digits(bar.five)} at 5 or more"
        + (f", at most {digits(bar.most)}" if bar.is_open else "")
        for bar in bars
    )


def _stack(bars: Sequence[Bar], values: Sequence[float], colour: str, words: str, upright: bool) -> dict[str, Any]:
    places = list(range(len(bars)))
    along, across = ("y", "x") if upright else ("x", "y")
    return {
        "type": "bar",
        "orientation": "v" if upright else "h",
        "name": words,
        along: list(values),
        across: places,
        "width": 0.66,
        "marker": {"color": colour, "line": {"color": "#ffffff", "width": 1}},
        "customdata": [[label(bar.subject), digits(value)] for bar, value in zip(bars, values)],
        "hovertemplate": f"%{{customdata[0]}}: {words} %{{customdata[1]}} min/h<extra></extra>",
    }


def _intervals(bars: Sequence[Bar], upright: bool) -> list[dict[str, Any]]:
    """The interval over replications, at the end of what is sure."""
    places = [place for place, bar in enumerate(bars) if math.isfinite(bar.low) and math.isfinite(bar.high)]
    if not places:
        return []
    along, across = ("y", "x") if upright else ("x", "y")
    error = {
        "type": "data",
        "symmetric": False,
        "array": [bars[place].high - bars[place].five for place in places],
        "arrayminus": [bars[place].five - bars[place].low for place in places],
        "color": INK,
        "thickness": 1.6,
        "width": 5,
    }
    return [
        {
            "type": "scatter",
            "mode": "markers",
            along: [bars[place].five for place in places],
            across: places,
            "marker": {"size": 1, "color": INK},
            f"error_{along}": error,
            "hoverinfo": "skip",
        }
    ]


def _layout(bars: Sequence[Bar], upright: bool) -> dict[str, Any]:
    places, words = list(range(len(bars))), [label(bar.subject) for bar in bars]
    layout = layout_of(280 if upright else 74 + 36 * len(bars)) | {"barmode": "stack"}
    names, minutes = ("xaxis", "yaxis") if upright else ("yaxis", "xaxis")
    top = max((max(bar.most, bar.high if math.isfinite(bar.high) else 0.0) for bar in bars), default=0.0)
    title = {"text": "minutes of an hour", "standoff": 6, "font": {**FONT, "size": 12}}
    layout[minutes] |= {"range": [0, 1.06 * top or 1.0], "title": title, "nticks": 7}
    layout[names] |= {"tickvals": places, "ticktext": words, "showgrid": False}
    layout[names]["range"] = [-0.6, len(bars) - 0.4] if upright else [len(bars) - 0.4, -0.6]
    return layout


MOST_NAMED = 3


def exposure_sentences(rows: Sequence[Row]) -> list[str]:
    """Sentences about RULA 5 and more, the most important first; none where nobody asked. rows : of the summary"""
    everybody, workers = bar_of_all(rows), bars_of_workers(rows)
    if everybody is None or not workers:
        return []
    if everybody.most <= 0:
        return ["Nobody was seen at RULA 5 or more."]
    return [
        *_who(workers),
        *_evenness(rows, workers),
        *_where(everybody, bars_by(rows, "exposure_by_task"), bars_by(rows, "exposure_by_station")),
        *_when(bars_by(rows, "exposure_by_hour")),
        *region_sentences(everybody, bars_of_regions(rows)),
        *_open(everybody, find(rows, "posture_measured_share")),
    ]


def _who(workers: Sequence[Bar]) -> Iterator[str]:
    worst = max(workers, key=lambda bar: (bar.five, bar.most))
    if worst.five <= 0:
        yield "Nobody is surely at RULA 5 or more."
        return
    seven = f", {digits(worst.seven, _half(worst))} of them at RULA 7" if worst.seven > 0 else ""
    yield f"{worst.subject} is exposed most: {_minutes(worst)} minutes of each hour at RULA 5 or more{seven}."
    least = min(workers, key=lambda bar: bar.five)
    if len(workers) > 1:
        same = _overlap(worst, least)
        others = f"{least.subject} has least, {_minutes(least)}"
        if least.five <= 0:
            yield f"{least.subject} has none."
        else:
            yield f"{others}: by the intervals the two are not told apart." if same else f"{others}."


def _evenness(rows: Sequence[Row], workers: Sequence[Bar]) -> Iterator[str]:
    """Of three and more: of two it is said by who has most and who has least."""
    gini = find(rows, "exposure_gini", "", "rula_from_5")
    if gini is not None and len(workers) > 2:
        yield f"How unevenly workers share it (Gini, 0: all alike, near 1: one has it all): {with_interval(gini)}."


def _where(everybody: Bar, tasks: Sequence[Bar], stations: Sequence[Bar]) -> Iterator[str]:
    found = [bar for bar in sorted(tasks, key=lambda bar: -bar.five) if bar.five > 0]
    if found and everybody.five > 0:
        named = [f"{bar.subject} {_share(bar.five, everybody.five)}" for bar in found[:MOST_NAMED]]
        yield f"Of the minutes at RULA 5 or more these tasks take: {listing(named)}."
    worst, next_ = [*sorted(stations, key=lambda bar: -bar.five), None, None][:2]
    if worst is not None and next_ is not None and worst.five > 0 and not _overlap(worst, next_):
        yield f"The station with most is {worst.subject}: {_share(worst.five, everybody.five)}."


def _when(hours: Sequence[Bar]) -> Iterator[str]:
    if len(hours) < 2 or max(bar.five for bar in hours) <= 0:
        return
    worst, least = max(hours, key=lambda bar: bar.five), min(hours, key=lambda bar: bar.five)
    if _overlap(worst, least):
        low, high = digits(least.five, 0.1), digits(worst.five, 0.1)
        yield f"By the hour it is {low} to {high} minutes: no hour is told apart from the others."
        return
    yield (
        f"The worst hour is that from {worst.subject}, with {_minutes(worst)} minutes of an hour of who is there, "
        f"breaks included; the best that from {least.subject}, with {_minutes(least)}."
    )


def region_sentences(everybody: Bar, regions: Sequence[Bar]) -> Iterator[str]:
    """From which regions of the body, and what else, the minutes of all workers at RULA 5 and at 7 come."""
    for level, words in (("five", "What brings people to RULA 5 or more"), ("seven", "What brings them to RULA 7")):
        whole = getattr(everybody, level)
        dealt = sorted(((getattr(bar, level), REGION_NAMES[bar.subject]) for bar in regions), reverse=True)
        named = [f"{region} ({_share(part, whole)})" for part, region in dealt if whole > 0 and part >= 0.005 * whole]
        if named:
            yield f"{words}: {listing(named)}."


def _open(everybody: Bar, known: Row | None) -> Iterator[str]:
    """known : how much of the work is seen at all, where that is asked"""
    seen = 1.0 if known is None else float(known["mean"])
    of = f", of the {100 * seen:.0f} % of the work whose posture is known; of the rest nothing" if seen < 0.995 else ""
    if everybody.is_open:
        yield (
            f"All workers together: at least {digits(everybody.five)} and at most {digits(everybody.most)} minutes of "
            f"an hour{of}. What lies between hangs on what nobody said of the tasks (load, grip, force, support) or "
            "saw of the body: see the assumption sheet."
        )


def _minutes(bar: Bar) -> str:
    half = _half(bar)
    if half is None:
        return digits(bar.five)
    return f"{digits(bar.five, half)} ({digits(bar.low, half)} to {digits(bar.high, half)})"


def _half(bar: Bar) -> float | None:
    half = (bar.high - bar.low) / 2
    return half if math.isfinite(half) else None


def _share(part: float, whole: float) -> str:
    return f"{100 * part / whole:.0f} %"


def _overlap(a: Bar, b: Bar) -> bool:
    """Whether two intervals meet; as far as none is known, they do."""
    return not (a.low > b.high or b.low > a.high)


MOST = 4
"""Of each kind: lifting, holding, rest."""


def limit_sentences(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sentences of lifting indices, holds and angles beyond standards, and rest, by the means over replications.

    rows : of the summary; at most ``MOST`` sentences of each kind, and how many more there would be
    """
    from opsim.subjects.exposure.strain_figures import energy_sentences, hold_sentences, lifting_sentences

    figures = {(row["kpi"], row["subject"], row["part"]): float(row["mean"]) for row in rows if is_number(row["mean"])}
    kinds = [list(kind(figures)) for kind in (lifting_sentences, hold_sentences, energy_sentences)]
    left = sum(max(0, len(said) - MOST) for said in kinds)
    more = [f"And {left} more: see the table of figures."] if left else []
    return [*(text for said in kinds for text in said[:MOST]), *more]
