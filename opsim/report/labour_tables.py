"""What a labour study found, in tables."""

from __future__ import annotations

import math
from typing import Any

from opsim.report.labour_numbers import (
    PLUS_MINUS,
    budget_cell,
    ends,
    figure_name,
    of_mean,
    per_cent,
    plus_minus,
    share_words,
    span,
)
from opsim.report.labour_words import PARTS, day_unit
from opsim.report.study_page import Table
from opsim.report.words import ABSENT, digits, half_digits, is_number, scale_of


def variance_table(found: Any) -> Table:
    """By figure and part: SD in its unit and of the mean, interval, share of the variance."""
    rows = []
    for key, parts in found.parts.items():
        factor, unit = scale_of(key[3], parts.mean)
        names = [part.name for part in parts.parts]
        for part in parts.parts:
            words = "none to be seen" if part.truncated else span(part.low_sd * factor, part.high_sd * factor)
            rows.append(
                (
                    figure_name(key, unit) if part.name == names[0] else "",
                    PARTS[part.name],
                    digits(part.sd * factor, (part.high_sd - part.low_sd) * factor / 2),
                    words,
                    unit,
                    of_mean(part.sd, parts.mean, sign=False),
                    ABSENT if math.isnan(parts.share(part.name)) else f"{100 * parts.share(part.name):.0f} %",
                )
            )
    return Table(("figure", "part", "SD", "95 % interval", "", "of the mean", "of the variance"), rows, 2)


def budget_table(found: Any) -> Table:
    """By source: what switching it off changes in each figure."""
    columns = ["switched off", *(_column(one) for one in found.budget)]
    rows = [
        (source.name, *(budget_cell(one, one.parts[source.name]) for one in found.budget)) for source in found.sources
    ]
    rows += [
        ("what they do to each other", *(budget_cell(one, one.interaction) for one in found.budget)),
        ("all of them", *(budget_cell(one, one.whole) for one in found.budget)),
    ]
    return Table(columns, rows, 1)


def levels_table(found: Any) -> Table:
    """Each figure as it is, and with all sources off."""
    rows = [
        ("as it is", *(_figure(one, one.full) for one in found.budget)),
        ("all of them off", *(_figure(one, one.all_off) for one in found.budget)),
    ]
    return Table(["", *(_column(one) for one in found.budget)], rows, 1)


def alone_table(found: Any) -> Table:
    """By source: what it changes where it is the only one."""
    columns = ["the only one", *(_column(one) for one in found.budget)]
    rows = [
        (source.name, *(budget_cell(one, one.alone[source.name]) for one in found.budget)) for source in found.sources
    ]
    return Table(columns, rows, 1)


def off_table(found: Any) -> Table:
    """What it is to switch each source off."""
    kept = {True: "kept", False: "other times"}
    return Table(
        ("source", "switched off", "mean times of tasks"),
        [(source.name, source.off, kept[source.keeps_mean]) for source in found.sources],
        3,
    )


def bought_table(found: Any, most: int | None = None) -> Table:
    """By way and step: gained, share of the loss, and what is left or missing.

    Where the loss cannot be told from nothing there is no share of it, and nothing is enough or not.
    """
    loss = found.bought.loss
    sure = loss.low > 0
    columns = ("bought back by", "more", "gained an hour", "of the loss", "beyond the loss", "enough")
    rows = []
    for curve in found.bought.curves[:most]:
        for step in curve.steps:
            share = 100 * step.gained.mean / loss.mean if sure else math.nan
            words = "yes" if step.surely else "perhaps" if step.enough else "no"
            rows.append(
                (
                    curve.name if step is curve.steps[0] else "",
                    f"+{step.count}",
                    plus_minus(step.gained),
                    per_cent(share),
                    plus_minus(step.beyond),
                    words,
                )
            )
    return Table(columns, rows, 1) if sure else Table(columns[:-1], [row[:-1] for row in rows], 1)


def day_table(found: Any) -> Table:
    """Quantiles with intervals, and the chance of the target."""
    rows = []
    low, _, high = found.day.quantiles
    step = (high.estimate - low.estimate) / 20
    for one in found.day.quantiles:
        rows.append((f"P{100 * one.q:.0f}", digits(one.estimate, step), ends(one.low, one.high, step)))
    if found.day.chance is not None:
        chance = found.day.chance
        name = f"chance of {found.day.asked.target.words}"
        rows.append((name, share_words(chance.estimate), f"{share_words(chance.low)} to {share_words(chance.high)}"))
    return Table(("", day_unit(found.day), "95 % interval"), rows, 1)


def _figure(one: Any, interval: Any) -> str:
    factor, _ = scale_of(one.key[3], one.full.mean)
    if not is_number(interval.mean):
        return ABSENT
    mean, half = interval.mean * factor, interval.half_width * factor
    return f"{digits(mean, half)} {PLUS_MINUS} {half_digits(mean, half)}"


def _column(one: Any) -> str:
    _, unit = scale_of(one.key[3], one.full.mean)
    name = figure_name(one.key, unit)
    return f"{name}, {unit}" if unit and unit != "jobs" else name
