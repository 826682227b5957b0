"""Random scenarios over the whole language: every law holds, and the order of declaration decides nothing.

A block is told of by a scenario where at least 20 jobs finished, two performances ended at one instant, and the log
shows what the block does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from checked_floors import checked
from choices import Drawn, Lots
from hypothesis import given, settings
from hypothesis import strategies as st
from made_blocks import BLOCKS, floor_with

from opsim import log as kinds
from opsim.log import EventLog

MOST_BLOCKS = 7
ENOUGH = 25
SELDOM = (
    *(
        "choice",
        "choice",
        "sequence",
        "schedule",
        "at_once",
        "kanban",
        "buffer_after",
        "quality",
        "conveyor",
        "conveyor",
    ),
    *("blocking_before", "setup", "fixtures", "task_tools", "priorities"),
)


def chosen(pick) -> list[str]:
    """Three to seven blocks, those that seldom find room twice as often."""
    return list(dict.fromkeys(pick.shuffled([*BLOCKS, *SELDOM])))[: pick.whole(3, MOST_BLOCKS)]


def check(values: dict, wanted: list[str], shuffle: int) -> list[str]:
    """The blocks that a scenario tells something about, once what holds of any floor has held."""
    log, _ = checked(values, shuffle)
    return [name for name in wanted if told(name, values, log)] if is_telling(log) else []


def is_telling(log: EventLog) -> bool:
    """At least 20 jobs finished, and two performances ended at one instant."""
    whole = log.where((log["kind"] == kinds.WORK) & (log["progress_to"] == 1))
    return len(log.of(kinds.FINISH)) >= 20 and np.unique(whole["end_s"]).size < len(whole)


def _has_key(values: dict, section: str, key: str) -> bool:
    return any(key in entry for entry in values.get(section, {}).values())


def _rows(log: EventLog, kind: int, cause: int | None = None) -> bool:
    rows = log.of(kind)
    return bool(len(rows)) and (cause is None or bool(np.any(rows["cause"] == cause)))


def _caused(log: EventLog, cause: int) -> bool:
    return bool(np.any(log["cause"] == cause))


def _in_section(section: str, key: str) -> Callable[[dict, EventLog], bool]:
    return lambda values, _log: _has_key(values, section, key)


def _seen(what: Callable[..., bool], *wanted: int) -> Callable[[dict, EventLog], bool]:
    return lambda _values, log: what(log, *wanted)


TOLD: dict[str, Callable[[dict, EventLog], bool]] = {
    "choice": lambda values, _: "routing" in values.get("flow", {}),
    "passed": lambda values, _: "x0" in values["stations"],
    "schedule": lambda values, _: values.get("sources", {}).get("main", {}).get("kind") == "schedule",
    "sequence": lambda values, _: "sequence" in values.get("sources", {}).get("main", {}),
    "at_once": lambda values, _: (
        "at_once" in {**values.get("release", {}), **values.get("sources", {}).get("main", {})}
    ),
    "several_sources": lambda _, log: np.unique(log.of(kinds.FINISH)["source"]).size > 1,
    "conwip": _seen(_caused, kinds.NO_CARD),
    "kanban": _seen(_caused, kinds.NO_CARD),
    "assembly": _seen(_rows, kinds.JOIN),
    "split": _seen(_rows, kinds.SPLIT),
    "lots": _in_section("products", "lot"),
    "batch": _seen(_caused, kinds.BATCH),
    "buffer_after": _seen(_caused, kinds.AFTER),
    "blocking_before": _seen(_caused, kinds.NO_PLACE),
    "queue_rule": _in_section("stations", "dispatch"),
    "priorities": _in_section("products", "priority"),
    "setup": _seen(_rows, kinds.SETUP),
    "fixtures": _seen(_caused, kinds.NO_TOOL),
    "task_tools": _seen(_caused, kinds.NO_TOOL),
    "breakdowns": _seen(_caused, kinds.BREAKDOWN),
    "maintenance": _seen(_caused, kinds.MAINTENANCE),
    "quality": lambda _, log: _rows(log, kinds.SCRAP) or _rows(log, kinds.REWORK),
    "teams": _seen(_caused, kinds.TEAM),
    "attended": _in_section("tasks", "automatic"),
    "conveyor": lambda values, log: "belt" in values.get("conveyors", {}) and _rows(log, kinds.TRANSPORT),
    "transporter": lambda values, log: "truck" in values.get("transporters", {}) and _rows(log, kinds.TRANSPORT),
    "carrying": _seen(_rows, kinds.TRANSPORT),
}


def told(name: str, values: dict, log: EventLog) -> bool:
    """Whether a block shows in the log or, where it only says when or which, stands in the scenario."""
    return TOLD[name](values, log)


def told_by(seed: int, wanted: Callable[..., list[str]] = chosen) -> list[str]:
    pick = Lots(seed)
    blocks = wanted(pick)
    return check(floor_with(pick, blocks), blocks, seed)


@settings(max_examples=40, deadline=None)
@given(st.data(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing_with_every_block(data, shuffle):
    pick = Drawn(data.draw)
    blocks = chosen(pick)
    check(floor_with(pick, blocks), blocks, shuffle)


@pytest.mark.slow
def test_every_block_is_told_of_by_25_of_500_random_scenarios():
    seen = Counter(block for seed in range(500) for block in told_by(seed))
    assert {block: seen[block] for block in BLOCKS if seen[block] < ENOUGH} == {}


@pytest.mark.parametrize("block", list(BLOCKS))
def test_each_block_alone_keeps_the_laws(block):
    for seed in range(4):
        told_by(seed, partial(lambda name, _pick: [name], block))
