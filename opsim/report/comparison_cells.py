"""The cells of one difference, each number as exact as its interval."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.report.words import digits, half_digits, is_number, scale_of


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
