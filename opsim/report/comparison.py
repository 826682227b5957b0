"""Variants compared, as one HTML file that needs nothing else: no network, no other file, no script.

A comparison as one table that fits a screen: figures against variants.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from opsim.files import write_text
from opsim.kpi.parts import part_name
from opsim.report.comparison_sentences import (
    BEST,
    CLEAR,
    MANY,
    NOT_PROVEN,
    answer,
    best_of,
    comparison_cells,
    largest_of,
    signed,
    spoken_name,
    spoken_of,
    way_of,
)
from opsim.report.numbers import ABSENT, POINTS, difference_unit, kpi_name, scale_of
from opsim.report.plot.svg_chart import intervals_svg
from opsim.report.sections.pareto import frontier_section

if TYPE_CHECKING:
    from opsim.study.compare import Comparison, Difference
    from opsim.study.pareto import Frontier

HERE = Path(__file__).parent
MOST_ROWS = 60
"""Variants shown of each figure; of more, those that differ most, for the page to be read at all."""


def write_comparison(comparison: Comparison, path: str | Path, title: str, frontier: Frontier | None = None) -> Path:
    """Write the page of a Comparison and return where it is. frontier : of two figures, or None where nobody asked"""
    path = Path(path)
    write_text(path, comparison_html(comparison, title, frontier))
    return path


def comparison_html(comparison: Comparison, title: str, frontier: Frontier | None = None) -> str:
    """The page as text; names are escaped by jinja2, and in pictures by ``intervals_svg`` and ``frontier_svg``."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    keys = list(dict.fromkeys(difference.key for difference in comparison.differences))
    hours = bool(comparison.hours)
    groups = [_group([d for d in comparison.differences if d.key == key], hours) for key in keys]
    environment = Environment(loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined)
    return environment.get_template("comparison.html.jinja").render(
        title=title,
        answer=answer(comparison),
        words=comparison.words,
        base=comparison.base,
        groups=groups,
        frontier=None if frontier is None else frontier_section(frontier, hours),
        style=(HERE / "report.css").read_text(encoding="utf-8"),
    )


def _group(differences: Sequence[Any], hours: bool) -> dict[str, Any]:
    kpi, subject, part, unit = differences[0].key
    largest = largest_of(differences)
    shown = _shown(differences)
    factor, word = scale_of(unit, largest)
    bars = [
        (d.variant, d.interval.low * factor, d.interval.mean * factor, d.interval.high * factor, d.verdict)
        for d in shown
    ]
    rows = [{"variant": d.variant, **comparison_cells(d, largest, differences)} for d in shown]
    return {
        "name": " · ".join(filter(None, (kpi_name(kpi, hours), subject, part_name(kpi, part)))),
        "base": f"{rows[0]['base']} {word}".strip(),
        "sign": " %" if word == "%" else "",
        "rows": rows,
        "others": len(differences) - len(shown),
        "picture": intervals_svg(bars, difference_unit(word)),
    }


