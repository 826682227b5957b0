"""What bodies went through in plain words: who, where, when, and from which region of the body it comes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.report.exposure_rows import Bar, bar_of_all, bars_by, bars_of_regions, bars_of_workers
from opsim.report.exposure_words import REGIONS
from opsim.report.sentence import find, with_interval
from opsim.report.words import digits, listing

Row = Mapping[str, Any]
MOST_NAMED = 3


def exposure_sentences(rows: Sequence[Row]) -> list[str]:
    """Sentences about RULA 5 and more, the most important first; none where nobody asked. rows : of the summary"""
    everybody, workers = bar_of_all(rows), bars_of_workers(rows)
    if everybody is None or not workers:
        return []
    if everybody.most <= 0:
        return ["Nobody was seen at RULA 5 or more."]
    return [
        *_who(workers),
        *_evenness(rows, workers),
        *_where(everybody, bars_by(rows, "exposure_by_task"), bars_by(rows, "exposure_by_station")),
        *_when(bars_by(rows, "exposure_by_hour")),
        *region_sentences(everybody, bars_of_regions(rows)),
        *_open(everybody, find(rows, "posture_measured_share")),
    ]


def _who(workers: Sequence[Bar]) -> Iterator[str]:
    worst = max(workers, key=lambda bar: (bar.five, bar.most))
    if worst.five <= 0:
        yield "Nobody is surely at RULA 5 or more."
        return
    seven = f", {digits(worst.seven, _half(worst))} of them at RULA 7" if worst.seven > 0 else ""
    yield f"{worst.subject} is exposed most: {_minutes(worst)} minutes of each hour at RULA 5 or more{seven}."
    least = min(workers, key=lambda bar: bar.five)
    if len(workers) > 1:
        same = _overlap(worst, least)
        others = f"{least.subject} has least, {_minutes(least)}"
        if least.five <= 0:
            yield f"{least.subject} has none."
        else:
            yield f"{others}: by the intervals the two are not told apart." if same else f"{others}."


def _evenness(rows: Sequence[Row], workers: Sequence[Bar]) -> Iterator[str]:
    """Of three and more: of two it is said by who has most and who has least."""
    gini = find(rows, "exposure_gini", "", "rula_from_5")
    if gini is not None and len(workers) > 2:
        yield f"How unevenly workers share it (Gini, 0: all alike, near 1: one has it all): {with_interval(gini)}."


def _where(everybody: Bar, tasks: Sequence[Bar], stations: Sequence[Bar]) -> Iterator[str]:
    found = [bar for bar in sorted(tasks, key=lambda bar: -bar.five) if bar.five > 0]
    if found and everybody.five > 0:
        named = [f"{bar.subject} {_share(bar.five, everybody.five)}" for bar in found[:MOST_NAMED]]
        yield f"Of the minutes at RULA 5 or more these tasks take: {listing(named)}."
    worst, next_ = [*sorted(stations, key=lambda bar: -bar.five), None, None][:2]
    if worst is not None and next_ is not None and worst.five > 0 and not _overlap(worst, next_):
        yield f"The station with most is {worst.subject}: {_share(worst.five, everybody.five)}."


def _when(hours: Sequence[Bar]) -> Iterator[str]:
    if len(hours) < 2 or max(bar.five for bar in hours) <= 0:
        return
    worst, least = max(hours, key=lambda bar: bar.five), min(hours, key=lambda bar: bar.five)
    if _overlap(worst, least):
        low, high = digits(least.five, 0.1), digits(worst.five, 0.1)
        yield f"By the hour it is {low} to {high} minutes: no hour is told apart from the others."
        return
    yield (
        f"The worst hour is that from {worst.subject}, with {_minutes(worst)} minutes of an hour of who is there, "
        f"breaks included; the best that from {least.subject}, with {_minutes(least)}."
    )


def region_sentences(everybody: Bar, regions: Sequence[Bar]) -> Iterator[str]:
    """From which regions of the body, and what else, the minutes of all workers at RULA 5 and at 7 come."""
    for level, words in (("five", "What brings people to RULA 5 or more"), ("seven", "What brings them to RULA 7")):
        whole = getattr(everybody, level)
        dealt = sorted(((getattr(bar, level), REGIONS[bar.subject]) for bar in regions), reverse=True)
        named = [f"{region} ({_share(part, whole)})" for part, region in dealt if whole > 0 and part >= 0.005 * whole]
        if named:
            yield f"{words}: {listing(named)}."


def _open(everybody: Bar, known: Row | None) -> Iterator[str]:
    """known : how much of the work is seen at all, where that is asked"""
    seen = 1.0 if known is None else float(known["mean"])
    of = f", of the {100 * seen:.0f} % of the work whose posture is known; of the rest nothing" if seen < 0.995 else ""
    if everybody.is_open:
        yield (
            f"All workers together: at least {digits(everybody.five)} and at most {digits(everybody.most)} minutes of "
            f"an hour{of}. What lies between hangs on what nobody said of the tasks (load, grip, force, support) or "
            "saw of the body: see the assumption sheet."
        )


def _minutes(bar: Bar) -> str:
    half = _half(bar)
    if half is None:
        return digits(bar.five)
    return f"{digits(bar.five, half)} ({digits(bar.low, half)} to {digits(bar.high, half)})"


def _half(bar: Bar) -> float | None:
    half = (bar.high - bar.low) / 2
    return half if math.isfinite(half) else None


def _share(part: float, whole: float) -> str:
    return f"{100 * part / whole:.0f} %"


def _overlap(a: Bar, b: Bar) -> bool:
    """Whether two intervals meet; as far as none is known, they do."""
    return not (a.low > b.high or b.low > a.high)
