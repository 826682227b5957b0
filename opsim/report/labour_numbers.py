"""Numbers of a labour study as people read them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from opsim.report.frontier import axis_name
from opsim.report.words import ABSENT, digits, half_digits, is_number, scale_of

MINUS, PLUS_MINUS = "\N{MINUS SIGN}", "\N{PLUS-MINUS SIGN}"
FROM_0_TO_1 = ", from 0 (fresh) to 1"
LEAST = 0.005
"""Per cent that are told as 0."""
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")


def figure_name(key: Sequence[str], unit: str) -> str:
    """A figure in words beside numbers in ``unit``: one in per cent does not say that it goes from 0 to 1."""
    name = axis_name(key)
    return name.replace(FROM_0_TO_1, "") if unit == "%" else name


def budget_cell(one: Any, interval: Any) -> str:
    """``+3.2 ± 0.4``; a dash where it is not known."""
    factor, _ = scale_of(one.key[3], one.full.mean)
    if not is_number(interval.mean):
        return ABSENT
    return signed(interval.mean * factor, interval.half_width * factor)


def signed(mean: float, half: float) -> str:
    if mean == 0 and half == 0:
        return "0"
    text = digits(mean, half)
    sign = "" if text.startswith(MINUS) or float(text.replace(",", "")) == 0 else "+"
    return f"{sign}{text} {PLUS_MINUS} {half_digits(mean, half)}"


def plus_minus(interval: Any, absolute: bool = False) -> str:
    if absolute:
        return (
            f"{digits(abs(interval.mean), interval.half_width)} {PLUS_MINUS} "
            f"{half_digits(interval.mean, interval.half_width)}"
        )
    return signed(interval.mean, interval.half_width)


def of_mean(sd: float, mean: float, sign: bool = True) -> str:
    share = 100 * sd / abs(mean) if mean else math.nan
    if not is_number(share):
        return ABSENT
    share = 0.0 if share < LEAST else share
    return f"{PLUS_MINUS + ' ' if sign else ''}{share:.2g} %" if share < 99.5 else f"{share:.0f} %"


def per_cent(share: float) -> str:
    return f"{share:.0f} %".replace("-", MINUS) if is_number(share) else ABSENT


def span(low: float, high: float) -> str:
    step = max(high - low, 1e-12) / 2
    return f"{digits(low, step)} to {digits(high, step)}"


def ends(low: float, high: float, step: float) -> str:
    if not is_number(low) and not is_number(high):
        return "too few runs"
    if not is_number(low):
        return f"at most {digits(high, step)}"
    return f"at least {digits(low, step)}" if not is_number(high) else f"{digits(low, step)} to {digits(high, step)}"


def share_words(share: float, unit: str = " %") -> str:
    return f"{100 * share:.0f}{unit}"


def count_words(n: int) -> str:
    return _COUNTS[n] if n < len(_COUNTS) else str(n)


def capital(text: str) -> str:
    return text[:1].upper() + text[1:]