def _shown(differences: Sequence[Any]) -> list[Any]:
    """All where they are few; else the best half and the worst half of what is shown, the best first."""
    if len(differences) <= MOST_ROWS:
        return list(differences)
    known = [d for d in differences if d.interval.n]
    ordered = sorted(known, key=lambda d: -abs(d.interval.mean) * (way_of(d) or (1 if d.interval.mean > 0 else -1)))
    return ordered if len(ordered) <= MOST_ROWS else [*ordered[: MOST_ROWS // 2], *ordered[-MOST_ROWS // 2 :]]


MOST_FIGURES = 18
MOST_ACROSS = 4
NARROWEST, EACH = 30, 17
"""Characters of the first column and of each other one: as many stand beside each other as a screen has room for."""
STAR, ALONE = " *", " (*)"


@dataclass(frozen=True, slots=True)
class ScreenTable:
    """Rows of text under columns, and sentences on what the table leaves out."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    left_out: tuple[str, ...]


def screen_table(comparison: Comparison, width: int) -> ScreenTable:
    """Variants beside each other where there is room for them, else below each other with the first figures.

    width : characters of the screen
    """
    variants = list(dict.fromkeys(d.variant for d in comparison.differences))
    room = max(1, min(MOST_ACROSS, (width - NARROWEST - EACH) // EACH))
    return _figures_down(comparison, variants) if len(variants) <= room else _variants_down(comparison, variants, room)


def _figures_down(comparison: Comparison, variants: Sequence[str]) -> ScreenTable:
    found = _by_figure(comparison)
    same = [of for of in found if all(d.verdict == "identical" for d in of)]
    told = [of for of in found if of not in same and not _says_again(of, found)]
    shown = _first(told)
    rows = [
        _figure_row(of, found, variants, comparison, below=bool(at) and shown[at - 1][0].key[0] == of[0].key[0])
        for at, of in enumerate(shown)
    ]
    columns = ("figure", comparison.base, *variants)
    return ScreenTable(columns, tuple(rows), tuple(_left_out(len(told) - len(shown), same, comparison)))


def _variants_down(comparison: Comparison, variants: Sequence[str], room: int) -> ScreenTable:
    spoken = spoken_of(comparison)
    keys = list(dict.fromkeys(d.key for d in spoken))[:room]
    shown = [d.variant for d in best_of(spoken)] if len(variants) > max(BEST, MANY) else list(variants)
    by = {(d.variant, d.key): d for d in spoken}
    largest = {key: largest_of([d for d in spoken if d.key[0] == key[0]]) for key in keys}
    bases = [next(d for d in spoken if d.key == key) for key in keys]
    hours = bool(comparison.hours)
    names = [_with_unit(spoken_name(d, hours), scale_of(d.key[3], largest[d.key])[1]) for d in bases]
    columns = ("variant", *names)
    first = (comparison.base, *(_base(d, [o for o in spoken if o.key == d.key], largest[d.key]) for d in bases))
    rows = [(name, *(_cell(by.get((name, key)), largest[key]) for key in keys)) for name in shown]
    others = len(variants) - len(shown)
    out = [f"The best {len(shown)} of {len(variants):,} variants in {spoken_name(bases[0], hours)}."] if others else []
    n_left = len({d.key for d in comparison.differences}) - len(keys)
    return ScreenTable(columns, (first, *rows), (*out, *_left_out(n_left, [], comparison)))


def _by_figure(comparison: Comparison) -> list[list[Any]]:
    found: dict[Any, list[Any]] = {}
    for difference in comparison.differences:
        found.setdefault(difference.key, []).append(difference)
    return list(found.values())


def _figure_row(
    of: Sequence[Any], found: Sequence[Any], variants: Sequence[str], comparison: Comparison, below: bool
) -> tuple[str, ...]:
    """below : whether the row above is of the same figure, whose name is then not said again"""
    kpi, subject, part, unit = of[0].key
    largest = largest_of([d for others in found if others[0].key[0] == kpi for d in others])
    whole, own = kpi_name(kpi, bool(comparison.hours)), " ".join(filter(None, (subject, part_name(kpi, part))))
    name = f"  {own}" if below and own else _with_unit(whole, scale_of(unit, largest)[1])
    name = f"{name}: {own}" if own and not below else name
    by = {d.variant: d for d in of}
    cells = [_cell(by.get(variant), largest) for variant in variants]
    return (name, _base(of[0], of, largest), *cells)


def _base(difference: Difference, beside: Sequence[Any], largest: float | None) -> str:
    return comparison_cells(difference, largest, beside)["base"]


def _with_unit(name: str, unit: str) -> str:
    """``Time in system, min``; ``Jobs inside`` says its unit itself."""
    return name if not unit or name.endswith(unit.split()[-1]) or name.lower().startswith(unit) else f"{name}, {unit}"


def _cell(difference: Difference | None, largest: float | None) -> str:
    if difference is None or math.isnan(difference.interval.mean):
        return ABSENT
    cells = comparison_cells(difference, largest)
    text = signed(cells["difference"]) + (" points" if cells["unit"] == POINTS else "")
    return text + (STAR if difference.verdict in CLEAR else ALONE if difference.verdict == NOT_PROVEN else "")


def _first(told: Sequence[Any]) -> list[Any]:
    """As many figures as fit: where there are more, those of the whole floor before their parts."""
    if len(told) <= MOST_FIGURES:
        return list(told)
    whole = [of for of in told if not of[0].key[1] and not of[0].key[2]]
    kept = [*whole, *(of for of in told if of not in whole)][:MOST_FIGURES]
    return [of for of in told if of in kept]


def _says_again(of: Sequence[Any], found: Sequence[Any]) -> bool:
    """Whether it is how much there may be at most of a figure, and no other than that figure in any variant."""
    kpi, subject, part, _ = of[0].key
    if not part.endswith("at_most"):
        return False
    least = part.removesuffix("at_most").removesuffix("_")
    beside = next((o for o in found if o[0].key[:3] == (kpi, subject, least)), None)
    return beside is not None and [(d.base, d.mean) for d in of] == [(d.base, d.mean) for d in beside]


def _left_out(n: int, same: Sequence[Any], comparison: Comparison) -> list[str]:
    said = []
    if same:
        names = list(dict.fromkeys(spoken_name(of[0]) for of in same))
        more = f" and {len(names) - 3} more figures" if len(names) > 3 else ""
        said.append(f"The same in all variants: {', '.join(names[:3])}{more}.")
    if n > 0:
        said.append("1 more figure is in the page." if n == 1 else f"{n} more figures are in the page.")
    return said
