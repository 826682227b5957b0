"""Small floors written by hand in plain SimPy: their rows are those of both engines, to the last bit."""

import re

import numpy as np
import pytest
from plans import plan
from simpy_twins import TWINS
from simpy_twins.floor import Floor, Row

from opsim.engine.choice import FAST, SIMPY, Choice, make_ready, runner_of
from opsim.log import EventLog


def rows_of(log: EventLog) -> list[Row]:
    """All rows of a log, of any kind, as the twins write them."""

    def column(name: str) -> list:
        if name in log.names:
            return np.array([*log.names[name], ""], dtype=object)[log[name]].tolist()
        return np.nan_to_num(log[name], nan=-1.0).tolist()

    return list(map(Row, *map(column, Row._fields)))


def first_difference(found: list[Row], expected: list[Row]) -> str:
    """The first row that only one of them has, in words; nothing where both have the same rows."""
    only = sorted([(row, "only the twin has") for row in set(found) - set(expected)])
    only += sorted([(row, "only the engine has") for row in set(expected) - set(found)])
    if only:
        row, whose = min(only)
        return f"{whose} {row} ({len(only)} of {len(found)} and {len(expected)} rows differ)"
    return "" if sorted(found) == sorted(expected) else "a row stands there more often than in the other"


def whole_seconds(text: str) -> str:
    """A scenario with all its random times geometric, in whole seconds: much of it happens at one instant."""

    def of_mean(match: re.Match) -> str:
        low_s, high_s = (float(found) for found in match.groups())
        return f"dist: geometric, mean: {(low_s + high_s) / 2} s, step: 1 s"

    text = re.sub(r"dist: uniform, low: (\d+) s, high: (\d+) s", of_mean, text)
    text = re.sub(r"dist: exponential, (mean: \d+ s)", r"dist: geometric, \1, step: 1 s", text)
    return re.sub(r"poisson, every: (\d+ \w+)", r"renewal, every: {dist: geometric, mean: \1, step: 1 s}", text)


@pytest.mark.parametrize("whole", [False, True], ids=["any time", "whole seconds"])
@pytest.mark.parametrize(("seed", "replication"), [(1, 0), (2, 3)])
@pytest.mark.parametrize("engine", [SIMPY, FAST])
@pytest.mark.parametrize("name", TWINS)
def test_a_floor_by_hand_has_the_rows_of_the_engine(name, engine, seed, replication, whole):
    twin = TWINS[name]
    text = twin.text.replace("seed: 1", f"seed: {seed}")
    made = plan(whole_seconds(text) if whole else text)
    choice = Choice(engine, "as asked")
    make_ready(choice, made)
    floor = Floor(seed, replication, whole)
    twin.build(floor)
    expected = rows_of(runner_of(choice)(made, replication))
    assert first_difference(floor.run(made.horizon_s), expected) == ""
    assert len(expected) > 300
    assert set(twin.shows) <= {f"{row.kind} {row.cause}".strip() for row in expected}


def test_the_last_bit_of_one_row_is_a_difference():
    rows = [Row(2.0, 1.0, "work", job=0), Row(3.0, 2.0, "work", job=1)]
    later = [rows[0], rows[1]._replace(end_s=np.nextafter(3.0, 4.0))]
    assert first_difference(rows, rows[::-1]) == ""
    assert "only the twin has" in first_difference(rows, later)
    assert first_difference(rows, rows[:1]) and first_difference(rows[:1], rows)
    assert "more often" in first_difference([*rows, rows[0]], rows)
