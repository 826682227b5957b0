"""The variability budget: what differences between people, and those within each, cost; from variants without them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.frontier import axis_name
from opsim.report.labour_numbers import signed
from opsim.report.labour_pictures import budget_svg
from opsim.report.material import Material
from opsim.report.section import Block, Bullets, Grid, Panels, Section, Svg, Words
from opsim.report.switched_variants import FULL, switched_variants
from opsim.report.words import digits, is_number, scale_of
from opsim.results import Key, figures_of
from opsim.study.interval import CONFIDENCE, Interval, t_interval
from opsim.study.labour.budget import FigureBudget
from opsim.study.labour.sources import BETWEEN, WITHIN
from opsim.study.paired import paired

OFF = {
    "within_only": "people alike",
    "between_only": "each steady",
    "none": "both off",
    "shuffled": "bodies apart from times",
}
"""What each switch leaves on, in words."""
MEANS = {
    "within_only": "everybody has the mean time of all people",
    "between_only": "everybody always takes his own mean time",
    "none": "every time is the mean of its task",
    "shuffled": "times as they are, with the postures of other performances",
}
PARTS = {BETWEEN: "within_only", WITHIN: "between_only"}
"""By source: the switch that takes it away."""
MOST_FIGURES, MOST_PICTURES = 6, 2
Budget = tuple[Key, dict[str, np.ndarray]]
"""A figure, and by switch its value in each replication."""


def section(material: Material) -> Section | None:
    """None where no variant switches off what another has on."""
    here = material.summary["variant"]
    if len(material.siblings) < 2 or material.log is None:
        return None
    by_switch = switched_variants(material.siblings, here)
    if FULL not in by_switch or len(by_switch) < 2:
        return None
    results = [material.siblings[name] for name in by_switch.values()]
    if len({result.summary["seed"] for result in results}) > 1:
        return None
    keys = _keys(material.siblings[by_switch[FULL]].summary["kpis"])
    tables = dict(zip(by_switch, figures_of(results, {key[0] for key in keys})))
    budgets = _told([one for key in keys if (one := _values(key, tables))])
    if not budgets:
        return None
    blocks: list[Block] = [
        Bullets([_sentence(*budgets[0], switch) for switch in OFF if switch in by_switch]),
        *_waterfalls(budgets),
        _table(budgets, by_switch),
        Words(_how(material, by_switch), muted=True),
    ]
    return Section("budget", "What variability costs", blocks, "Variability")


def budget_of(key: Key, values: Mapping[str, np.ndarray]) -> FigureBudget:
    """values : by switch, (n,) the figure in n paired replications; each part is off minus as it is."""
    full = values[FULL]
    parts = {source: _difference(values[switch], full) for source, switch in PARTS.items()}
    whole = values["none"] - full
    left = whole - sum((values[switch] - full for switch in PARTS.values()), np.zeros_like(full))
    least = 1e-9 * np.abs(full).max(initial=0.0)
    left = np.where(np.abs(left) <= least, 0.0, left)
    return FigureBudget(
        key,
        t_interval(full),
        t_interval(values["none"]),
        parts,
        t_interval(left),
        _difference(values["none"], full),
        {},
    )


def _difference(off: np.ndarray, full: np.ndarray) -> Interval:
    """Of the mean of paired differences; what only rounding tells apart is 0."""
    return paired(off.tolist(), full.tolist())[0]


def _keys(rows: Sequence[Mapping[str, Any]]) -> list[Key]:
    """The figures that the scenario puts first, of the whole."""
    first = [row for row in rows if row.get("headline") and not row["subject"] and not row.get("part")]
    return [(row["kpi"], "", "", row["unit"]) for row in first][:MOST_FIGURES]


def _values(key: Key, tables: Mapping[str, Any]) -> Budget | None:
    """By switch the figure in each replication that all have; None where some variant does not have it."""
    rows = {switch: table.get(key, {}) for switch, table in tables.items()}
    shared = sorted(set.intersection(*(set(row) for row in rows.values())))
    values = {switch: np.array([row[r] for r in shared], dtype=float) for switch, row in rows.items()}
    if not shared or not all(np.isfinite(one).all() for one in values.values()):
        return None
    return key, values


def _told(budgets: Sequence[Budget]) -> list[Budget]:
    """Without figures that no switch changes, and without one that says the same as one before."""
    found: list[Budget] = []
    for key, values in budgets:
        moves = any(_difference(one, values[FULL]).mean != 0 for one in values.values())
        if moves and not any(all(np.array_equal(values[s], of[s]) for s in values) for _, of in found):
            found.append((key, values))
    return found


def _sentence(key: Key, values: Mapping[str, np.ndarray], switch: str) -> str:
    change = _difference(values[switch], values[FULL])
    factor, unit = scale_of(key[3], float(values[FULL].mean()))
    what = f"{OFF[switch][0].upper()}{OFF[switch][1:]}: {axis_name(key)}"
    if change.mean == 0 and change.sd == 0:
        return f"{what} is the same in every replication."
    said = f"{what} {_cell(change, factor)}{f' {unit}' if unit else ''}"
    sure = is_number(change.half_width) and (change.low > 0 or change.high < 0)
    return f"{said}." if sure else f"{said}, which is not told from chance."


def _waterfalls(budgets: Sequence[Budget]) -> list[Block]:
    """Where all four switches are there."""
    whole = [(key, values) for key, values in budgets if {"none", *PARTS.values()} <= values.keys()]
    drawn = []
    for key, values in whole[:MOST_PICTURES]:
        if svg := budget_svg(budget_of(key, values)):
            said = "; ".join(_sentence(key, values, switch) for switch in OFF if switch in values)
            drawn.append(Svg(svg, said, axis_name(key)))
    return [Panels(drawn, least_px=340)] if drawn else []


def _table(budgets: Sequence[Budget], by_switch: Mapping[str, str]) -> Grid:
    switches = [switch for switch in OFF if switch in by_switch]
    rows = []
    for key, values in budgets:
        factor, unit = scale_of(key[3], float(values[FULL].mean()))
        cells = [_cell(_difference(values[switch], values[FULL]), factor) for switch in switches]
        full = t_interval(values[FULL])
        mean = digits(full.mean * factor, full.half_width * factor if is_number(full.half_width) else None)
        rows.append((f"{axis_name(key)}{f', {unit}' if unit else ''}", mean, *cells))
    columns = ("Figure", "as it is", *(OFF[switch] for switch in switches))
    return Grid(columns, rows, "By how much each figure changes", folded=len(rows) > MOST_PICTURES)


def _cell(change: Interval, factor: float) -> str:
    if not is_number(change.half_width):
        return digits(change.mean * factor)
    return signed(change.mean * factor, change.half_width * factor)


def _how(material: Material, by_switch: Mapping[str, str]) -> str:
    same = "other days of these same people (staffing is fixed), not other people"
    who = "other people and other days" if material.plan.staffing == "redrawn" else same
    means = "; ".join(
        f"{OFF[switch]} is the variant {by_switch[switch]}: {MEANS[switch]}" for switch in OFF if switch in by_switch
    )
    return (
        f"Changes from {by_switch[FULL]} in pairs of replications with the same random numbers. {means[0].upper()}"
        f"{means[1:]}. ± is the {100 * CONFIDENCE:.0f} % interval of a number by itself, for {who}."
    )
