"""The terms of a fitted response as a table: coefficients in the factors' own units."""

from __future__ import annotations

from typing import Any

from opsim.report.study_page import Table
from opsim.report.sweep_words import largest_of
from opsim.report.words import digits, half_digits, is_number, scale_of


def terms_table(found: Any) -> Table:
    """A row a term: the figure in the middle of all factors, then what a unit of each factor adds, and its square."""
    response = found.response
    factor, word = scale_of(found.key[3], largest_of(found))
    rows = []
    for place, term in enumerate(response.terms):
        per = 1.0
        for column, what in term:
            per *= response.room.half[column] ** what if what > 0 else 1.0
        value, half = (of[place] * factor / per for of in (response.coefficients, response.half_widths))
        rows.append((_name(term, found, response), _about(float(value), float(half)), _unit(term, found, word)))
    return Table(("term", "coefficient", "unit"), rows)


def _name(term: Any, found: Any, response: Any) -> str:
    if not term:
        return "in the middle of all factors"
    parts = []
    for column, what in term:
        factor = found.factors[column]
        if what < 0:
            parts.append(f"({factor.path} is {factor.words(factor.values[-what])})")
            continue
        middle = f"{response.room.centre[column]:.6g} {factor.unit}".strip()
        parts.append(f"({factor.path} − {middle}){'²' if what == 2 else ''}")
    return " × ".join(parts)


def _unit(term: Any, found: Any, word: str) -> str:
    per = [f"{found.factors[column].unit or 'unit'}{'²' if what == 2 else ''}" for column, what in term if what > 0]
    return word + (f" for each {' and '.join(per)}" if per else "")


def _about(value: float, half: float) -> str:
    """With four digits, as a slope may be small."""
    if not is_number(half) or not half:
        return _plain(value)
    if abs(value) < 0.01 or half < 0.001:
        return f"{value:.3g} ± {half:.2g}".replace("-", "\N{MINUS SIGN}")
    return f"{digits(value, half)} ± {half_digits(value, half)}"


def _plain(value: float) -> str:
    return digits(value) if abs(value) >= 0.01 else f"{value:.3g}"
