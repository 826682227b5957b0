"""Steps call each other by the table: in any way round, found by their names."""

from types import FunctionType

import numpy as np
import pytest
from made.machine import Floor, empty_floor, is_even

from opsim.engine.fast_engine import lowering
from opsim.engine.fast_engine.machine import TABLE, complete, steps
from opsim.engine.fast_engine.machine import step as as_step
from opsim.engine.fast_engine.machine.calling import caller
from opsim.engine.fast_engine.machine.steps import STEPS, Step


def test_two_steps_call_each_other():
    _, floor = empty_floor()
    complete([is_even])
    assert [caller(is_even)(floor.address, n) for n in range(6)] == [1, 0, 1, 0, 1, 0]


def test_python_calls_no_step_by_its_name():
    with pytest.raises(TypeError, match=r"machine\.is_even is compiled"):
        is_even(None, 3)


def test_two_steps_of_one_line_are_refused(monkeypatch):
    def another(floor: Floor, n: int) -> bool:
        return n > 0

    line = as_step(another).line
    monkeypatch.setitem(STEPS, line, is_even)
    with pytest.raises(ValueError, match="share a line of the table"):
        as_step(another)


def test_two_steps_of_one_line_and_name_in_two_files_are_refused(monkeypatch):
    def another(floor: Floor, n: int) -> bool:
        return n > 0

    line = as_step(another).line
    elsewhere = FunctionType(another.__code__, {**another.__globals__, "__name__": "elsewhere"}, another.__name__)
    elsewhere.__qualname__ = another.__qualname__
    monkeypatch.setitem(STEPS, line, Step(elsewhere, line))
    with pytest.raises(ValueError, match="share a line of the table"):
        as_step(another)


def test_a_step_is_of_its_file_as_that_was_when_it_was_made(monkeypatch):
    """Where the file is another one when the step is compiled, what was imported is compiled."""
    looked_at = []
    monkeypatch.setattr(steps, "stamp_of", looked_at.append)

    def another(floor: Floor, n: int) -> bool:
        return n > 0

    as_step(another)
    assert looked_at == [__file__]


def test_every_step_of_the_engine_has_a_line_of_its_own():
    lowering.know_all()
    assert len(STEPS) > 100
    assert all(0 <= line < TABLE.size and STEPS[line].line == line for line in STEPS)
    assert TABLE.dtype == np.int64
