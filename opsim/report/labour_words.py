"""What a labour study found, in sentences, as an engineer would say it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.report.labour_numbers import capital, count_words, of_mean, per_cent, plus_minus, share_words, span
from opsim.report.words import digits, is_number, scale_of

SHORT_DAY_H = 7.0
"""A day of fewer hours than this is no usual shift: its hours are told beside what is asked of a day."""
PARTS = {
    "staffing": "who is hired",
    "day": "luck of the day, for all alike",
    "interaction": "luck of the day, for some more than others",
    "run": "luck of the day",
}


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
