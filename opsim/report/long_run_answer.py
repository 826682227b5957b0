"""What a long run says, as an engineer would: the figures, and whether to believe them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from opsim.report.long_run_words import NAMES, batch_words, mean_words, time_words
from opsim.report.words import listing, quantity
from opsim.study.long_run.batches import MOST_TIMES
from opsim.study.long_run.flags import AGAIN

MAIN = ("throughput_per_h", "time_in_system_s", "work_in_progress")
"""The figures of which sentences speak; the others are in the table."""
_WHY = {
    "own": "the run's own warm-up",
    "MSER-5": "by MSER-5, longer than the run's own warm-up",
    "asked": "as asked",
}


def answer(run: Any) -> list[str]:
    """Sentences, the figures first, then whether they are to be believed. run : a LongRun"""
    told = [one for one in run.series if one.name in MAIN]
    known = [one for one in told if one.batches is not None]
    if not known:
        return ["Too few jobs finish to say anything: make the run longer, with --horizon."]
    figures = [f"{NAMES[one.name]}: {_mean(one)}, from {batch_words(one)}{_after(run, one, known)}." for one in known]
    return [*figures, _verdict(list(_doubts(run, told)), list(_cares(run, told)))]


def _mean(one: Any) -> str:
    """With a warning where the interval is not to be trusted."""
    doubted = any(flag.serious for flag in one.flags)
    return f"{mean_words(one)} (± not to be trusted)" if doubted else mean_words(one)


def _after(run: Any, one: Any, known: Sequence[Any]) -> str:
    if one is not known[0] or run.left_out_s <= 0:
        return ""
    return f" after leaving out the first {time_words(run.left_out_s)} ({_WHY[run.why]})"


def _verdict(doubts: Sequence[str], cares: Sequence[str]) -> str:
    first, *others = [*doubts, *cares, ""]
    rest = "".join(f" {text[0].upper()}{text[1:]}" for text in others if text)
    if first:
        return f"{'Not believable yet' if doubts else 'Believe it with care'}: {first}{rest}"
    return (
        "Nothing speaks against it: no sign that batches are alike or that anything keeps growing, and no test finds "
        "the start in it."
    )


def _flagged(told: Sequence[Any], code: str) -> list[tuple[Any, Any]]:
    return [(one, flag) for one in told for flag in one.flags if flag.code == code]


def _doubts(run: Any, told: Sequence[Any]) -> Iterator[str]:
    for_good = _flagged(told, "unstable")
    if for_good:
        said = f"more comes than leaves, so that these keep growing: {_rates(for_good)}. No longer run helps."
        yield " ".join([said, *_full(run)])
    growing, short = _flagged(told, "growing"), _flagged(told, "too_short")
    # One figure of how long to run, for both reasons.
    longest = max([flag.by for _, flag in short] + ([AGAIN] if growing else []), default=1.0)
    horizon = f"--horizon '{_horizon(run, longest)}'"
    if growing:
        yield (
            f"within this run these keep growing: {_rates(growing)}. Either more comes than leaves, or the run is too "
            f"short to tell. Run {math.ceil(longest)} times as long: {horizon}."
        )
    if short:
        why = "; ".join(dict.fromkeys(_why_short(one) for one, _ in short))
        again = "" if growing else f" {_times(longest)} as long would do: {horizon}."
        yield f"the run is too short for {_names(short)}: {why}.{again}"
    if run.part_of_days:
        yield "the floor keeps hours, and ten whole days at least are needed, as parts of days are not alike."


def _rates(flagged: Sequence[tuple[Any, Any]]) -> str:
    return listing([f"{NAMES[one.name].lower()} ({_per_day(one, flag.by)})" for one, flag in flagged])


def _full(run: Any) -> Iterator[str]:
    """What shows, apart from the growth itself, that more comes than leaves."""
    if run.full_stations:
        yield f"Never without a job: {listing(list(run.full_stations))}."
    if run.nobody_free:
        yield "Nobody is ever free."


def _why_short(one: Any) -> str:
    if one.batches.long_enough:
        return "more than half of it is warm-up"
    if one.batches.independent:
        return "replications are independent, but each is too short to forget its start"
    return "there are not even ten independent batches"


def _cares(run: Any, told: Sequence[Any]) -> Iterator[str]:
    start = _flagged(told, "start_left")
    if start:
        said = listing([f"{NAMES[one.name].lower()} ({_by(one, flag.by)})" for one, flag in start])
        yield f"the second half is not as the first quarter in {said}: leave out more with --warm-up, or run longer."
    alike = _flagged(told, "autocorrelated")
    if alike:
        yield f"batches that follow one another are alike in {_names(alike)}, so that its ± is too narrow."
    few = _flagged(told, "few_events")
    if few:
        yield f"only {min(flag.by for _, flag in few):,.0f} jobs are counted."
    unsettled = [one for one in told if one.name != "time_in_system_s" and one.warm_up_s is None]
    doubted = any(_flagged(told, code) for code in ("unstable", "growing", "too_short"))
    if unsettled and not doubted and not run.part_of_days:
        yield f"MSER-5 finds no warm-up to believe in {listing([NAMES[one.name].lower() for one in unsettled])}."


def _names(flagged: Sequence[tuple[Any, Any]]) -> str:
    return listing([NAMES[one.name].lower() for one, _ in flagged])


def _per_day(one: Any, by: float) -> str:
    """Growth over the span of the batches, as people count it."""
    day = one.span_s >= 86_400
    rate = by / one.span_s * (86_400 if day else 3600)
    return f"+{quantity(rate, one.unit, abs(rate) / 10)} {'a day' if day else 'an hour'}"


def _by(one: Any, by: float) -> str:
    return f"{'+' if by > 0 else ''}{quantity(by, one.unit, abs(by) / 10)}"


def _times(factor: float) -> str:
    if factor >= MOST_TIMES:
        return f"At least {MOST_TIMES:.0f} times"
    return "About twice" if factor == 2 else f"About {math.ceil(factor)} times"


def _horizon(run: Any, factor: float) -> str:
    """What to ask for: the warm-up and so many times the rest, rounded up to two digits of hours."""
    hours = (run.left_out_s + factor * (run.horizon_s - run.left_out_s)) / 3600
    step = 10.0 ** max(0, math.floor(math.log10(max(hours, 1.0))) - 1)
    return f"{math.ceil(hours / step) * step:g} h"
