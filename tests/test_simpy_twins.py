"""Small floors written by hand in plain SimPy: their rows are those of both engines, to the last bit."""

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


@pytest.mark.parametrize(("seed", "replication"), [(1, 0), (2, 3)])
@pytest.mark.parametrize("engine", [SIMPY, FAST])
@pytest.mark.parametrize("name", TWINS)
def test_a_floor_by_hand_has_the_rows_of_the_engine(name, engine, seed, replication):
    twin = TWINS[name]
    made = plan(twin.text.replace("seed: 1", f"seed: {seed}"))
    choice = Choice(engine, "as asked")
    make_ready(choice, made)
    floor = Floor(seed, replication)
    twin.build(floor)
    expected = rows_of(runner_of(choice)(made, replication))
    assert first_difference(floor.run(made.horizon_s), expected) == ""
    assert len(expected) > 300
    assert set(twin.shows) <= {f"{row.kind} {row.cause}".strip() for row in expected}
