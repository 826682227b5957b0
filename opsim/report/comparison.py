"""Variants compared, as one HTML file that needs nothing else: no network, no other file, no script."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from opsim.report.comparison_cells import comparison_cells, largest_of
from opsim.report.comparison_words import answer, way_of
from opsim.report.frontier import frontier_section
from opsim.report.interval_picture import intervals_svg
from opsim.report.parts import part_name
from opsim.report.words import kpi_name, quantity, scale_of
from opsim.whole import write_text

HERE = Path(__file__).parent
MOST_ROWS = 60
"""Variants shown of each figure; of more, those that differ most, for the page to be read at all."""


def write_comparison(comparison: Any, path: str | Path, title: str, frontier: Any = None) -> Path:
    """Write the page of a Comparison and return where it is. frontier : of two figures, or None where nobody asked"""
    path = Path(path)
    write_text(path, comparison_html(comparison, title, frontier))
    return path


def comparison_html(comparison: Any, title: str, frontier: Any = None) -> str:
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
    return {
        "name": " · ".join(filter(None, (kpi_name(kpi, hours), subject, part_name(kpi, part)))),
        "base": quantity(differences[0].base, unit),
        "rows": [{"variant": d.variant, **comparison_cells(d, largest)} for d in shown],
        "others": len(differences) - len(shown),
        "picture": intervals_svg(bars, word),
    }


def _shown(differences: Sequence[Any]) -> list[Any]:
    """All where they are few; else the best half and the worst half of what is shown, the best first."""
    if len(differences) <= MOST_ROWS:
        return list(differences)
    known = [d for d in differences if d.interval.n]
    ordered = sorted(known, key=lambda d: -abs(d.interval.mean) * (way_of(d) or (1 if d.interval.mean > 0 else -1)))
    return ordered if len(ordered) <= MOST_ROWS else [*ordered[: MOST_ROWS // 2], *ordered[-MOST_ROWS // 2 :]]
