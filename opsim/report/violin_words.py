"""What the spread of times says: which varies most, and how long the slow ones take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.report.rough import rough

Row = Mapping[str, Any]
TELLING = 20
"""Times below which a tenth of them is too few to speak of."""
MANY = 0.1
"""Jobs still inside at the end, to each that left: from here times of those that left alone mislead."""


def violin_sentences(rows: Sequence[Row], inside: int = 0, left: int = 0) -> list[str]:
    """Of the time in system, and of the work at stations.

    inside, left : jobs still inside at the end of the first replication, and those that left while it was counted
    """
    return [*_stay(rows), *_not_through(rows, inside, left), *_most_varied(rows)]


def _stay(rows: Sequence[Row]) -> Iterator[str]:
    stays = [row for row in rows if row["kpi"] == "time_in_system_s" and row["n"] >= TELLING]
    if not stays:
        return
    slow = max(stays, key=lambda row: row["quantiles"]["0.9"])
    middle, late = slow["quantiles"]["0.5"], slow["quantiles"]["0.9"]
    who = f"of {slow['subject']} " if slow["subject"] and len(stays) > 1 else ""
    often = f", {late / middle:.1f} times as long" if middle > 0 and late > 1.05 * middle else ""
    text = f"Of the jobs {who}that left, half were through within {rough(middle)}"
    yield f"{text}; one in ten took more than {rough(late)}{often}."


def _not_through(rows: Sequence[Row], inside: int, left: int) -> Iterator[str]:
    """What those that never left make of it: where they are many, times look shorter than they are."""
    if inside > MANY * left and any(row["kpi"] == "time_in_system_s" for row in rows):
        yield (
            f"At the end of the first replication {inside:,} jobs were still inside, against {left:,} that left while "
            "it was counted: with them the times in system would be longer than these."
        )


def _most_varied(rows: Sequence[Row]) -> Iterator[str]:
    works = [
        row for row in rows if row["kpi"] == "cycle_time_s" and row["n"] >= TELLING and row["quantiles"]["0.5"] > 0
    ]
    if len(works) < 2:
        return
    most = max(works, key=_spread)
    if _spread(most) > 0.02:
        low, high = (rough(most["quantiles"][q], of=most["quantiles"]["0.9"]) for q in ("0.1", "0.9"))
        yield (
            f"Of all stations the work at {most['subject']} is the least even: from {low} to {high} for eight in ten "
            "visits."
        )


def _spread(row: Row) -> float:
    """P90 less P10, as a share of the median."""
    return (row["quantiles"]["0.9"] - row["quantiles"]["0.1"]) / row["quantiles"]["0.5"]
