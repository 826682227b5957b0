"""What a Plan needs before its first row: known beforehand, and not noted where it was not done."""

import pytest
from plans import plan, queue

from opsim.engine.fast_engine import run
from opsim.engine.fast_engine.run import EMULATED, LUCK_S, STEP_S, compiling_s, ready


@pytest.fixture
def made():
    return plan(queue(horizon="1 h"))


@pytest.fixture
def cold(monkeypatch):
    """Nothing compiled, nothing noted."""
    monkeypatch.setattr(run, "lacking", lambda steps: iter(steps))
    monkeypatch.setattr(run, "is_marked", lambda _what: False)
    run.is_trusted.cache_clear()


def test_what_is_ready_needs_no_compiling(made):
    ready(made)
    assert compiling_s(made) == 0


def test_compiling_takes_time_for_each_step_shared_by_all_processes(made, cold, monkeypatch):
    monkeypatch.setattr(run, "n_helpers", lambda: 0)
    alone_s = compiling_s(made)
    n_steps = (alone_s - LUCK_S) / STEP_S
    assert n_steps == pytest.approx(round(n_steps)) and n_steps > 16
    monkeypatch.setattr(run, "n_helpers", lambda: 3)
    assert compiling_s(made) == pytest.approx(alone_s / 4)


def test_emulators_that_could_not_draw_are_not_noted_as_compiled(made, monkeypatch):
    noted = []
    monkeypatch.setattr(run, "mark", noted.append)
    run._draw(made, [0])
    assert noted == [EMULATED]
    run._draw(made, [99])
    assert noted == [EMULATED]
