"""Spaghetti: the ways that people walked, drawn on the floor as thick as they were walked often; all, and of each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.report.floor_drawn import picture
from opsim.report.floor_map import SMALL, WIDE, FloorMap, floor_map, names_of
from opsim.report.floor_ways import FloorWays
from opsim.report.material import Material
from opsim.report.open_time import with_closed
from opsim.report.section import Block, Grid, Panels, Section, Svg, Words
from opsim.report.strands import (
    THICKEST,
    Strand,
    Thickness,
    WalkedFloor,
    count,
    drawn_lines,
    drawn_numbers,
    strands_of,
    thickness_key,
    thickness_of,
    trips_of,
)
from opsim.report.walk_words import walk_sentences
from opsim.report.walked_ways import WalkedWays, walked_ways

SMALLER = 0.55
"""How much thinner lines are in small pictures."""
MOST_LINES, OWN_LINES, LABELLED = 40, 16, 6
"""Lines drawn, and of one worker; lines with their number."""
MOST_WORKERS, MOST_ROWS, MOST_NAMED = 6, 12, 7
"""Workers with a picture of their own, rows of the table, names in a small picture."""
HOW = {
    "rectilinear": "Ways go along the axes, nobody said round which corner; lines lie a little beside each other.",
    "euclidean": "Ways are straight.",
    "paths": "Trips add up on each stretch of a path.",
}


def section(material: Material) -> Section | None:
    """None where no rows are kept, nobody goes anywhere, or all places are one."""
    if material.log is None or not material.plan.workers:
        return None
    layout, plan = material.loaded.scenario.layout, material.plan
    large, small = (floor_map(plan, layout, wide) for wide in (WIDE, SMALL))
    walked = walked_ways(material.log, plan)
    if large is None or small is None or not any(trips > 0 for *_, trips, _ in walked.by_pair()):
        return None
    names = names_of(large, plan, layout)
    floor = WalkedFloor(plan.places, dict(zip(plan.places, names)), FloorWays(layout))
    blocks: list[Block] = [*map(Words, walk_sentences(walked, plan, names, material.rows("walked_m")))]
    blocks.append(together(walked, floor, large, with_closed(plan)))
    if len(walked.by_pair()) > 1:
        blocks += own_pictures(walked, [worker.name for worker in plan.workers], floor, small)
    return Section("ways", "Ways that people walk", [*blocks, _table(walked, plan, names)], "Ways")


def together(walked: WalkedWays, floor: WalkedFloor, on: FloorMap, hours: str = "") -> Svg:
    """The picture of everybody's ways. hours : which ones are meant by 'an hour', in words"""
    trips = trips_of(walked.by_pair(), floor, MOST_LINES)
    thickness = thickness_of([often for often, *_ in trips])
    strands = strands_of(trips, floor, on, thickness)
    drawn = [*drawn_lines(strands, thickness), *drawn_numbers(strands[:LABELLED], on.taken)]
    said = f"The ways walked most: {'; '.join(one.words for one in strands[:LABELLED])}"
    caption = _caption(len(strands), on, floor.ways.distance, hours)
    return Svg(picture(on, drawn, said, thickness_key(thickness, on)), said, caption=caption, wide=True)


def own_pictures(walked: WalkedWays, workers: Sequence[str], floor: WalkedFloor, small: FloorMap) -> list[Block]:
    """A small picture of each worker, those who walk most; none where only one walks. small : the floor for them"""
    metres = walked.by_worker(len(workers))
    first = sorted(range(len(workers)), key=lambda rank: (-metres[rank], rank))[:MOST_WORKERS]
    own = {rank: walked.where(walked.worker == rank).by_pair() for rank in sorted(first)}
    trips = {rank: found for rank, pairs in own.items() if (found := trips_of(pairs, floor, OWN_LINES))}
    if len(trips) < 2:
        return []
    thickness = Thickness(max(found[0][0] for found in trips.values()), SMALLER * THICKEST)
    of = "who walk most" if np.count_nonzero(metres) > len(trips) else "who walk"
    note = f"Those {of}; all to one scale, with the names of the places where each goes most."
    shown = [
        _own(
            f"{workers[rank]}, {metres[rank]:,.0f} m an hour",
            strands_of(found, floor, small, thickness),
            thickness,
            floor,
            small,
        )
        for rank, found in trips.items()
    ]
    return [Panels(shown), Words(note)]


def _own(title: str, strands: Sequence[Strand], thickness: Thickness, floor: WalkedFloor, on: FloorMap) -> Svg:
    said = f"{title}; {'; '.join(one.words for one in strands[:3])}"
    names = dict.fromkeys(place for one in strands for place in (one.a, one.b))
    named = on.naming(floor.ways.places[place] for place in list(names)[:MOST_NAMED])
    return Svg(picture(named, drawn_lines(strands, thickness), said, thickness_key(thickness, on)), said, title)


def _caption(lines: int, on: FloorMap, distance: str, hours: str) -> str:
    few = f" The {MOST_LINES} walked most are drawn." if lines == MOST_LINES else ""
    key = f" Places: {on.key}." if on.numbered else ""
    return (
        "In the first replication, both ways together: a line is as thick as it is walked often, and the numbers are "
        f"trips an hour{hours}. {HOW[distance]}{few}{key}"
    )


def _table(walked: WalkedWays, plan: Any, names: Sequence[str]) -> Grid:
    pairs = walked.by_pair()
    rows = [
        (
            f"{names[a]} – {names[b]}",
            _by_whom(walked, a, b, plan),
            count(trips),
            f"{plan.distance_m[a][b]:.1f}",
            f"{metres:,.0f}",
        )
        for a, b, trips, metres in pairs[:MOST_ROWS]
    ]
    left = len(pairs) - len(rows)
    title = "The ways walked most" + (f"; {left} more are walked less" if left else "")
    return Grid(("Between", "Mostly by", "trips an hour", "m each", "m an hour"), rows, title, words=2, folded=True)


def _by_whom(walked: WalkedWays, a: int, b: int, plan: Any) -> str:
    """The one who goes most there, and how much of it is his."""
    rank, share = next(walked.shares(a, b))
    return plan.workers[rank].name + ("" if share > 0.995 else f" ({100 * share:.0f} %)")
