"""A forest plot: a row each with its name and numbers above a dot and its interval, readable on a telephone.

All variants of a run beside each other: each headline figure with its interval, and its paired difference.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from typing import Any

from opsim.kpi.parts import part_name
from opsim.report.comparison_sentences import (
    CLEAR,
    NOT_PROVEN,
    answer,
    comparison_cells,
    largest_of,
    signed,
    spoken_of,
    way_of,
)
from opsim.report.material import Material, Same
from opsim.report.numbers import POINTS, difference_unit, kpi_name, largest_mean, plus_minus, scale_of
from opsim.report.page import Block, Bullets, Chart, Folded, Grid, Panels, Section, Words
from opsim.report.plot.plotly import ACCENT, FONT, INK, MUTED, label, layout_of
from opsim.study.compare import Comparison, Difference, NotComparable, compare
from opsim.study.intervals import CONFIDENCE

ROW_PX, FOOT_PX = 44, 58
HERE = " (this report)"


@dataclass(frozen=True, slots=True)
class Dot:
    """One row in the axis' unit, None where it is not known. number : the same in words; base : what the others are
    held against; here : the variant that a report is of; clear : whether it is told apart from the base"""

    name: str
    number: str
    low: float | None
    mean: float | None
    high: float | None
    base: bool = False
    here: bool = False
    clear: bool = False


@dataclass(frozen=True, slots=True)
class Forest:
    """Rows from above; at : where the line across them stands, and what it is."""

    dots: Sequence[Dot]
    unit: str
    at: float | None
    what: str

    @property
    def said(self) -> str:
        """All rows as words."""
        rows = "; ".join(f"{dot.name}{HERE if dot.here else ''}: {dot.number}" for dot in self.dots)
        return f"{rows}. In {self.unit}; {self.what}." if self.unit else f"{rows}. {self.what}."


def forest_chart(forest: Forest) -> dict[str, Any]:
    """The figure: diamonds are bases, full dots clearly differ, open ones do not (or are not held against anything)."""
    layout = layout_of(FOOT_PX + ROW_PX * len(forest.dots)) | {"annotations": _names(forest.dots)}
    title = ", ".join(filter(None, (forest.unit, forest.what)))
    layout["xaxis"] |= {"title": {"text": title, "standoff": 6, "font": {**FONT, "size": 12}}, "nticks": 6}
    layout["xaxis"] |= {"zeroline": False, **_range(forest)}
    layout["yaxis"] |= {"range": [len(forest.dots) - 0.45, -0.75], "showticklabels": False, "showgrid": False}
    layout["margin"] |= {"t": 4, "b": 44, "l": 2, "r": 8}
    if forest.at is not None:
        layout["shapes"] = [_across(forest.at)]
    known = [(row, dot) for row, dot in enumerate(forest.dots) if dot.mean is not None]
    return {"data": [_dots(known, kind) for kind in _kinds(known)], "layout": layout}


def _range(forest: Forest) -> dict[str, Any]:
    """All intervals and the line, with a margin; one about a constant too."""
    ends = [end for dot in forest.dots for end in (dot.low, dot.mean, dot.high) if end is not None]
    ends += [] if forest.at is None else [forest.at]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
    return {"range": [low - margin, high + margin]}


Kind = tuple[bool, bool]
"""(base, clear)"""


def _kinds(known: Sequence[tuple[int, Dot]]) -> list[Kind]:
    return sorted({(dot.base, dot.clear) for _, dot in known})


def _dots(known: Sequence[tuple[int, Dot]], kind: Kind) -> dict[str, Any]:
    base, clear = kind
    of = [(row, dot) for row, dot in known if (dot.base, dot.clear) == kind]
    colour = INK if base else ACCENT if clear else MUTED
    symbol = "diamond" if base else "circle" if clear else "circle-open"
    error = {
        "type": "data",
        "symmetric": False,
        "array": [_apart(dot.mean, dot.high) for _, dot in of],
        "arrayminus": [_apart(dot.low, dot.mean) for _, dot in of],
        "color": colour,
        "thickness": 2.4,
        "width": 5,
    }
    return {
        "type": "scatter",
        "mode": "markers",
        "name": "base" if base else "clear" if clear else "not clear",
        "x": [dot.mean for _, dot in of],
        "y": [row for row, _ in of],
        "error_x": error,
        "marker": {"size": 11 if base else 10, "color": colour, "symbol": symbol, "line": {"width": 2}},
        "customdata": [f"{label(dot.name)}: {escape(dot.number, quote=False)}" for _, dot in of],
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def _apart(low: float | None, high: float | None) -> float:
    """Nothing where one of them is not known."""
    return 0.0 if low is None or high is None else high - low


def _names(dots: Sequence[Dot]) -> list[dict[str, Any]]:
    """Above each row, from the left edge: nothing is lost beside the chart on a narrow screen."""
    place = {"xref": "paper", "x": 0, "xanchor": "left", "yanchor": "bottom", "showarrow": False}
    return [
        {
            **place,
            "y": row - 0.2,
            "text": f"<b>{label(dot.name)}</b>{HERE if dot.here else ''}  {escape(dot.number, quote=False)}",
            "font": {**FONT, "size": 12},
            "bgcolor": "rgba(255,255,255,0.85)",
            "borderpad": 0,
        }
        for row, dot in enumerate(dots)
    ]


def _across(at: float) -> dict[str, Any]:
    line = {"color": INK, "width": 1.2, "dash": "dot"}
    return {"type": "line", "x0": at, "x1": at, "y0": 0, "y1": 1, "yref": "paper", "line": line, "layer": "below"}


BASE, TOO_FEW = "base", "too few replications to say"
MOST_FIGURES, MOST_VARIANTS, MOST_SENTENCES, MOST_ROWS = 8, 30, 6, 400
READ = (
    f"A line is a {100 * CONFIDENCE:.0f} % interval; \N{BLACK DIAMOND} is the base, \N{BLACK CIRCLE} clearly differs "
    "from it with all comparisons held together, \N{WHITE CIRCLE} does not."
)
Key = tuple[str, str, str, str]
Rows = Mapping[str, Mapping[Key, Mapping[str, Any]]]
"""By variant, the rows of its summary by key."""


def scenarios_section(material: Material) -> Section | None:
    """A chart of intervals a figure, and one of differences from the base; None for a run of one variant."""
    siblings = material.siblings
    if len(siblings) < 2:
        return None
    base = BASE if BASE in siblings else next(iter(siblings))
    here = material.summary["variant"]
    rows = {name: {_key(row): row for row in result.summary["kpis"]} for name, result in siblings.items()}
    compared = _compared(Same(siblings), base)
    if isinstance(compared, str):
        keys = [key for key, row in rows[base].items() if row["headline"] and not key[1] and not key[2]]
        said: list[Block] = [Words(f"These variants are not compared: {compared}.")]
        blocks = [_panels(key, rows, [], base, here, False) for key in keys[:MOST_FIGURES]]
        return Section("scenarios", "Scenarios side by side", [*said, *blocks], "Scenarios")
    spoken = spoken_of(compared)
    by_key = {key: [d for d in spoken if d.key == key] for key in dict.fromkeys(d.key for d in spoken)}
    told = {key: of for key, of in by_key.items() if not all(d.identical for d in of)}
    shown = dict(list(told.items())[:MOST_FIGURES])
    hours = bool(compared.hours)
    blocks = [_panels(key, rows, of, base, here, hours) for key, of in shown.items()]
    return Section(
        "scenarios",
        "Scenarios side by side",
        [
            Bullets(_sentences(compared)),
            Words(READ),
            *blocks,
            _table(compared),
            Words(_how(compared, told), muted=True),
        ],
        "Scenarios",
    )


@lru_cache(maxsize=1)
def _compared(same: Same, base: str) -> Comparison | str:
    """The comparison, or why there is none."""
    try:
        return compare(same.of, base)
    except NotComparable as why:
        return str(why).rstrip(".")


def _key(row: Mapping[str, Any]) -> Key:
    return row["kpi"], row["subject"], row.get("part", ""), row["unit"]


def _sentences(compared: Comparison) -> list[str]:
    said = answer(compared)
    more = len(said) - MOST_SENTENCES
    return [*said[:MOST_SENTENCES], *([f"{more} more variants differ; see below."] if more > 0 else [])]


def _panels(key: Key, rows: Rows, of: Sequence[Difference], base: str, here: str, hours: bool) -> Panels:
    """The chart of means, and beside it that of differences where there are some."""
    name = " · ".join(filter(None, (kpi_name(key[0], hours), part_name(key[0], key[2]))))
    variants = _chosen(of, list(rows), base)
    stem = "-".join(filter(None, ("forest", key[0], key[2].replace(" ", "_"))))
    number = "".join(letter if letter.isalnum() else "-" for letter in stem)
    means = _means(key, rows, variants, base, here, {d.variant for d in of if d.verdict in CLEAR})
    title = f"{name}, of {len(variants)} of {len(rows)} variants" if len(variants) < len(rows) else name
    charts = [Chart(f"{number}-mean", forest_chart(means), means.said, title=title)]
    if of:
        by = {d.variant: d for d in of}
        apart = _differences([by[name] for name in variants if name in by], here)
        charts.append(Chart(f"{number}-apart", forest_chart(apart), apart.said, title=f"Difference from {base}"))
    return Panels(charts, least_px=330)


def _chosen(of: Sequence[Difference], variants: Sequence[str], base: str) -> list[str]:
    """All variants in their order, the base first; of many the best and the worst half of what is shown."""
    if len(variants) <= MOST_VARIANTS:
        return [base, *(name for name in variants if name != base)]
    known = sorted((d for d in of if d.interval.n), key=_gain, reverse=True)
    half = (MOST_VARIANTS - 1) // 2
    names = [d.variant for d in known] or [name for name in variants if name != base]
    return [base, *names[:half], *names[-half:]]


def _gain(difference: Difference) -> float:
    """How much better a variant is; where no way is better for all, how much higher."""
    by = difference.interval.mean
    return abs(by) * (way_of(difference) or (1 if by > 0 else -1))


def _means(key: Key, rows: Rows, variants: Sequence[str], base: str, here: str, clear: set[str]) -> Forest:
    found = {name: rows[name].get(key) for name in variants}
    known = [row for row in found.values() if row is not None]
    largest = largest_mean(known)
    factor, unit = scale_of(key[3], largest)
    dots = []
    for name in variants:
        row = found[name] or {}
        number = plus_minus(row, largest).removesuffix(unit).strip() if row else "not measured"
        low, mean, high = (_times(row.get(edge), factor) for edge in ("low", "mean", "high"))
        dots.append(Dot(name, number, low, mean, high, name == base, name == here, name in clear))
    at = next((dot.mean for dot in dots if dot.base), None)
    return Forest(dots, unit, at, "mean")


def _differences(of: Sequence[Difference], here: str) -> Forest:
    largest = largest_of(of)
    factor, unit = scale_of(of[0].key[3], largest)
    unit = difference_unit(unit)
    dots = []
    for d in of:
        cells = comparison_cells(d, largest)
        relative = f", {signed(cells['relative'])}" if cells["relative"] else ""
        number = f"{signed(cells['difference'])}{relative}: {_verdict(d)}"
        if d.verdict == TOO_FEW:
            number = f"{signed(f'{d.interval.mean * factor:.3g}')} in each of {d.interval.n} pairs: too few to say"
        low, mean, high = (_times(value, factor) for value in (d.interval.low, d.interval.mean, d.interval.high))
        dots.append(Dot(d.variant, number, low, mean, high, here=d.variant == here, clear=d.verdict in CLEAR))
    return Forest(dots, unit, 0.0, "paired difference")


def _verdict(difference: Difference) -> str:
    """``higher, better``; what is not proven says so."""
    if difference.verdict in CLEAR:
        return difference.verdict + {1: ", better", -1: ", worse", 0: ""}[way_of(difference)]
    return f"{NOT_PROVEN} among {'so '}many" if difference.verdict == NOT_PROVEN else difference.verdict


def _times(value: Any, factor: float) -> float | None:
    """None where it is not known."""
    return None if value is None or value != value else value * factor


def _table(compared: Comparison) -> Folded:
    """Every difference in words: what the charts draw, for who reads rather than looks."""
    hours, rows = bool(compared.hours), []
    for d in compared.differences[:MOST_ROWS]:
        alike = [other for other in compared.differences if other.key[0] == d.key[0]]
        cells = comparison_cells(d, largest_of(alike), [other for other in alike if other.key == d.key])
        name = " · ".join(filter(None, (kpi_name(d.key[0], hours), d.key[1], part_name(d.key[0], d.key[2]))))
        by = " ".join(filter(None, (signed(cells["difference"]), cells["unit"])))
        base, mean = (cells[key] + (" %" if cells["unit"] == POINTS else "") for key in ("base", "mean"))
        rows.append([d.variant, name, base, mean, by, cells["relative"], _verdict(d)])
    columns = ("Variant", "Figure", compared.base, "Variant's", "Difference", "in %", "Verdict")
    return Folded("Every difference as a table", [Grid(columns, rows, "", words=2, left=(6,))])


def _how(compared: Comparison, told: Mapping[Key, Any]) -> str:
    more = len(told) - MOST_FIGURES
    said = [f"{more} more figures are in the table only."] if more > 0 else []
    return " ".join([*compared.words, *said])
