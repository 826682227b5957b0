"""Amounts as sentences say them: three digits, as finer ones are nobody's plant."""

from __future__ import annotations

from opsim.report.words import scale_of


def rough(value: float, unit: str = "s", of: float | None = None) -> str:
    """``rough(1384)`` is ``23.1 min``. of : the amount that chooses the unit, by default the value itself"""
    factor, word = scale_of(unit, value if of is None else of)
    return f"{three_digits(value * factor)} {word}".strip()


def three_digits(value: float) -> str:
    """``9.62``, ``145``, ``1,204``."""
    return f"{value:,.0f}" if abs(value) >= 999.5 else f"{float(f'{value:.3g}'):g}"


def percent(share: float) -> str:
    """A share, in whole per cent."""
    return f"{100 * share:.0f} %"
