"""Steps call each other by the table: in any way round, found by their names, kept on disk."""

from types import FunctionType

import numpy as np
import pytest
from made.machine import as_floor, empty_floor, entered, is_even, is_odd
from opsim.engine.fast_engine.floor_state import Floor

from opsim.engine.fast_engine.machine import TABLE, complete, line_of, needed, step_of, steps
from opsim.engine.fast_engine.machine import step as as_step
from opsim.engine.fast_engine.machine.steps import STEPS, Step
from opsim.engine.fast_engine.machine.table import lacking


@entered
def even(floor_at, n):
    return is_even(as_floor(floor_at), n)


def test_two_steps_call_each_other():
    _, floor = empty_floor()
    complete(needed([step_of(is_even)]))
    assert [even(floor.address, n) for n in range(6)] == [1, 0, 1, 0, 1, 0]


def test_a_step_needs_those_that_it_names_and_those_they_name():
    assert {one.function.__name__ for one in needed([step_of(is_odd)])} == {"is_even", "is_odd"}


def test_what_is_complete_needs_no_compiling():
    complete(needed([step_of(is_even)]))
    told = []
    complete(needed([step_of(is_even)]), lambda *so_far: told.append(so_far))
    assert told == []
    assert not list(lacking(needed([step_of(is_odd)])))
    assert TABLE[line_of(is_even)] != 0


def test_two_steps_of_one_line_are_refused(monkeypatch):
    def another(floor: Floor, n: int) -> bool:
        return n > 0

    found = as_step(another)
    line = step_of(found).line
    monkeypatch.setitem(STEPS, line, step_of(is_even))
    with pytest.raises(ValueError, match="share a line of the table"):
        as_step(another)


def test_two_steps_of_one_line_and_name_in_two_files_are_refused(monkeypatch):
    def another(floor: Floor, n: int) -> bool:
        return n > 0

    line = step_of(as_step(another)).line
    elsewhere = FunctionType(another.__code__, {**another.__globals__, "__name__": "elsewhere"}, another.__name__)
    elsewhere.__qualname__ = another.__qualname__
    monkeypatch.setitem(STEPS, line, Step(elsewhere, line, None))
    with pytest.raises(ValueError, match="share a line of the table"):
        as_step(another)


def test_a_step_is_of_its_file_as_that_was_when_it_was_made(tmp_path, monkeypatch):
    """Where the file is another one when the step is compiled, its machine code is not kept under that one's name."""
    looked_at = []
    monkeypatch.setattr(steps, "stamp_of", looked_at.append)

    def another(floor: Floor, n: int) -> bool:
        return n > 0

    as_step(another)
    assert looked_at == [__file__]


def test_every_step_of_the_engine_has_a_line_of_its_own():
    from opsim.engine.fast_engine import lowering

    lowering.know_all()
    assert len(STEPS) > 100
    assert all(0 <= line < TABLE.size and STEPS[line].line == line for line in STEPS)
    assert TABLE.dtype == np.int64
