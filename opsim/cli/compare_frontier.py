"""Two figures of every variant against each other, as ``opsim compare`` asks for them and tells them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

MOST_SHOWN = 12
_VERDICTS = {"front": "on the frontier", "behind": "behind, not clearly", "beaten": "clearly beaten"}


def frontier_asked(results: Mapping[str, Any], base: str, asked: str | None) -> Any:
    """The Frontier that ``--frontier`` or else the scenario asks for; None where neither does.

    Raises ValueError where these are not two figures, NotComparable where a figure is not there.
    """
    from opsim.cli.compare_asked import frontier_texts
    from opsim.kpi.better import read_asked
    from opsim.study.frontier import frontier_of

    texts = frontier_texts(asked)
    texts = list(results[base].summary.get("frontier", [])) if texts is None else texts
    if not texts:
        return None
    return frontier_of(results, read_asked(texts[0]), read_asked(texts[1]))


def frontier_or_why(results: Mapping[str, Any], base: str, asked: str | None, *, refuse: bool) -> tuple[Any, str]:
    """The Frontier, or None and why there is none, so that what else was found is told all the same.

    refuse : raise what ``frontier_asked`` raises
    """
    from opsim.study.compare import NotComparable

    try:
        return frontier_asked(results, base, asked), ""
    except NotComparable as error:
        if refuse:
            raise
        return None, f"no picture of two figures against each other: {error}"


def print_frontier(frontier: Any, hours: bool) -> None:
    """A row a variant, and what follows from it in sentences."""
    from opsim.cli.console import print_table, say
    from opsim.report.frontier import axis_name, kind_of
    from opsim.report.frontier_words import frontier_sentences
    from opsim.report.words import plus_minus

    names = [axis_name(key, hours) for key in (frontier.x, frontier.y)]
    largest = [max((abs(getattr(p, side).mean) for p in frontier.points), default=None) for side in "xy"]
    rows = [
        (
            point.variant,
            *(
                plus_minus({"mean": one.mean, "half_width": one.half_width, "unit": key[3]}, most)
                for one, key, most in zip((point.x, point.y), (frontier.x, frontier.y), largest)
            ),
            _VERDICTS[kind_of(point)] if point.x.n and point.y.n else "not shown",
        )
        for point in _shown(frontier.points)
    ]
    print_table("Two figures against each other", ("variant", *names, "verdict"), rows, words=1)
    ways = zip(names, (frontier.better_x, frontier.better_y))
    better = "; ".join(f"{name}: {way} is better" for name, way in ways)
    others = len(frontier.points) - len(rows)
    left_out = [f"{others:,} more variants are in the page."] if others else []
    for sentence in (*left_out, f"{better}.", *frontier_sentences(frontier)):
        say(sentence)


def _shown(points: Any) -> list[Any]:
    """All where they fit a screen, else the first of those on the frontier."""
    return list(points) if len(points) <= MOST_SHOWN else [point for point in points if point.on_front][:MOST_SHOWN]


def frontier_json(frontier: Any) -> dict[str, Any]:
    """For machines."""
    axes = {
        side: {**dict(zip(("kpi", "subject", "part", "unit"), getattr(frontier, side))), "better": better}
        for side, better in (("x", frontier.better_x), ("y", frontier.better_y))
    }
    return {**axes, "pairs": frontier.n, "variants": [_point(point) for point in frontier.points]}


def _point(point: Any) -> dict[str, Any]:
    numbers = {
        side: {name: getattr(getattr(point, side), name) for name in ("mean", "low", "high", "half_width", "n")}
        for side in ("x", "y")
    }
    behind = {"behind": list(point.behind), "clearly_behind": list(point.clearly_behind)}
    return {"variant": point.variant, **numbers, "on_front": point.on_front, **behind}
