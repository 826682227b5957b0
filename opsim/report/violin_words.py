"""What the spread of times says: which varies most, and how long the slow ones take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.report.rough import rough

Row = Mapping[str, Any]
TELLING = 20
"""Times below which a tenth of them is too few to speak of."""


def violin_sentences(rows: Sequence[Row]) -> list[str]:
    """Of the time in system, and of the work at stations."""
    return [*_stay(rows), *_most_varied(rows)]


def _stay(rows: Sequence[Row]) -> Iterator[str]:
    stays = [row for row in rows if row["kpi"] == "time_in_system_s" and row["n"] >= TELLING]
    if not stays:
        return
    slow = max(stays, key=lambda row: row["quantiles"]["0.9"])
    middle, late = slow["quantiles"]["0.5"], slow["quantiles"]["0.9"]
    who = f"of {slow['subject']} " if slow["subject"] and len(stays) > 1 else ""
    often = f", {late / middle:.1f} times as long" if middle > 0 and late > 1.05 * middle else ""
    text = f"Half of the jobs {who}are through within {rough(middle)}"
    yield f"{text}; one in ten takes more than {rough(late)}{often}."


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
