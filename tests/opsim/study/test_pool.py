"""Pools whose processes are forked: in a process of its own, as beside the threads of a test runner none is forked."""

import math
import multiprocessing
import os
import signal
import subprocess
import sys
import time
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
    results = pooled(partial(partial, bytes), [20_000_000] * 8, 2)
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


def test_a_script_without_a_guard_is_not_run_again_in_each_process(tmp_path):
    """As they are spawned beside threads, such as those of BLAS."""
    script = tmp_path / "unguarded.py"
    script.write_text(UNGUARDED)
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120)
    assert done.stdout == "begun\n[1, 2, 4, 8] unguarded.py\n" and done.stderr == ""


UNGUARDED = """
import os, threading
from functools import partial
from opsim.pool import pooled

print("begun")
threading.Thread(target=threading.Event().wait, daemon=True).start()
print(sorted(pooled(partial(partial, pow, 2), range(4), 2)), os.path.basename(__file__))
"""


BEGIN = """
import math, multiprocessing, os, signal, sys, threading, time
from functools import partial
from opsim.threads import lean
lean()
from opsim import threads
from opsim.threads import Ticking, can_fork
from opsim.pool import Pool, ProcessLost, pooled

threads.ENDING_S = 60.0  # on a busy machine a thread that was joined ends when it comes to its turn
assert can_fork()
"""


def said(tmp_path, script):
    (tmp_path / "script.py").write_text(BEGIN + script)
    done = subprocess.run([sys.executable, tmp_path / "script.py"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return done.stdout.splitlines()


def test_every_item_is_done_once_with_what_the_parent_had_and_no_process_is_left(tmp_path):
    assert said(tmp_path, ALL) == ["[1, 2, 4, 8, 16, 32]", "[]", "[2, 3] [1, 2] True", "[]"]


ALL = """
print(sorted(pooled(lambda: lambda item: 2**item, range(6), 2)))  # a lambda cannot be sent: it is there by the fork
print(multiprocessing.active_children())
pool = Pool(lambda: lambda item: item + 1, 2)
rounds = [sorted(pool.results(items)) for items in ((1, 2), (0, 1))]
print(*rounds, len(multiprocessing.active_children()) == 2)
pool.close()
print(multiprocessing.active_children())
"""


def test_a_pool_that_stops_early_ends_its_processes_and_says_why(tmp_path):
    assert said(tmp_path, EARLY) == ["lost", "math domain error", "math domain error", "left", "left a large one", "[]"]


EARLY = """
def of(work, items):
    try:
        list(pooled(lambda: work, items, 2))
    except ProcessLost:
        print("lost")
    except ValueError as error:
        print(error)
def fails():
    math.sqrt(-1.0)
of(signal.raise_signal, [signal.SIGKILL])
of(math.sqrt, [-1.0, 4.0])
try:
    list(pooled(fails, [1], 2))
except ValueError as error:
    print(error)
for work, item, words in ((abs, 1, "left"), (bytes, 60_000_000, "left a large one")):
    results = pooled(lambda: work, [item] * 8, 2)
    next(results)
    time.sleep(0.02)
    results.close()
    print(words)
print(multiprocessing.active_children())
"""


def test_a_million_items_are_taken_as_they_are_needed(tmp_path):
    (taken,) = said(tmp_path, MILLION)
    assert int(taken) < 40


MILLION = """
items = iter(range(1_000_000))
results = pooled(lambda: abs, items, 2)
for _ in range(10):
    next(results)
results.close()
print(next(items))
"""


def test_beside_a_thread_that_is_not_known_nothing_is_forked(tmp_path):
    assert said(tmp_path, THREADS) == ["False", "True", "[0, 1, 2]", "True"]


THREADS = """
over = threading.Event()
other = threading.Thread(target=over.wait)
other.start()
print(can_fork())
over.set(), other.join()
ticks = []
clock = Ticking(lambda: ticks.append(time.sleep(0.01)), 0.001)
clock.start()
print(can_fork())
print(sorted(pooled(lambda: abs, range(3), 2)))
clock.stop()
print(can_fork())
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_processes_end_with_their_parent_whatever_ends_it(tmp_path, number):
    (tmp_path / "script.py").write_text(BEGIN + WAITS)
    parent = subprocess.Popen(
        [sys.executable, tmp_path / "script.py"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background job has it ignored
    )
    children = [int(parent.stdout.readline()) for _ in range(2)]
    parent.send_signal(number)
    parent.wait(60)
    until = time.monotonic() + 60
    while any(map(_lives, children)) and time.monotonic() < until:
        time.sleep(0.01)
    assert not any(map(_lives, children))


WAITS = """
def work(item):
    os.write(1, f"{os.getpid()}\\n".encode())  # at once: two children write here
    time.sleep(600)
list(pooled(lambda: work, range(2), 2))
"""


def _lives(pid):
    try:
        os.kill(pid, 0)
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except (ProcessLookupError, FileNotFoundError):
        return False
