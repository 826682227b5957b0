import math
import multiprocessing
import signal
import subprocess
import sys
from functools import partial

import pytest

from opsim.forking import can_fork
from opsim.study import pool
from opsim.study.pool import ProcessLost, pooled

POWER_OF_TWO = partial(partial, pow, 2)
"""Made in each process; what spawned processes are given must be found by name, so all of it is from the library."""


def test_every_item_is_done_once_and_no_process_is_left():
    assert sorted(pooled(POWER_OF_TWO, range(6), 2)) == [1, 2, 4, 8, 16, 32]
    assert multiprocessing.active_children() == []


def test_an_error_of_the_work_comes_through_and_ends_the_processes():
    with pytest.raises(ValueError, match="math domain"):
        list(pooled(partial(partial, math.sqrt), [-1.0, 4.0], 2))
    assert multiprocessing.active_children() == []


def test_a_process_that_cannot_begin_says_why():
    with pytest.raises(ValueError, match="math domain"):
        list(pooled(partial(math.sqrt, -1.0), [1], 2))


def test_a_killed_process_is_said_in_words():
    with pytest.raises(ProcessLost, match="was killed"):
        list(pooled(partial(partial, signal.raise_signal), [signal.SIGKILL], 2))


def test_a_process_that_is_ended_before_it_has_begun_ends(monkeypatch):
    """Not by what its parent does then, which it still has: it would go on."""
    if not can_fork():
        pytest.skip("processes are not forked here, and begin with nothing of their parent")
    begin, handled = pool._begin, []

    def ended_first(*given):
        signal.raise_signal(signal.SIGTERM)
        begin(*given)

    monkeypatch.setattr(pool, "_begin", ended_first)
    before = signal.signal(signal.SIGTERM, lambda *_: handled.append(1))
    try:
        with pytest.raises(ProcessLost, match="was killed"):
            list(pooled(POWER_OF_TWO, range(6), 2))
    finally:
        signal.signal(signal.SIGTERM, before)
    assert multiprocessing.active_children() == [] and not handled


def test_an_iteration_that_is_left_early_leaves_no_process():
    results = pooled(POWER_OF_TWO, range(1000), 2)
    next(results)
    results.close()
    assert multiprocessing.active_children() == []


def test_an_iteration_that_is_left_while_a_large_result_is_sent_ends_too(tmp_path):
    """In a process of its own: what went wrong here was to wait for ever for the rest of a result."""
    script = tmp_path / "left.py"
    script.write_text(LEFT)
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=20)
    assert done.stdout == "left\n" and "Traceback" not in done.stderr


LEFT = """
import time
from functools import partial
from opsim.study.pool import pooled

if __name__ == "__main__":
    results = pooled(partial(partial, bytes), [60_000_000] * 8, 2)
    next(results)
    time.sleep(0.02)
    results.close()
    print("left")
"""
