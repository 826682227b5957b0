"""Random floors whose stations and sources open and close: the laws hold, and the order of declaration decides nothing.

A scenario is told of where jobs stood on a closed station, and some of its work went on after closing, or was stopped.
"""

from collections import Counter

import pytest
from checked_floors import checked
from choices import Lots
from made_blocks import BLOCKS, floor_with

from opsim.log import CLOSED, OFF, SETUP, WORK

ENOUGH = 25


def with_hours(pick) -> dict:
    """A made floor of 20 minutes in which stations and sources have one to three of three windows."""
    values = floor_with(pick, pick.shuffled(list(BLOCKS))[: pick.whole(0, 5)])
    edges = sorted(pick.shuffled(range(10, 1190))[:6])
    clock = [f"06:{second // 60:02d}:{second % 60:02d}" for second in edges]
    windows = zip("abc", clock[::2], clock[1::2])
    values["shifts"] = {name: {"from": begins, "to": ends} for name, begins, ends in windows}
    for station in values["stations"].values():
        if pick.whole(0, 4) < 3:
            station |= {"shift": _some(pick), "at_close": pick.one_of(["finish", "resume"])}
    for source in [values["release"]] if "release" in values else values["sources"].values():
        if pick.whole(0, 4) < 2:
            source["shift"] = _some(pick)
    return values


def _some(pick) -> list[str] | str:
    names = pick.shuffled("abc")[: pick.whole(1, 3)]
    return names if len(names) > 1 else names[0]


def told(log, plan) -> set[str]:
    """What closing did: jobs stood, work went on after it, work was broken off at it."""
    found = {"stood"} if (log["cause"] == CLOSED).any() else set()
    at_work = log.of(WORK, SETUP)
    off = log.of(OFF)
    for station, closes_s in zip(off["station"].tolist(), off["start_s"].tolist()):
        here = at_work.where(at_work["station"] == station)
        if ((here["start_s"] < closes_s) & (here["end_s"] > closes_s)).any():
            found.add("finished")
        if ((here["end_s"] == closes_s) & (here["progress_to"] < 1)).any():
            found.add("stopped")
    return found


@pytest.mark.slow
def test_laws_hold_and_declaration_order_decides_nothing_whatever_opens_and_closes():
    seen: Counter[str] = Counter()
    for seed in range(200):
        seen.update(told(*checked(with_hours(Lots(seed)), seed + 1)))
    assert seen["stood"] >= ENOUGH and seen["finished"] >= ENOUGH and seen["stopped"] >= ENOUGH, seen


def test_a_few_of_them():
    for seed in range(200, 210):
        checked(with_hours(Lots(seed)), seed + 1)
