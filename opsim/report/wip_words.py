"""What the jobs inside say: how many, whether they grow, and where there is no room left."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from opsim.plan import Plan
from opsim.plan.release import SATURATED
from opsim.plan.station import STORE
from opsim.report.material import Material
from opsim.report.rough import percent, three_digits
from opsim.report.sentence import find, with_interval
from opsim.report.steps import Steps, room_of, share_full
from opsim.report.words import clock, listing

GROWS, BY = 1.25, 2.0
"""Of the second half of the window to the first, and by so many jobs: more than chance on a floor that is settled."""
FULL, EMPTY = 0.1, 0.02
"""Shares of the window in which a point is full, or a store is empty, that are worth a word."""
MOST_NAMED = 3


def wip_sentences(material: Material, inside: Steps, floor: Mapping[int, Steps]) -> list[str]:
    """How many, whether they grow, where it is full, what runs out."""
    return [_many(material, inside), *_grows(material, inside), *_full(material, floor), *_empty(material, floor)]


def _many(material: Material, inside: Steps) -> str:
    start, (low_s, high_s) = material.summary["start"], material.plan.window_s
    counted = inside.within(low_s, high_s)
    most = int(counted.level.argmax())
    if counted.level.min() == counted.level[most]:
        return f"In the first replication there are always {counted.level[most]} jobs inside."
    text = f"In the first replication between {counted.level.min()} and {counted.level[most]} jobs are inside at once, "
    text += f"most at {clock(start, float(counted.at_s[most]))}"
    row = find(material.result.summary["kpis"], "work_in_progress")
    if row is None:
        return text + "."
    mean = with_interval(row).replace(" jobs", "")
    return f"On average {mean} jobs are inside. {text}."


def _grows(material: Material, inside: Steps) -> Iterator[str]:
    low_s, high_s = material.plan.window_s
    middle_s = (low_s + high_s) / 2
    first, second = inside.within(low_s, middle_s).mean, inside.within(middle_s, high_s).mean
    if second > GROWS * first and second - first > BY:
        yield (
            f"They grow: {three_digits(first)} in the first half of what is counted, {three_digits(second)} in the "
            "second. Either more comes in than goes out, or the floor has not settled: look at the warm-up and the "
            "horizon."
        )


def _full(material: Material, floor: Mapping[int, Steps]) -> Iterator[str]:
    plan = material.plan
    fed = _always_fed(plan)
    found = [
        (share_full(steps, room_of(plan, rank), plan.window_s), plan.stations[rank].name)
        for rank, steps in floor.items()
        if math.isfinite(room_of(plan, rank)) and room_of(plan, rank) > plan.stations[rank].servers and rank not in fed
    ]
    full = sorted((share, name) for share, name in found if share >= FULL)[::-1]
    if full:
        named = [f"{name} ({percent(share)} of the time)" for share, name in full[:MOST_NAMED]]
        yield f"No room is left at {listing(named)}: what comes before has to wait."


def _always_fed(plan: Plan) -> set[int]:
    """Ranks of the first stations of what is released whenever there is room: they are full by plan."""
    made = {product for source in plan.sources if source.kind == SATURATED for product, _ in source.mix}
    steps = [plan.products[product].route[step] for product in made for _, step in plan.products[product].start]
    return {rank for operation in steps for rank in operation.stations}


def _empty(material: Material, floor: Mapping[int, Steps]) -> Iterator[str]:
    plan = material.plan
    stores = [rank for rank, station in enumerate(plan.stations) if station.kind == STORE]
    found = []
    for rank in stores:
        row = find(material.result.summary["kpis"], "stock_empty", plan.stations[rank].name)
        if row is not None and row["mean"] >= EMPTY:
            found.append(f"{plan.stations[rank].name} for {with_interval(row)}")
    if found:
        yield f"Stock runs out: of the time, {listing(found[:MOST_NAMED])}."
