"""Random scenarios over everything that people may do: every law holds, and the order of declaration decides nothing.

Each has shifts and breaks, some blocks about people and some about material and stations. A rule of interruption is
contested where a log shows what it does and the others would not; any other block where the log would be another
without it, or shows what only it does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection
from functools import partial

import pytest
from checked_floors import checked
from choices import Drawn, Lots
from contests import CONTESTED, contested, met_at_work
from hypothesis import given, settings
from hypothesis import strategies as st
from made_blocks import BLOCKS
from made_crews import CREWS
from made_people_blocks import ALWAYS, PEOPLE, people_floor_with
from naive_people import jumps, unjoined
from shown_blocks import shown

from opsim.log import EventLog
from opsim.plan import Plan

ENOUGH = 25
AT_LEAST = 2
"""Interruptions in each scenario that counts."""
SELDOM = ("zones", "zones", "zones", "choice_of_work", "overtime", "overtime", "floaters", "station_priorities")
"""Blocks that seldom matter, by how many times more they are chosen."""


def chosen(pick) -> list[str]:
    """Two to five blocks about people, those that seldom matter more often, and up to three others."""
    of_people = [name for name in (*PEOPLE, *CREWS, *SELDOM) if name not in ALWAYS]
    mine = list(dict.fromkeys(pick.shuffled(of_people)))[: pick.whole(2, 5)]
    return [*ALWAYS, *mine, *pick.shuffled(list(BLOCKS))[: pick.whole(0, 3)]]


def check(values: dict, shuffle: int) -> tuple[EventLog, Plan]:
    """The log of a scenario, once what holds of any floor has held, and what was written to be read of people."""
    log, plan = checked(values, shuffle)
    assert list(jumps(log, plan)) == []
    assert list(unjoined(log)) == []
    return log, plan


def shown_by(seed: int, wanted: Callable[..., list[str]] = chosen, enough: Collection[str] = ()) -> list[str] | None:
    """The rules and blocks that a scenario contests, but for those that are told of often enough; None where fewer than
    two interruptions are in it.
    """
    pick = Lots(seed)
    blocks = wanted(pick)
    values = people_floor_with(pick, blocks)
    log, p = check(values, seed)
    mets = met_at_work(log, p)
    if len(mets) < AT_LEAST:
        return None
    asked = [name for name in dict.fromkeys(blocks) if name not in BLOCKS and name not in enough]
    return [*contested(mets), *(name for name in asked if shown(name, values, log, p))]


@settings(max_examples=15, deadline=None)
@given(st.data(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing_with_people_and_everything_else(data, shuffle):
    pick = Drawn(data.draw)
    check(people_floor_with(pick, chosen(pick)), shuffle)


@pytest.mark.slow
def test_every_rule_is_contested_by_25_of_500_random_scenarios_with_two_interruptions_each():
    seen, n, seed = Counter[str](), 0, 0
    while n < 500 and seed < 800:
        found = shown_by(seed, enough=[name for name in seen if seen[name] >= ENOUGH])
        seed += 1
        if found is not None:
            n += 1
            seen.update(set(found))
    assert n == 500
    assert {name: seen[name] for name in (*CONTESTED, *PEOPLE, *CREWS) if seen[name] < ENOUGH} == {}


@pytest.mark.parametrize("block", [name for name in (*PEOPLE, *CREWS) if name not in ALWAYS])
def test_each_block_alone_keeps_the_laws(block):
    for seed in range(3):
        shown_by(seed, partial(lambda name, _pick: [*ALWAYS, name], block))
