"""Which factor matters, alone and with others: a section of a sweep's page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.report.frontier import axis_name
from opsim.report.study_page import Section, Table
from opsim.report.sweep_bars import MORRIS_LEGEND, SOBOL_LEGEND, sensitivity_svg
from opsim.report.sweep_words import largest_of
from opsim.report.words import digits, half_digits, is_number, scale_of


def sensitivity_section(found: Any, design: str, on_screen: bool) -> Section:
    """found : a Found of a design for Sobol indices or of Morris."""
    title = f"{axis_name(found.key)}: which factor matters"
    pairs = sorted(zip(found.factors, found.sensitivity), key=lambda pair: -pair[1].total)
    if design == "morris":
        return _morris(title, found, pairs, on_screen)
    rows = [
        (f.path, _about(100 * s.alone, 100 * s.alone_half), _about(100 * s.total, 100 * s.total_half)) for f, s in pairs
    ]
    said = (
        "Share of the figure's variance over the ranges. 'Alone' adds up to 100 % where no two factors act together; "
        "where 'alone and with others' is near 0 the factor may be left as it is."
    )
    picture = sensitivity_svg(found.factors, found.sensitivity, 100.0, "share of the variance, %")
    table = Table(("factor", "alone, %", "alone and with others, %"), rows)
    return Section(title, [said], table, picture, SOBOL_LEGEND, on_screen)


def _morris(title: str, found: Any, pairs: Sequence[tuple[Any, Any]], on_screen: bool) -> Section:
    factor, word = scale_of(found.key[3], largest_of(found))
    rows = [
        (
            f.path,
            _about(s.total * factor, s.total_half * factor),
            _about(s.alone * factor, s.alone_half * factor),
            digits(s.spread * factor),
        )
        for f, s in pairs
    ]
    said = (
        "Change of the figure when one factor goes over its whole range (of values without order: from one to "
        "another). A size above the change with its sign, or a large spread, says that the effect is "
        "bent or depends on other factors."
    )
    picture = sensitivity_svg(found.factors, found.sensitivity, factor, f"change over the whole range, {word}")
    table = Table(("factor", f"size of the change, {word}", f"with its sign, {word}", "spread"), rows)
    return Section(title, [said], table, picture, MORRIS_LEGEND, on_screen)


def _about(value: float, half: float) -> str:
    return f"{digits(value, half)} ± {half_digits(value, half)}" if is_number(half) and half else digits(value)
