"""Variants compared, as one HTML file that needs nothing else: no network, no other file, no script."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from opsim.report.frontier import frontier_section
from opsim.report.interval_picture import intervals_svg
from opsim.report.parts import part_name
from opsim.report.words import digits, half_digits, is_number, kpi_name, quantity, scale_of
from opsim.whole import write_text

HERE = Path(__file__).parent


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
        words=comparison.words,
        base=comparison.base,
        groups=groups,
        frontier=None if frontier is None else frontier_section(frontier, hours),
        style=(HERE / "report.css").read_text(encoding="utf-8"),
    )


def comparison_cells(difference: Any, largest: float | None = None) -> dict[str, str]:
    """The cells of one difference: base, variant, difference ± half-width, per cent of the base, pairing, verdict."""
    interval, unit = difference.interval, difference.key[3]
    factor, word = scale_of(unit, difference.base if largest is None else largest)
    half = interval.half_width * factor if is_number(interval.half_width) and interval.half_width else None
    of = difference.base * factor if is_number(difference.base) else 0.0
    by = digits(interval.mean * factor, half, of)
    relative = 100 * interval.mean / abs(difference.base) if difference.base else None
    share = None if relative is None or half is None else 100 * interval.half_width / abs(difference.base)
    ratio = difference.variance_ratio
    by = by if half is None else f"{by} ± {half_digits(interval.mean * factor, half, of)}"
    percent = f"{digits(relative, share, 100.0)} %" if is_number(relative) else ""
    return {
        "base": quantity_in(difference.base, factor, half),
        "mean": quantity_in(difference.mean, factor, half),
        "difference": "0" if difference.identical else by,
        "unit": word,
        "relative": "0 %" if difference.identical else percent,
        "pairing": f"{ratio:.3g}" if is_number(ratio) else "",
        "verdict": difference.verdict,
        "n": str(interval.n),
    }


def quantity_in(value: float, factor: float, half_width: float | None) -> str:
    """A mean in a unit chosen before, as exact as the difference is."""
    return digits(value * factor, half_width)


def largest_of(differences: Sequence[Any]) -> float | None:
    """The largest mean of some differences, which chooses their common unit."""
    values = [abs(v) for d in differences for v in (d.base, d.mean) if is_number(v)]
    return max(values, default=None)


def _group(differences: Sequence[Any], hours: bool) -> dict[str, Any]:
    kpi, subject, part, unit = differences[0].key
    largest = largest_of(differences)
    factor, word = scale_of(unit, largest)
    bars = [
        (d.variant, d.interval.low * factor, d.interval.mean * factor, d.interval.high * factor, d.verdict)
        for d in differences
    ]
    return {
        "name": " · ".join(filter(None, (kpi_name(kpi, hours), subject, part_name(kpi, part)))),
        "base": quantity(differences[0].base, unit),
        "rows": [{"variant": d.variant, **comparison_cells(d, largest)} for d in differences],
        "picture": intervals_svg(bars, word),
    }
