"""The page and the screen of a labour study."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from opsim.report.labour_curves import bought_svg, day_svg
from opsim.report.labour_pictures import budget_svg, parts_svg
from opsim.report.labour_tables import (
    alone_table,
    bought_table,
    budget_table,
    day_table,
    levels_table,
    off_table,
    variance_table,
)
from opsim.report.labour_words import answer, bought_reading, reading
from opsim.report.study_page import Section, StudyPage

WORKERS, SKILLS = "workers", "skills"


def labour_page(found: Any, title: str) -> StudyPage:
    """found : a LabourFound; title : the scenario's name."""
    sections = [*_variance(found), *_budget(found), *_bought(found), *_day(found)]
    return StudyPage(title, "labour", answer(found), sections, reading(found))


def _variance(found: Any) -> list[Section]:
    """Of the page: the screen has it in the first sentence."""
    parts = next(iter(found.parts.values()))
    title = "What moves the output: of the variance, how much is whose"
    return [Section(title, _truncated(parts), variance_table(found), parts_svg(found.parts))]


def _truncated(parts: Any) -> list[str]:
    return [
        f"The estimate of the part '{part.name}' was below 0 ({part.estimate:.3g}) and is told as 0: no sign of it."
        for part in parts.parts
        if part.truncated
    ]


def _budget(found: Any) -> list[Section]:
    if not found.budget:
        return []
    title = "What each source of variability costs: switched off, minus as it is"
    made = [
        Section(title, table=budget_table(found), on_screen=True),
        Section("From the output as it is to that with all of them off", picture=budget_svg(found.budget[0])),
        Section("Without and with them", table=levels_table(found)),
        Section("What it is to switch a source off", table=off_table(found)),
    ]
    if any(one.alone for one in found.budget):
        made.insert(2, Section("Each source alone: what it changes where it is the only one", table=alone_table(found)))
    return made


def _bought(found: Any) -> list[Section]:
    """The screen has the best way of each kind, the page every way."""
    if found.bought is None:
        return []
    best = tuple(curve for kind in (WORKERS, SKILLS) if (curve := found.bought.best(kind)) is not None)
    few = replace(found, bought=replace(found.bought, curves=best))
    title, every = "What buys the loss back", bought_table(found)
    return [
        Section(title, table=bought_table(few), on_screen=True, on_page=False),
        Section(f"{title}: every way that was tried", bought_reading(found), every, bought_svg(found.bought)),
    ]


def _day(found: Any) -> list[Section]:
    return [
        Section("How days come out", picture=day_svg(found.day), table=day_table(found)),
    ]
