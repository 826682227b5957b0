"""What a Yamazumi says: who has most work, who is over takt, and what the whiskers do to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from opsim.report.material import Material
from opsim.report.rough import three_digits
from opsim.report.sentence import find, with_interval
from opsim.report.words import listing
from opsim.report.yamazumi_stacks import LINE, PACE, Stack

MOST_NAMED, ALIKE = 4, 0.97
SELDOM = 4.0
"""Times the time between visits where they are most frequent: a station beyond is off the beat, as rework is."""
OVER = 1.005
"""Times takt: what is nearer to it keeps it."""


def in_s(seconds: float) -> str:
    """``145 s``, in seconds whatever it is: the chart's unit."""
    return f"{three_digits(seconds)} s"


def station_sentences(material: Material, stacks: Sequence[Stack]) -> list[str]:
    """The most and the least work, and what is over takt."""
    return [_spread(material, stacks), *_against(material, stacks)]


def _spread(material: Material, stacks: Sequence[Stack]) -> str:
    often = [stack for stack in stacks if _allowed(stack) <= SELDOM * min(map(_allowed, stacks))]
    most, least = max(often, key=lambda stack: stack.work_s), min(often, key=lambda stack: stack.work_s)
    which = "all stations" if len(often) == len(stacks) else "the stations that jobs visit regularly"
    text = f"Of {which} {most.name} has the most work a visit ({in_s(most.work_s)} of each server)"
    text += f" and {least.name} the least ({in_s(least.work_s)})"
    balance = find(material.result.summary["kpis"], "line_balance_efficiency")
    return text + (f"; line balance efficiency is {with_interval(balance)}." if balance is not None else ".")


def _against(material: Material, stacks: Sequence[Stack]) -> Iterator[str]:
    """Who is over what is allowed on average, and who with one visit in ten; or what the pace is."""
    held = [stack for stack in stacks if stack.allowed_s is not None and stack.by != PACE]
    if not held:
        yield from _pace(stacks, find(material.result.summary["kpis"], "takt_s") is not None)
        return
    takt = "the takt of the line" if all(stack.by == LINE for stack in held) else "takt"
    over = [stack for stack in held if stack.work_s > OVER * _allowed(stack)]
    beside = [stack for stack in held if stack not in over and stack.total_s > OVER * _allowed(stack)]
    late = [stack for stack in held if stack not in [*over, *beside] and (stack.p90 or 0.0) > OVER * _allowed(stack)]
    if over:
        yield f"Over {takt} on average: {_named(over, lambda stack: stack.work_s)}."
    if beside:
        yield f"Over {takt} only with set-up and walking: {_named(beside, lambda stack: stack.total_s)}."
    if not over and not beside:
        full = max(held, key=lambda stack: stack.total_s / _allowed(stack))
        of = f"{in_s(full.total_s)} of {in_s(_allowed(full))}"
        yield f"On average every station keeps {takt}; the fullest is {full.name} with {of}."
    if late:
        verb = "needs" if len(late) == 1 else "need"
        names = _named(late, lambda stack: stack.p90 or 0.0)
        yield f"Within {takt} on average, yet one visit in ten {verb} more: {names} at P90."


def _pace(stacks: Sequence[Stack], timed: bool) -> Iterator[str]:
    """timed : whether some jobs come in by time, others as the floor has room"""
    paced = [stack for stack in stacks if stack.allowed_s is not None]
    if paced:
        near = max(paced, key=lambda stack: stack.work_s / _allowed(stack))
        asks = "Takt is asked for some jobs alone: others" if timed else "Nothing asks for a takt: jobs"
        yield (
            f"{asks} come in as the floor has room. The dashed line is the pace it reached; "
            f"nearest to it is {near.name}, at work {100 * near.work_s / _allowed(near):.0f} % of the time between two "
            "visits, and what is missing to 100 % was lost to waiting, blocking and stops."
        )


def person_sentences(stacks: Sequence[Stack]) -> Iterator[str]:
    """Who has most to do for a job, and who least."""
    if not stacks:
        return
    most, least = (pick(stacks, key=lambda stack: stack.total_s) for pick in (max, min))
    if least.total_s > ALIKE * most.total_s:
        yield f"For a finished job everybody works, sets up and walks about as long, {in_s(most.total_s)} at most."
        return
    yield (
        f"For a finished job {most.name} works, sets up and walks the longest ({in_s(most.total_s)}), "
        f"{least.name} the shortest ({in_s(least.total_s)})."
    )


def _allowed(stack: Stack) -> float:
    return stack.allowed_s or float("inf")


def _named(stacks: Sequence[Stack], seconds) -> str:
    """``milling (250 s of 240 s)``, those farthest over first."""
    ranked = sorted(stacks, key=lambda stack: -seconds(stack) / _allowed(stack))
    named = [f"{stack.name} ({in_s(seconds(stack))} of {in_s(_allowed(stack))})" for stack in ranked]
    more = len(named) - MOST_NAMED
    return listing([*named[:MOST_NAMED], f"{more} more"] if more > 0 else named)
