"""Why times differ: of each task how much lies between people, and how much within each; as the scenario says it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import expm1, sqrt
from typing import Any

from opsim.plan.unseen import has_body
from opsim.report.labels import shortened
from opsim.report.labour_shapes import SIDE, WIDE, box, svg, text_at
from opsim.report.material import Material
from opsim.report.palette import ACCENT, MUTED
from opsim.report.same import Same
from opsim.report.section import Block, Grid, Section, Svg, Words
from opsim.study.labour.sources import BETWEEN, LEFT, WITHIN
from opsim.variability import log_variance, within_cv

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


def section(material: Material) -> Section | None:
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


def spreads(plan: Any, variability: str) -> list[Spread]:
    """Of tasks that people do whose model says it, those that vary most first, with what the run switches off."""
    left = LEFT[variability]
    found: list[Spread] = []
    for task in plan.tasks:
        share = getattr(task.model, "between_share", None)
        if task.automatic or task.attended or share is None:
            continue
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
