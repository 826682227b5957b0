"""What two figures of several variants say together: which to look at, and which are beaten."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from opsim.report.words import listing

MOST_SAID, MOST_NAMED = 6, 10


def frontier_sentences(frontier: Any) -> list[str]:
    """Sentences, the most important first. frontier : of ``opsim.study.frontier``"""
    return [
        _front([point.variant for point in frontier.points if point.on_front]),
        *_beaten(frontier),
        *_behind(frontier),
        *_absent(frontier),
        *_unknown(frontier),
        *_hours(frontier),
    ]


def _front(names: Sequence[str]) -> str:
    if not names:
        return "No variant has both figures: there is no frontier."
    if len(names) == 1:
        return f"By the means {names[0]} is the best in both figures: there is nothing to weigh up."
    return (
        f"By the means no variant beats {_some(names)}: who chooses among them gains in one figure and pays in "
        "the other."
    )


def _some(names: Sequence[str]) -> str:
    """All where they are few; else the first, and how many more."""
    more = len(names) - MOST_NAMED
    return listing(list(names) if more <= 0 else [*names[:MOST_NAMED], f"{more:,} more"])


def _beaten(frontier: Any) -> Iterator[str]:
    beaten = [point for point in frontier.points if point.clearly_behind]
    if beaten:
        yield (
            f"Clearly beaten: {_said(beaten, 'clearly_behind')}. That is, worse in both figures, or in one with the "
            f"other the same, in {frontier.n} pairs of replications (95 %, all comparisons together, Holm 1979)."
        )


def _behind(frontier: Any) -> Iterator[str]:
    unclear = [point for point in frontier.points if point.behind and not point.clearly_behind]
    if unclear:
        pairs = "one pair" if frontier.n == 1 else f"{frontier.n} pairs"
        yield (
            f"Behind by the means only: {_said(unclear, 'behind')}. In {pairs} of replications this is not told from "
            "chance in both figures."
        )


def _said(points: Sequence[Any], by: str) -> str:
    """``a by b and c; d by b``; by : which field of a point names those before it"""
    said = "; ".join(f"{point.variant} by {_some(getattr(point, by))}" for point in points[:MOST_SAID])
    return f"{said}; and {len(points) - MOST_SAID} more" if len(points) > MOST_SAID else said


def _absent(frontier: Any) -> Iterator[str]:
    """Variants without a figure, as where the effect behind it is off."""
    by_figures: dict[tuple[str, ...], list[str]] = {}
    for variant, figures in frontier.absent:
        by_figures.setdefault(figures, []).append(variant)
    for figures, variants in by_figures.items():
        yield f"Not shown, as there is no {' and no '.join(figures)} there: {listing(variants)}."


def _unknown(frontier: Any) -> Iterator[str]:
    absent = dict(frontier.absent)
    unknown = [p.variant for p in frontier.points if (p.x.n == 0 or p.y.n == 0) and p.variant not in absent]
    if unknown:
        yield f"Not shown, as a figure was observed in no replication: {listing(unknown)}."


def _hours(frontier: Any) -> Iterator[str]:
    if frontier.other_hours:
        yield (
            "The variants are open for different hours, and a figure is per scheduled hour: nothing is called clear "
            "here; look at throughput_per_calendar_h."
        )
