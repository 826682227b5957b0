"""How tired people get, and how far they learn, over all replications: what the curves of one cannot say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.report.words import digits, is_number

Row = Mapping[str, Any]
MOST_SAID = 3


def tired_over_all(rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``fatigue_most`` of the summary"""
    own = sorted(_known(rows, part=False), key=lambda row: -row["mean"])[:MOST_SAID]
    if own:
        said = "; ".join(f"{row['subject']} {_share(row)}" for row in own)
        yield f"The highest fatigue in the mean over {own[0]['n']} replications, with intervals: {said}."


def learned_over_all(rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``learned_share`` of the summary"""
    own = sorted(_known(rows, part=True), key=lambda row: -row["mean"])[:MOST_SAID]
    if own:
        said = "; ".join(f"{row['subject']}, {row['part']} {_share(row)}" for row in own)
        yield (
            "What the last repetition takes of the time of a first one, in the mean over "
            f"{own[0]['n']} replications, with intervals: {said}."
        )


def _known(rows: Sequence[Row], *, part: bool) -> list[Row]:
    """Of workers, by task or of all tasks, where there is an interval."""
    return [
        row
        for row in rows
        if row["subject"] and bool(row.get("part")) is part and is_number(row["mean"]) and is_number(row.get("low"))
    ]


def _share(row: Row) -> str:
    half = 50 * (row["high"] - row["low"])
    mean, low, high = (digits(100 * max(row[name], 0.0), half) for name in ("mean", "low", "high"))
    return f"{mean} % ({low} to {high})"
