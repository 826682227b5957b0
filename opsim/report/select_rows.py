"""The table of a choice: who is best, by how much, who was out when and why."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.kpi.better import MORE
from opsim.report.frontier import axis_name
from opsim.report.words import digits, half_digits, is_wide, scale_of
from opsim.study.compare import paired
from opsim.study.interval import CONFIDENCE, t_interval


def columns_of(found: Any) -> tuple[str, ...]:
    """Heads of the table, with units for people."""
    head = ("variant", *(("which is",) if found.called else ()), "what became of it")
    units = [scale_in(found, column)[1] for column in range(1 + len(found.keys))]
    heads = ["mean", *(axis_name(key) for key in found.keys)]
    means = [", ".join(filter(None, pair)) for pair in zip(heads, units)]
    return (*head, means[0], "behind the best", *means[1:], "replications")


def order_of(found: Any) -> list[int]:
    """Candidates: the chosen one, then who was left, then who was out last; by their means where all else is even."""
    selection = found.selection
    out = {one.system: one.n for one in selection.out}
    sign = 1 if found.better == MORE else -1
    last = max(selection.n) + 1

    def rank(i: int) -> tuple[bool, int, float, int]:
        name = selection.systems[i]
        return name != found.winner, -out.get(name, last), -sign * selection.means[i], i

    return sorted(range(len(selection.systems)), key=rank)


def rows_of(found: Any) -> list[tuple[str, ...]]:
    """A row each, the best first."""
    selection = found.selection
    rows = []
    for i in order_of(found):
        name, of = selection.systems[i], selection.values[i][: selection.n[i]]
        halves = [t_interval(column).half_width for column in of.T]
        means = [_plus_minus(scale_in(found, c)[0], mean, halves[c]) for c, mean in enumerate(_means(found, i))]
        called = (found.called[name],) if found.called else ()
        row = (name, *called, _became(found, i), means[0], _behind(found, i), *means[1:], f"{selection.n[i]:,}")
        rows.append(row)
    return rows


def _means(found: Any, i: int) -> list[float]:
    return [found.selection.means[i], *found.selection.limited[i]]


def _plus_minus(factor: float, mean: float, half_width: float) -> str:
    half = half_width * factor if is_wide(mean, half_width) else None
    shown = digits(mean * factor, half)
    return shown if half is None else f"{shown} ± {half_digits(mean * factor, half)}"


def _behind(found: Any, i: int) -> str:
    """How far a candidate is behind the chosen one, with its interval: of pairs, or of independent means."""
    selection = found.selection
    if not found.winner or selection.systems[i] == found.winner:
        return ""
    best, factor = selection.systems.index(found.winner), scale_in(found, 0)[0]
    sign = 1 if found.better == MORE else -1
    if found.apart:
        half = welch_half_width(*(selection.values[of][: selection.n[of], 0] for of in (best, i)))
        return _plus_minus(factor, sign * (selection.means[best] - selection.means[i]), half)
    n = min(selection.n[best], selection.n[i])
    by, _, _ = paired(selection.values[best][:n, 0], selection.values[i][:n, 0])
    return "0" if by.sd == 0 and by.mean == 0 else _plus_minus(factor, sign * by.mean, by.half_width)


def welch_half_width(a: np.ndarray, b: np.ndarray, confidence: float = CONFIDENCE) -> float:
    """Of the difference of two independent means, whatever their spreads. a, b : values, two or more of each

    Source: Welch 1938, Biometrika 29:350-362; Law, Simulation Modeling and Analysis, 5th ed., section 10.2.2.
    """
    from scipy.special import stdtrit  # scipy.stats costs three times this import

    squares = np.array([of.var(ddof=1) / of.size for of in (a, b)])
    if not squares.any():
        return 0.0
    freedom = squares.sum() ** 2 / (squares[0] ** 2 / (a.size - 1) + squares[1] ** 2 / (b.size - 1))
    return float(stdtrit(freedom, (1 + confidence) / 2) * np.sqrt(squares.sum()))


def _became(found: Any, i: int) -> str:
    selection, name = found.selection, found.selection.systems[i]
    out = next((one for one in selection.out if one.system == name), None)
    if out is not None:
        by = "" if out.by == found.winner else f": behind {out.by}"
        limit = f": beyond the limit{f' on {out.limit}' if len(found.limits) > 1 else ''}"
        return f"out after {out.n}{limit if out.limit else by}"
    if name == found.winner:
        return "the best" if selection.ended != "spent" else "the best so far"
    if name in selection.tied:
        return "the same"
    if selection.needed and not found.winner:
        return f"needs {selection.needed[i]:,}"
    return "" if found.apart else "still in"


def scale_in(found: Any, column: int) -> tuple[float, str]:
    """(factor, unit for people) of the figure, or of that of a limit, the same wherever it stands."""
    selection = found.selection
    key = (found.key, *found.keys)[column]
    if selection is None:
        return scale_of(key[3], found.fresh.chosen[column].mean if found.fresh else None)
    means = selection.means if column == 0 else [of[column - 1] for of in selection.limited]
    return scale_of(key[3], max(abs(one) for one in means))
