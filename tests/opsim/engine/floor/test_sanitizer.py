"""The sanitizer: a fault that compiled code does not see is refused where it happens; sound rules write their rows."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from checked_floors import plan_of
from engine_evidence.floors import floor_text, replication_of
from engine_evidence.planted import planted_in_simpy
from engine_evidence.sample import SAMPLE
from golden_logs import Golden, written

from opsim.engine.floor.machine import Arena
from opsim.engine.floor.run import run_plan
from opsim.engine.floor.state import Job

TESTS = Path(__file__).parents[3]
FLOOR = 3
"""It comes to each of the rules into which a fault is planted."""
PLANTED = {
    "use after give-back: .on_floor of a Job": ("settle.operation_over", "floor.done is job", "job.on_floor"),
    "a reference to nothing": ("settle.happen", "elif event.worker:", "elif event.kind:"),
    "an index too far: -1": ("routing.stir", "range(station.n", "range(-1, station.n"),
    "an index too far: 1 of 1": ("routing.stir", "n_wanted_by)", "n_wanted_by + 1)"),
    "a list changed while it is walked": ("settle.settle", "forget_event(floor, hook)", "reports.append(hook)"),
    "a bool that is no 0 or 1": ("worker.has_bit", "& 1 == 1", "| 2"),
    "a whole number beyond 64 bits": ("flow.new_job", "= n * floor.n_sources", "= (n << 62)"),
}
"""By how it is refused: a place in the rules, the words there, and those instead."""


def refusals() -> dict[str, str]:
    """What is said of the floor with each fault."""
    plan, found = plan_of(floor_text(FLOOR)), {}
    for words, fault in PLANTED.items():
        with planted_in_simpy(*fault):
            try:
                run_plan(plan, replication_of(FLOOR))
            except Exception as error:
                found[words] = f"{type(error).__name__}: {error}"
    return found


def moved(numbers: list[int]) -> dict[str, str]:
    """What of the rows of sound floors is not as it is written down, as they are used again."""
    before, found = written(), {}
    for number in numbers:
        plan, replication = plan_of(floor_text(number)), replication_of(number)
        run_plan(plan, replication)
        found[str(number)] = Golden.of(run_plan(plan, replication)).moved(before[f"made/{number}"])
    return found


def sanitized(*floors: int) -> list[dict[str, str]]:
    """What both functions above say in a process with the sanitizer; these floors are those of the second."""
    environment = os.environ | {"OPSIM_SANITIZE": "1", "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
    command = [sys.executable, __file__, *map(str, floors)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def said_of_one():
    return sanitized(FLOOR)


@pytest.mark.parametrize("words", PLANTED)
def test_a_planted_fault_is_refused_where_it_happens(said_of_one, words):
    module = PLANTED[words][0].partition(".")[0]
    said = said_of_one[0][words]
    assert said.startswith("Unsound: ") and f"{module}.py:" in said and words in said


def test_sound_rules_write_the_rows_they_write_otherwise(said_of_one):
    assert said_of_one[1] == {str(FLOOR): ""}


@pytest.mark.slow
def test_sound_rules_write_the_rows_they_write_otherwise_on_floors_of_the_whole_vocabulary():
    assert sanitized(*SAMPLE)[1] == {str(number): "" for number in SAMPLE}


def test_it_is_off_unless_it_is_asked_for():
    assert Arena.__module__ == "opsim.engine.floor.machine" and Job.__setattr__ is object.__setattr__


if __name__ == "__main__":
    sound = moved([int(one) for one in sys.argv[1:]])
    print(json.dumps([refusals(), sound]))
