"""What a labour study found, in sentences, as an engineer would say it.

What a labour study found, in tables.

The page and the screen of a labour study.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from opsim.report.numbers import ABSENT, digits, half_digits, is_number, scale_of
from opsim.report.page import StudyPage, StudySection, Table
from opsim.report.studies.labour_charts import (
    PARTS,
    PLUS_MINUS,
    bought_svg,
    budget_cell,
    budget_svg,
    capital,
    count_words,
    day_svg,
    ends,
    figure_name,
    of_mean,
    parts_svg,
    per_cent,
    plus_minus,
    share_words,
    span,
)

SHORT_DAY_H = 7.0
"""A day of fewer hours than this is no usual shift: its hours are told beside what is asked of a day."""


def answer(found: Any) -> list[str]:
    """The answer in at most eight sentences."""
    warning = [found.warning] if found.warning else []
    return [_who_or_when(found), *_loss(found), *_bought(found), *_target(found), _days(found), *warning]


def _who_or_when(found: Any) -> str:
    parts = next(iter(found.parts.values()))
    staffing, run = parts["staffing"], parts["run"]
    if staffing.truncated:
        return (
            f"There is no sign that it matters who is hired: the output moves by {of_mean(run.sd, parts.mean)} with "
            f"the luck of the day (SD), and by at most {of_mean(staffing.high_sd, parts.mean)} with the people."
        )
    of = 100 / parts.mean if parts.mean else 0.0
    share = parts.share("staffing")
    of_variance = f"; {share_words(share)} of the variance" if is_number(share) else ""
    return (
        f"Who is hired moves the output by {of_mean(staffing.sd, parts.mean)} (SD; "
        f"{span(of * staffing.low_sd, of * staffing.high_sd)} %{of_variance}), the luck of the day by "
        f"{of_mean(run.sd, parts.mean)}."
    )


def _loss(found: Any) -> Iterator[str]:
    loss = _loss_of(found)
    if loss is None:
        return
    mean, half = next(iter(found.parts.values())).mean, loss.half_width
    if loss.low <= 0 <= loss.high:
        yield f"What differences between people cost cannot be told from nothing: {plus_minus(loss)} an hour."
        return
    word = "cost" if loss.mean > 0 else "bring"
    yield (
        f"Differences between people {word} {plus_minus(loss, absolute=True)} an hour: {digits(mean, half)} come out, "
        f"and {digits(mean + loss.mean, half)} would if everybody took the mean time."
    )


def _loss_of(found: Any) -> Any:
    if found.bought is not None:
        return found.bought.loss
    of_rate = next((one for one in found.budget if one.key[0] == "throughput_per_h"), None)
    return None if of_rate is None else of_rate.parts.get("between workers")


def _bought(found: Any) -> Iterator[str]:
    if found.bought is None or found.bought.loss.low <= 0:
        return
    best = [curve for kind in ("workers", "skills") if (curve := found.bought.best(kind)) is not None]
    enough = [curve for curve in best if curve.first is not None]
    if enough:
        ways = [bought_words(curve, curve.first) + _to_be_sure(curve) for curve in enough]
        buys = "buys" if len(ways) == 1 and enough[0].first.count == 1 else "buy"
        yield f"{capital(' or '.join(ways))} {buys} it back."
    for curve in best:
        if curve.first is None:
            yield _falls_short(curve, found.bought.loss.mean)


def _falls_short(curve: Any, loss: float) -> str:
    best = max(step.gained.mean for step in curve.steps)
    most = next(step for step in curve.steps if step.gained.mean >= 0.95 * best or step.gained.mean == best)
    words, buys = capital(bought_words(curve, most)), "buy" if most.count > 1 else "buys"
    if most.gained.low <= 0:
        return f"{words} {buys} nothing back that could be told from luck."
    return f"{words} {buys} back {per_cent(100 * most.gained.mean / loss)} of it."


def _to_be_sure(curve: Any) -> str:
    """How many it takes until the interval is beyond the loss too, with all steps held together."""
    sure = next((step for step in curve.steps if step.surely), None)
    if sure is curve.first:
        return ""
    return " (perhaps)" if sure is None else f" ({count_words(sure.count)} to be sure)"


def bought_words(curve: Any, step: Any) -> str:
    """``two people more like ana``, ``one skill more``."""
    if curve.kind == "workers":
        return f"{count_words(step.count)} {'person' if step.count == 1 else 'people'} {curve.name}"
    return f"{count_words(step.count)} {'skill' if step.count == 1 else 'skills'} more"


def _target(found: Any) -> Iterator[str]:
    chance = found.day.chance
    if chance is not None:
        low, high = share_words(chance.low, ""), share_words(chance.high, "")
        reached = _reached(found.day.asked)
        yield f"{reached} with a chance of {share_words(chance.estimate)} ({low} to {high})."


def _reached(asked: Any) -> str:
    target = asked.target
    if target.a_day:
        short = f" (a day is {asked.hours:.3g} h here)" if asked.hours < SHORT_DAY_H else ""
        return f"You reach {target.bound:g} a day{short}" + (
            f", in the mean of {asked.days} days," if asked.days > 1 else ""
        )
    return f"{target.asked.name} is {'at least' if target.at_least else 'at most'} {target.bound:g}"


def _days(found: Any) -> str:
    low, middle, high = (one.estimate for one in found.day.quantiles)
    step = (high - low) / 20
    return (
        f"{_day_words(found.day)}: half of them come to {digits(middle, step)} {day_unit(found.day)} or more, one in "
        f"twenty to less than {digits(low, step)}, one in twenty to more than {digits(high, step)}."
    )


def _day_words(day: Any) -> str:
    if not day.asked.a_day:
        return f"{day.asked.name} over people and days"
    hours = f"{day.asked.hours:.3g} h"
    return f"Days of {hours}" if day.asked.days == 1 else f"Days of {hours}, each the mean of {day.asked.days}"


def day_unit(day: Any) -> str:
    """Of the figure whose distribution is told, in SI where it is a figure, as targets are written."""
    if day.asked.a_day:
        return "units"
    return "" if day.key[3] == "share" else scale_of(day.key[3], None)[1]


def bought_reading(found: Any) -> list[str]:
    """What was tried, and what was not."""
    tried = sum(len(curve.steps) for curve in found.bought.curves)
    said = ["± is the 95 % interval of each number by itself."]
    if found.bought.loss.low > 0:
        said.append(
            "'Enough' is 'yes' where the interval lies beyond the loss with all steps that were tried "
            f"({tried}) held together (Bonferroni), since the best of many is partly lucky; 'perhaps' where only the "
            "mean does."
        )
    else:
        said.append("The loss cannot be told from nothing, so no share of it and no 'enough' is told.")
    if any(curve.kind == "skills" for curve in found.bought.curves):
        said.append(
            "A chain: each in turn learns the next station of the flow, in the order of the line. He works there at "
            "the mean of his paces, with the repetitions of the least experienced there; his own stations come first."
        )
    return [*said, *found.words]


def reading(found: Any) -> list[str]:
    """How the numbers are to be read."""
    n, values = found.workforces * found.replications, found.day.values.size
    days = "the same days for all (crossed)" if found.design == "crossed" else "each with days of its own (nested)"
    rare = "What happens on few days only, such as absence, is known better from days of their own (--design nested)."
    return [
        f"{found.workforces} workforces x {found.replications} days, {days}: {n} runs a point. A workforce is other "
        "people in the same jobs; a day is other luck of times, arrivals and stops.",
        *([rare] if found.design == "crossed" else []),
        "Parts of the variance are estimated by mean squares, with intervals as in Burdick & Graybill 1992 (sections "
        "3.2, 3.3), and fewer degrees of freedom where a few workforces are far from the rest (Shoemaker 2003). An "
        "estimate below 0 is told as none to be seen.",
        "The luck of one workforce on one day cannot be had twice, so what hits some people more than others on a day "
        "counts as luck of the day.",
        "Each number of the budget is with the source off minus as it is, of the same people on the same days; the "
        "parts and what they do to each other add up to all of them. Intervals are for other people and other days.",
        "The chance of a target has Clopper and Pearson's interval for so many independent days as the runs count for: "
        f"runs of one workforce, or of one day, go together (here {values} runs count for {found.day.counts_as:.0f}). "
        "That is the least by the figure, by its rank, and by whether it meets the target.",
        *([found.warning] if found.warning else []),
    ]


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


WORKERS, SKILLS = "workers", "skills"


def labour_page(found: Any, title: str) -> StudyPage:
    """found : a LabourFound; title : the scenario's name."""
    sections = [*_variance(found), *_budget(found), *_bought_sections(found), *_day(found)]
    return StudyPage(title, "labour", answer(found), sections, reading(found))


