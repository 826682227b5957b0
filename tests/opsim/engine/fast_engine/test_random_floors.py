"""The fast engine writes the log of the SimPy engine, to the last bit, on random floors over the whole vocabulary.

``python -m engine_evidence.equality`` compares all 1,000; here is a sample that together uses every block, and a
deterministic part of the others in the slow tests.
"""

import pytest
from checked_floors import plan_of
from engine_evidence.floors import N_FLOORS, floor_text, replication_of
from engine_evidence.rows import first_difference
from engine_evidence.sample import SAMPLE

from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor import run_plan as run_simpy

EVERY = 4
"""Of the others, one of so many is run here."""
PARTS = 4


def difference(number):
    """The first row that differs, in words; nothing where the logs are equal: on a new floor, and on one that has drawn
    most of its numbers ahead."""
    plan, replication = plan_of(floor_text(number)), replication_of(number)
    wanted, new = run_simpy(plan, replication), run_fast(plan, replication)
    run_fast(plan, replication + 1)
    return first_difference(wanted, new) or first_difference(wanted, run_fast(plan, replication))


@pytest.mark.parametrize("number", SAMPLE)
def test_a_floor_of_the_sample_has_one_log(number):
    assert difference(number) == ""


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_many_random_floors_have_one_log(part):
    numbers = [number for number in range(0, N_FLOORS, EVERY) if number not in SAMPLE][part::PARTS]
    assert {number: words for number in numbers if (words := difference(number))} == {}
