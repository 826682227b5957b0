"""Small floors written by hand in plain SimPy: their rows are those of both engines, to the last bit."""

import numpy as np
import pytest
from plans import plan
from simpy_twins import TWINS
from simpy_twins.compared import first_difference, rows_of, whole_seconds
from simpy_twins.floor import Floor, Row

from opsim.engine import FAST, SIMPY
from opsim.engine.choice import Choice, make_ready, runner_of


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