def _variance(found: Any) -> list[StudySection]:
    """Of the page: the screen has it in the first sentence."""
    parts = next(iter(found.parts.values()))
    title = "What moves the output: of the variance, how much is whose"
    return [StudySection(title, _truncated(parts), variance_table(found), parts_svg(found.parts))]


def _truncated(parts: Any) -> list[str]:
    return [
        f"The estimate of the part '{part.name}' was below 0 ({part.estimate:.3g}) and is told as 0: no sign of it."
        for part in parts.parts
        if part.truncated
    ]


def _budget(found: Any) -> list[StudySection]:
    if not found.budget:
        return []
    title = "What each source of variability costs: switched off, minus as it is"
    made = [
        StudySection(title, table=budget_table(found), on_screen=True),
        StudySection("From the output as it is to that with all of them off", picture=budget_svg(found.budget[0])),
        StudySection("Without and with them", table=levels_table(found)),
        StudySection("What it is to switch a source off", table=off_table(found)),
    ]
    if any(one.alone for one in found.budget):
        made.insert(
            2, StudySection("Each source alone: what it changes where it is the only one", table=alone_table(found))
        )
    return made


def _bought_sections(found: Any) -> list[StudySection]:
    """The screen has the best way of each kind, the page every way."""
    if found.bought is None:
        return []
    best = tuple(curve for kind in (WORKERS, SKILLS) if (curve := found.bought.best(kind)) is not None)
    few = replace(found, bought=replace(found.bought, curves=best))
    title, every = "What buys the loss back", bought_table(found)
    return [
        StudySection(title, table=bought_table(few), on_screen=True, on_page=False),
        StudySection(f"{title}: every way that was tried", bought_reading(found), every, bought_svg(found.bought)),
    ]


def _day(found: Any) -> list[StudySection]:
    return [
        StudySection("How days come out", picture=day_svg(found.day), table=day_table(found)),
    ]
