"""Who walks most, and which ways, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.kpi.values import SECONDS_PER_HOUR, window_length_s
from opsim.report.open_time import with_closed
from opsim.report.walked_ways import WalkedWays
from opsim.report.words import digits, is_number

Row = Mapping[str, Any]


def walk_sentences(walked: WalkedWays, plan: Any, names: Sequence[str], rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``walked_m`` of the summary, a worker each, over all replications; walked : of the first; names : of
    places"""
    an_hour = f"an hour{with_closed(plan)}"
    known = [row for row in rows if row["subject"] and is_number(row["mean"])]
    if len(known) > 1:
        hours = window_length_s(plan) / SECONDS_PER_HOUR
        most, least = (pick(known, key=lambda row: row["mean"]) for pick in (max, min))
        far = f"{_metres(most, hours)} m {an_hour}"
        yield f"{most['subject']} walks most: {far}; {_least(least, most, hours)}."
    pairs = [pair for pair in walked.by_pair() if pair[3] > 0]
    total = sum(pair[3] for pair in pairs)
    a, b, trips, metres = pairs[0]
    often = f"{trips:.0f} trips" if trips >= 9.95 else "1 trip" if trips == 1 else f"{trips:.2g} trips"
    yield (
        f"In the first replication most is walked between {names[a]} and {names[b]}: {often} and "
        f"{metres:,.0f} m {an_hour}, {100 * metres / total:.0f} % of all that people walk between places."
    )


def _least(least: Row, most: Row, hours: float) -> str:
    if least["mean"] >= most["mean"]:
        return "all walk as far"
    return (
        f"{least['subject']} least, {_metres(least, hours)}" if least["mean"] > 0 else f"{least['subject']} not at all"
    )


def _metres(row: Row, hours: float) -> str:
    """The mean, with its interval where there is one."""
    known = all(is_number(row.get(end)) for end in ("low", "high"))
    half = (row["high"] - row["low"]) / 2 / hours if known else None
    mean = digits(row["mean"] / hours, half)
    if not known:
        return mean
    low, high = (digits(max(row[end], 0.0) / hours, half) for end in ("low", "high"))
    return mean if low == high else f"{mean} ({low} to {high})"
