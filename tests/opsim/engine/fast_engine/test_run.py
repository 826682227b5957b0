"""Runs that are broken off: by a signal, by a model that fails, by memory that is not there; and what comes after."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from engine_evidence.rows import first_difference
from plans import plan, queue

from opsim.engine.fast_engine import log_rows, run
from opsim.engine.fast_engine.log_rows import lent
from opsim.engine.fast_engine.streams.blocks import Stream
from opsim.engine.floor.run import run_plan as simpy_run

TESTS = Path(__file__).parents[3]
STOPPED = """
import signal, sys
from test_caches import digest
from plans import plan, queue
from opsim.engine.fast_engine.run import machine_of, run_plan

TEXT = queue(horizon="100 h")

def stop(number, frame):
    if armed:
        armed.clear()
        raise KeyboardInterrupt

armed = []
signal.signal(signal.SIGALRM, stop)
right = digest(run_plan(plan(TEXT)))
for n in range(8):
    made = plan(TEXT)
    machine_of(made)
    armed.append(True)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.002 + 0.004 * n, 0.001)
        run_plan(made)
        sys.exit("a run of 300,000 customers was not stopped")
    except KeyboardInterrupt:
        signal.setitimer(signal.ITIMER_REAL, 0)
    if digest(run_plan(made)) != right:
        sys.exit("the run after one that was stopped is another one")
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no such signals")
def test_a_run_is_stopped_whenever_a_signal_comes_and_the_next_one_of_the_plan_is_right():
    folders = os.pathsep.join(map(str, (Path(__file__).parent / "machine", TESTS, TESTS.parent)))
    process = subprocess.run(
        [sys.executable, "-c", STOPPED], env={**os.environ, "PYTHONPATH": folders}, capture_output=True, text=True
    )
    assert (process.returncode, process.stderr) == (0, "")


@pytest.fixture
def counter():
    """A Plan, and the rows of its replication 0."""
    made = plan(queue(horizon="3 h"))
    return made, simpy_run(made)


def test_what_a_model_raises_is_raised_and_the_next_run_is_right(counter, monkeypatch):
    made, right = counter

    def fails(*_):
        raise LookupError("no such number")

    with monkeypatch.context() as broken:
        broken.setattr(Stream, "fill", fails)
        with pytest.raises(LookupError, match="no such number"):
            run.run_plan(made)
    assert first_difference(right, run.run_plan(made)) == ""


def test_numbers_that_nobody_gave_are_an_error_and_not_read(monkeypatch):
    monkeypatch.setattr(run.Numbers, "_more", lambda *_: 0)
    with pytest.raises(RuntimeError, match="no numbers were drawn"):
        run.run_plan(plan(queue(horizon="30 h")))


def none(*_words):
    raise MemoryError


@pytest.mark.parametrize("of", ["jobs", "rows"])
def test_memory_that_is_not_there_is_an_error_and_the_next_run_is_right(monkeypatch, capfd, of):
    made = plan(queue(horizon="3 h", every="0.9 s"))
    machine = run.machine_of(made)
    with monkeypatch.context() as full:
        if of == "jobs":
            full.setattr(machine.build.arena, "_open_chunk", none)
        else:
            full.setattr(log_rows, "lent", lambda n_bytes: lent(n_bytes) if n_bytes < 600_000 else none())
        with pytest.raises(MemoryError):
            run.run_plan(made)
    assert first_difference(simpy_run(made), run.run_plan(made)) == ""
    assert "ignored" not in capfd.readouterr().err


@pytest.mark.parametrize("engine", [run.run_plan, simpy_run])
def test_a_negative_replication_is_refused_in_words(engine):
    with pytest.raises(ValueError, match="replication: found -1, expected a whole number from 0"):
        engine(plan(queue(horizon="1 h")), -1)
