"""Pictures of a labour study: whose share of the variance is how large, and the budget as a waterfall."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from opsim.report.frontier import axis_name
from opsim.report.labour_numbers import budget_cell, figure_name
from opsim.report.labour_shapes import GAIN, LOSS, SIDE, WIDE, across, box, svg, text_at, whisker
from opsim.report.labour_words import PARTS
from opsim.report.palette import ACCENT, INK, MUTED
from opsim.report.words import digits, is_number, scale_of

ROW, FOOT, OTHER = 40, 40, "#8d99a6"
ON = {"staffing": "#ffffff", "day": "#111111", "run": "#111111", "interaction": "#111111"}
COLOURS = {"staffing": ACCENT, "day": "#E69F00", "run": "#E69F00", "interaction": "#CC79A7"}


def parts_svg(parts: Mapping[Any, Any]) -> str:
    """A bar for each figure: whose share of its variance is how large."""
    drawn, seen = [], list(dict.fromkeys(part.name for one in parts.values() for part in one.parts))
    for row, (key, one) in enumerate(parts.items()):
        y = ROW * row
        drawn.append(text_at(axis_name(key), SIDE, y + 13))
        x = float(SIDE)
        for part in one.parts:
            wide = (WIDE - 2 * SIDE) * (one.share(part.name) if one.total > 0 else 0.0)
            drawn.append(box(x, y + 18, wide, 16, COLOURS[part.name]))
            if wide > 36:
                share = f"{100 * one.share(part.name):.0f} %"
                drawn.append(text_at(share, x + wide / 2, y + 30.5, ON[part.name], "middle", 12))
            x += wide
    foot = ROW * len(parts) + 6
    for line, name in enumerate(seen):
        drawn.append(box(SIDE, foot + 18 * line, 11, 11, COLOURS[name]))
        drawn.append(text_at(PARTS[name], SIDE + 17, foot + 18 * line + 10, MUTED))
    said = "; ".join(
        f"{axis_name(key)}: " + ", ".join(f"{PARTS[p.name]} {100 * one.share(p.name):.0f} %" for p in one.parts)
        for key, one in parts.items()
        if one.total > 0
    )
    return svg(drawn, foot + 18 * len(seen) + 4, said)


def budget_svg(one: Any) -> str:
    """A waterfall: from the figure as it is, source by source, to that with all of them off; lines are intervals."""
    factor, unit = scale_of(one.key[3], one.full.mean)
    steps = [*one.parts.items(), ("what they do to each other", one.interaction)]
    if not all(is_number(of.mean) for of in (one.full, one.all_off, *(of for _, of in steps))):
        return ""
    at = one.full.mean + np.concatenate([[0.0], np.cumsum([of.mean for _, of in steps])])
    ends = [*at, *(end for of in (one.full, one.all_off) for end in (of.low, of.high))]
    ends += [*(a + of.mean + s * of.half_width for a, (_, of) in zip(at, steps) for s in (-1, 1))]
    x, axis = across(np.array(ends) * factor, ROW * (len(steps) + 2), f"{figure_name(one.key, unit)}, {unit}")
    drawn = [*axis, *_level("as it is", one.full, 0, x, factor)]
    for row, (start, (name, of)) in enumerate(zip(at, steps), 1):
        y, end = ROW * row, start + of.mean
        left, right = sorted((x(start * factor), x(end * factor)))
        sure = of.low > 0 or of.high < 0
        colour = OTHER if not sure else GAIN if of.mean > 0 else LOSS
        drawn += [
            text_at(name, SIDE, y + 14),
            text_at(budget_cell(one, of), WIDE - SIDE, y + 14, MUTED, "end"),
            box(left, y + 20, max(right - left, 1.5), 12, colour),
            whisker(x, (end - of.half_width) * factor, (end + of.half_width) * factor, y + 26),
        ]
    drawn += _level("all of them off", one.all_off, len(steps) + 1, x, factor)
    said = "; ".join(f"{name}: {budget_cell(one, of)}" for name, of in steps)
    return svg(drawn, ROW * (len(steps) + 2) + FOOT, said)


def _level(name: str, of: Any, row: int, x: Any, factor: float) -> list[str]:
    y = ROW * row
    half = of.half_width * factor
    return [
        text_at(name, SIDE, y + 14, weight="bold"),
        text_at(digits(of.mean * factor, half), WIDE - SIDE, y + 14, INK, "end", weight="bold"),
        box(x(of.mean * factor) - 2.5, y + 17, 5, 18, INK),
        whisker(x, (of.mean - of.half_width) * factor, (of.mean + of.half_width) * factor, y + 26),
    ]
