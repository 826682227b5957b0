"""Random scenarios over everything that people may do: every law holds, and the order of declaration decides nothing.

Each has shifts and breaks, some blocks about people and some about material and stations. A rule of interruption is
contested where a log shows what it does and the others would not; any other block where the log would be another
without it, or shows what only it does.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection
from copy import deepcopy
from functools import partial
from random import Random

import numpy as np
import pytest
from choices import Drawn, Lots
from contests import CONTESTED, contested, met_at_work, stays_on
from hypothesis import given, settings
from hypothesis import strategies as st
from made_blocks import BLOCKS
from made_crews import CREWS
from made_floors import FOLDER, text_of
from made_people_blocks import ALWAYS, PEOPLE, people_floor_with
from naive_people import jumps, unjoined

from opsim import log as kinds
from opsim.engine.simpy_engine import run_plan
from opsim.kpi import figures
from opsim.kpi.locked import locked
from opsim.laws import CHECKS, audit
from opsim.log import COLUMNS, EventLog
from opsim.plan import Plan, compile_plan
from opsim.scenario.read import Loaded, scenarios_in
from opsim.scenario.risks import risks_of

LOCKS = re.compile(r"nothing moves any more|for ever|never fills|cannot be finished")
"""What ``opsim check`` says of a floor that may lock itself."""
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


def _loaded(text: str) -> Loaded:
    return scenarios_in(text.encode(), FOLDER / "made.yaml")["base"]


def _plan(text: str) -> Plan:
    return compile_plan(_loaded(text))


def _differ(a: EventLog, b: EventLog) -> list[str]:
    if len(a) != len(b):
        return ["rows"]
    return [c for c in COLUMNS if not np.array_equal(a[c], b[c], equal_nan=a[c].dtype.kind == "f")]


def check(values: dict, shuffle: int) -> tuple[EventLog, Plan]:
    """The log of a scenario, once its laws hold and its order has decided nothing."""
    loaded = _loaded(text_of(values))
    p = compile_plan(loaded)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert list(jumps(log, p)) == []
    assert list(unjoined(log)) == []
    assert [f for f in figures(log, p) if f.value < -1e-9] == []
    again = run_plan(_plan(text_of(values, Random(shuffle))))
    assert again.names == log.names
    assert _differ(log, again) == [], "the order of declaration decides something"
    lock = locked(log, p)
    assert lock is None or any(LOCKS.search(risk) for risk in risks_of(loaded.scenario)), lock
    return log, p


def _without(section: str, key: str) -> Callable[[dict], dict]:
    """The scenario without a key in each entry of a section, or in the section itself."""

    def strip(values: dict) -> dict:
        found = deepcopy(values)
        for entry in (found.get(section, {}), *found.get(section, {}).values()):
            if isinstance(entry, dict):
                entry.pop(key, None)
        return found

    return strip


def _all_good(values: dict) -> dict:
    """The scenario with the pace of skills alone."""
    found = deepcopy(values)
    found["skill_levels"]["learner"].pop("quality")
    for worker in found["workers"].values():
        for station, level in worker["skills"].items():
            worker["skills"][station] = level["pace"] if isinstance(level, dict) else level
    return found


WITHOUT: dict[str, Callable[[dict], dict]] = {
    "choice_of_work": _without("allocation", "rule"),
    "levels": _all_good,
    "zones": _without("workers", "zone"),
    "floaters": _without("workers", "floater"),
    "station_priorities": _without("stations", "priority"),
    "limited": _without("allocation", "serve"),
    "work_sharing": _without("stations", "share"),
    "task_rules": _without("tasks", "interruption"),
    "station_hours": _without("stations", "shift"),
    "source_hours": lambda values: _without("release", "shift")(_without("sources", "shift")(values)),
}
"""Blocks that are contested where the log is another one without them."""


def _caused(*causes: int) -> Callable[[EventLog, Plan], bool]:
    return lambda log, _plan: bool(np.any(np.isin(log["cause"], causes)))


def _of(kind: int) -> Callable[[EventLog, Plan], bool]:
    return lambda log, _plan: bool(len(log.of(kind)))


SEEN: dict[str, Callable[[EventLog, Plan], bool]] = {
    "shifts": _of(kinds.OFF),
    "breaks": _of(kinds.BREAK),
    "meetings": _caused(kinds.MEETING),
    "absence": _of(kinds.ABSENT),
    "overtime": stays_on,
    "brigade": _caused(kinds.BEHIND),
    "rabbits": _caused(kinds.BEHIND),
    "indexed_line": _caused(kinds.TAKT, kinds.LINE_STOP, kinds.UNFINISHED),
    "moving_line": _caused(kinds.TAKT, kinds.LINE_STOP, kinds.UNFINISHED),
    "rotation": lambda log, plan: all(_posts_seen(log, turns) for turns in plan.rotations) and bool(plan.rotations),
}
"""Blocks that are contested where the log shows what only they do."""


def _posts_seen(log: EventLog, turns) -> bool:
    """Whether one of those who rotate has worked at two posts."""
    rows = log.of(kinds.WORK)
    posts = [
        {post for post, at in enumerate(turns.posts) if np.any(np.isin(_stations(rows, w), at))} for w in turns.workers
    ]
    return max(map(len, posts)) > 1


def _stations(rows: EventLog, worker: int) -> np.ndarray:
    return rows["station"][rows["worker"] == worker]


def shown(name: str, values: dict, log: EventLog, p: Plan) -> bool:
    """Whether a block about people is contested in a scenario."""
    if name in SEEN:
        return SEEN[name](log, p)
    stripped = WITHOUT[name](values)
    return stripped != values and _differ(log, run_plan(_plan(text_of(stripped)))) != []


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
