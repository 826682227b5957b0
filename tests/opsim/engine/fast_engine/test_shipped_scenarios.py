"""The fast engine writes the log of the SimPy engine of every shipped scenario, in every variant, to its horizon.

Two replications: the second is run on the floor that the first one leaves.
"""

import pytest
from engine_evidence.rows import first_difference

from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor import run_plan as run_simpy
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder

FILES = sorted(shipped_folder().glob("*.yaml"))
EACH = pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)


def difference(plan):
    """The first row that differs: on a new floor, or on one that has drawn most of its numbers ahead."""
    wanted, new = run_simpy(plan), run_fast(plan)
    return first_difference(wanted, new) or first_difference(wanted, run_fast(plan))


def plans(path):
    return {name: compile_plan(loaded) for name, loaded in scenarios_in(path.read_bytes(), path).items()}


@EACH
def test_every_variant_of_a_shipped_scenario_has_one_log(path):
    found = {name: difference(plan) for name, plan in plans(path).items()}
    assert found == dict.fromkeys(found, "")


@pytest.mark.slow
@EACH
def test_the_second_replication_has_one_log_too(path):
    for name, plan in plans(path).items():
        run_fast(plan)
        assert (name, first_difference(run_simpy(plan, 1), run_fast(plan, 1))) == (name, "")
