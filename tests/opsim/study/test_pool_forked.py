"""Pools whose processes are forked: in a process of its own, as beside the threads of a test runner none is forked."""

import os
import signal
import subprocess
import sys
import time

import pytest

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
        [sys.executable, tmp_path / "script.py"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
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
