"""Why times differ: of each task how much lies between people, and how much within each; as the scenario says it.

Variants of one run that differ in nothing but what varies in them: in ``run: variability``.

The variability budget: what differences between people, and those within each, cost; from variants without them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import expm1, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.report.material import Material, Same
from opsim.report.numbers import digits, is_number, scale_of
from opsim.report.page import Block, Bullets, Grid, Panels, Section, Svg, Words
from opsim.report.plot.plotly import ACCENT, MUTED
from opsim.report.plot.svg_chart import shortened
from opsim.report.sections.pareto import axis_name
from opsim.report.studies.labour_charts import SIDE, WIDE, box, budget_svg, signed, svg, text_at
from opsim.results import Key, figures_of
from opsim.study.intervals import CONFIDENCE, Interval, paired, t_interval
from opsim.study.labour.budget import BETWEEN, LEFT, WITHIN, FigureBudget
from opsim.study.results_folder import RESOLVED
from opsim.subjects.tasks.warnings import has_body
from opsim.task_model import log_variance, within_cv

if TYPE_CHECKING:
    from opsim.plan import Plan

ROW, MOST_DRAWN = 36, 12
COLOURS = {BETWEEN: ACCENT, WITHIN: "#E69F00"}
ON = {BETWEEN: "#ffffff", WITHIN: "#111111"}
WORDS = {BETWEEN: "who does it", WITHIN: "the same person, another time"}


@dataclass(frozen=True, slots=True)
class Spread:
    """Of one performance of a task. cv : over the population; share : of the variance (of log time) between people

    of_moving : whether the share is that of moving time, pauses left out, as an emulator knows it
    """

    task: str
    cv: float
    share: float
    of_moving: bool = False

    @property
    def between(self) -> float:
        """Coefficient of variation of people's means."""
        return sqrt(expm1(self.share * log_variance(self.cv)))

    @property
    def within(self) -> float:
        """Coefficient of variation of one person's times."""
        return within_cv(self.cv, self.share)


def time_spread_section(material: Material) -> Section | None:
    """None where no task has times that differ between people, or where these are switched off."""
    if material.log is None or not material.plan.workers:
        return None
    found = spreads(material.plan, material.loaded.scenario.run.variability)
    if not any(one.share > 0 for one in found):
        return None
    largest = max(found, key=lambda one: one.between)
    words = (
        f"The times of {largest.task} differ most between people: their means lie about {100 * largest.between:.0f} % "
        f"(standard deviation) around that of all, the times of one and the same person by "
        f"{100 * largest.within:.0f} %."
    )
    blocks: list[Block] = [Words(words), _picture(found), _table(found), Words(_note(found), muted=True)]
    return Section("spread", "Why times differ", blocks, "Spread")


def spreads(plan: Plan, variability: str) -> list[Spread]:
    """Of tasks that people do whose model says it, those that vary most first, with what the run switches off."""
    left = LEFT[variability]
    found: list[Spread] = []
    for task in plan.tasks:
        share = getattr(task.model, "between_share", None)
        if task.automatic or task.attended or share is None or task.levels is not None:
            continue  # a task whose height changes is done as those that stand for it
        if cv := _cv(Same(task.model)):
            whole = Spread(task.name, cv, float(share), has_body(task))
            found += [one for one in (_switched(whole, left),) if one is not None]
    return sorted(found, key=lambda one: (-one.cv, one.task))


def _switched(one: Spread, left: set[str]) -> Spread | None:
    """What is left of it, None where nothing is."""
    if left == {BETWEEN, WITHIN}:
        return one
    cv, share = (one.between, 1.0) if left == {BETWEEN} else (one.within, 0.0)
    return Spread(one.task, cv, share, one.of_moving) if left and cv > 0 else None


@lru_cache(maxsize=256)
def _cv(known: Same) -> float | None:
    """Coefficient of variation over the population, where the model knows it. NOTE: 0.1 s of an emulator with pauses"""
    of_times = getattr(known.of, "duration_cv", None)
    found = of_times() if callable(of_times) else getattr(known.of, "cv", None)
    return None if found is None else float(found)


def _picture(found: list[Spread]) -> Svg:
    """A bar a task, as long as its times vary, parted by whose the variance is."""
    shown = found[:MOST_DRAWN]
    longest, drawn = max(one.cv for one in shown), []
    for row, one in enumerate(shown):
        x, y = float(SIDE), ROW * row
        drawn.append(text_at(shortened(one.task), SIDE, y + 12))
        for source, share in ((BETWEEN, one.share), (WITHIN, 1.0 - one.share)):
            wide = (WIDE - 2 * SIDE - 56) * one.cv / longest * share
            drawn.append(box(x, y + 16, wide, 14, COLOURS[source]))
            if wide > 36:
                drawn.append(text_at(f"{100 * share:.0f} %", x + wide / 2, y + 27, ON[source], "middle", 11))
            x += wide
        drawn.append(text_at(f"± {100 * one.cv:.0f} %", x + 6, y + 28, MUTED, size=12))
    said = "; ".join(f"{one.task}: ± {100 * one.cv:.0f} %, {100 * one.share:.0f} % between people" for one in shown)
    legend = [(COLOURS[source], WORDS[source]) for source in COLOURS]
    caption = "As long as the times of a task vary (standard deviation, % of the mean), parted as the variance is."
    return Svg(svg(drawn, ROW * len(shown) + 4, said), said, caption=caption, legend=legend)


def _table(found: list[Spread]) -> Grid:
    rows = [
        (
            one.task,
            f"{100 * one.cv:.0f}",
            f"{100 * one.between:.0f}",
            f"{100 * one.within:.0f}",
            f"{100 * one.share:.0f}",
        )
        for one in found
    ]
    columns = ("Task", "SD, %", "between people, %", "within each, %", "of the variance between, %")
    return Grid(columns, rows, "What the times of each task vary by", folded=True)


def _note(found: list[Spread]) -> str:
    moving = " Of emulated tasks the share is that of moving time." if any(one.of_moving for one in found) else ""
    return (
        "Of one performance, as the task's own model says it, before skills, learning and the like; standard "
        f"deviations in per cent of the mean; variances are of the logarithm of time.{moving} What this costs in "
        "output is told by 'opsim labour', or by variants that switch run.variability."
    )


FULL = "full"
_SWITCH = re.compile(r"(?<![\w.])variability: ?(full|within_only|between_only|none|shuffled),? ?")


def switched_variants(siblings: Mapping[str, Any], here: str) -> dict[str, str]:
    """Switch -> variant, of those that are else the same scenario as ``here``, none where it is not among them.

    siblings : Results by name. Raises OSError where a resolved scenario cannot be read.
    """
    if here not in siblings:
        return {}
    read = {name: _read(result) for name, result in siblings.items()}
    switch, text = read[here]
    found = {switch: here}
    for name, (other, its_text) in read.items():
        if its_text == text:
            found.setdefault(other, name)
    return found


def _read(result: Any) -> tuple[str, str]:
    """The switch of a variant, and its scenario without it, so that two can be compared."""
    text = (result.folder / RESOLVED).read_text(encoding="utf-8")
    plain = re.sub(r"\s+", " ", text)
    switches = _SWITCH.findall(plain)
    left = re.sub(r",? ?}", "}", _SWITCH.sub("", plain))
    return (switches[0] if switches else FULL), left


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


def variance_budget_section(material: Material) -> Section | None:
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
        _budget_table(budgets, by_switch),
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


def _budget_table(budgets: Sequence[Budget], by_switch: Mapping[str, str]) -> Grid:
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
