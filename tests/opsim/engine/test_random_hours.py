"""Random floors whose stations and sources open and close: the laws hold, and the order of declaration decides nothing.

A scenario is told of where jobs stood on a closed station, and some of its work went on after closing, or was stopped.
"""

import re
from collections import Counter
from random import Random

import numpy as np
import pytest
from choices import Lots
from made_blocks import BLOCKS, floor_with
from made_floors import FOLDER, text_of

from opsim.engine.simpy_engine import run_plan
from opsim.kpi import figures
from opsim.kpi.locked import locked
from opsim.laws import CHECKS, audit
from opsim.log import CLOSED, COLUMNS, OFF, SETUP, WORK
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.scenario.risks import risks_of

LOCKS = re.compile(r"nothing moves any more|for ever|never fills")
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


def _read(text: str):
    return scenarios_in(text.encode(), FOLDER / "made.yaml")["base"]


def check(values: dict, shuffle: int):
    """The log and the plan of a scenario, once laws hold, order decides nothing and locks are foretold."""
    loaded = _read(text_of(values))
    plan = compile_plan(loaded)
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    assert [figure for figure in figures(log, plan) if figure.value < -1e-9] == []
    again = run_plan(compile_plan(_read(text_of(values, Random(shuffle)))))
    assert len(again) == len(log)
    for name in COLUMNS:
        assert np.array_equal(log[name], again[name], equal_nan=log[name].dtype.kind == "f"), name
    assert locked(log, plan) is None or any(LOCKS.search(risk) for risk in risks_of(loaded.scenario))
    return log, plan


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
        seen.update(told(*check(with_hours(Lots(seed)), seed + 1)))
    assert seen["stood"] >= ENOUGH and seen["finished"] >= ENOUGH and seen["stopped"] >= ENOUGH, seen


def test_a_few_of_them():
    for seed in range(200, 210):
        check(with_hours(Lots(seed)), seed + 1)
