import math
import multiprocessing
import signal
import subprocess
import sys
from functools import partial

import pytest

from opsim.pool import ProcessLost, pooled

POWER_OF_TWO = partial(partial, pow, 2)
"""Made in each process; what spawned processes are given must be found by name, so all of it is from the library."""


def test_every_item_is_done_once_and_no_process_is_left():
    assert sorted(pooled(POWER_OF_TWO, range(100), 2)) == [2**k for k in range(100)]
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


ENDED_FIRST = """
import signal
from functools import partial
from opsim.threads import can_fork
from opsim import pool

begin = pool._begin

def ended_first(*given):
    signal.raise_signal(signal.SIGTERM)
    begin(*given)

pool._begin = ended_first
signal.signal(signal.SIGTERM, lambda *_: print("its parent's handler"))
assert can_fork()
try:
    print(list(pool.pooled(partial(partial, pow, 2), range(6), 2)))
except pool.ProcessLost as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux only, and have all of their parent")
def test_a_process_that_is_ended_before_it_has_begun_ends():
    """Not by what its parent does then, which it still has: it would go on, and be waited for for ever."""
    done = subprocess.run([sys.executable, "-c", ENDED_FIRST], capture_output=True, text=True, timeout=120)
    assert done.stdout == "a process was killed (out of memory?)\n", done.stderr


def test_an_iteration_that_is_left_early_leaves_no_process():
    results = pooled(POWER_OF_TWO, range(1000), 2)
    next(results)
    results.close()
    assert multiprocessing.active_children() == []


def test_an_iteration_that_is_left_while_a_large_result_is_sent_ends_too(tmp_path):
    """In a process of its own: what went wrong here was to wait for ever for the rest of a result."""
    script = tmp_path / "left.py"
    script.write_text(LEFT)
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120)
    assert done.stdout == "left\n" and "Traceback" not in done.stderr


LEFT = """
import time
from functools import partial
from opsim.pool import pooled

if __name__ == "__main__":
    results = pooled(partial(partial, bytes), [60_000_000] * 8, 2)
    next(results)
    time.sleep(0.02)
    results.close()
    print("left")
"""


def test_processes_that_kept_a_database_end_without_a_word(tmp_path):
    """What DuckDB is written with complains of what is still there when Python ends."""
    script = tmp_path / "query.py"
    script.write_text(QUERY)
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120)
    assert done.stdout == "[7, 7, 7, 7]\n" and done.stderr == ""


QUERY = """
import threading
from opsim.log_parquet import connect
from opsim.pool import pooled

def work(item):
    with connect() as database:
        return database.execute("SELECT 7").fetchall()[0][0]

def prepare():
    return work

if __name__ == "__main__":
    threading.Thread(target=threading.Event().wait, daemon=True).start()  # beside it nothing is forked
    print(list(pooled(prepare, range(4), 2)))
"""
