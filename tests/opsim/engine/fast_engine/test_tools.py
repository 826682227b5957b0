"""Tools of tasks and stations: taken, waited for, passed on and given back as in SimPy's engine.

The crib: who calls for a worker with tools that others take meanwhile, and what is put back in one instant.

Memory that is lent: it comes back, within bounds, also in the middle of taking some.

A tool in the hands between two moments: taken, waited for and given back where SimPy's engine does.
"""

import gc

import numpy as np
import pytest
from twins import twins

from opsim.engine.fast_engine import log_rows
from opsim.engine.fast_engine.log_rows import MOST_KEPT, MOST_WASTE, lent
from opsim.log import HELD, NO_TOOL, TOOL, WAIT

CELL = """
opsim: 1
name: tools
run: {horizon: 900 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m], c: [4 m, 0 m]}}
tools: {jig: {n: 1}, clamp: {n: 2}}
tasks:
  one: {fixed: 4 s, needs: {jig: 1}}
  two: {fixed: 6 s, needs: {clamp: 1}}
  run: {fixed: 5 s, automatic: true, needs: {clamp: 1}}
stations:
  s1: {at: a, tasks: [one, two], buffer: 3MORE}
  s2: {at: b, tasks: [two, one, run], servers: 2, buffer: 3MORE}
  s3: {at: c, tasks: [one], buffer: 9, needs: {clamp: 2}}
products: {p: {share: 0.5, priority: 1, route: [s1, s2, s3]}, q: {share: 0.5, route: [s2, s3, s1]}}
release: {kind: renewal, every: {fixed: 12 s}}
workers:
  u: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}
  v: {walk: 1 m/s, skills: {s2: 1.0, s3: 1.0}}
  w: {walk: 1 m/s, skills: {s1: 1.0, s3: 1.0}}
"""


def n_waits(log):
    return len(log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL)))


def test_jobs_wait_for_tools_and_get_them_in_the_same_order():
    log = twins(CELL.replace("MORE", ""))
    assert n_waits(log) > 30 and len(log.of(TOOL)) > 100


def test_work_that_is_broken_off_lets_its_tools_go():
    jam = ", breakdowns: {jam: {every: {fixed: 9 s}, by: busy, repair: {fixed: 7 s}, job: resume}}"
    assert n_waits(twins(CELL.replace("MORE", jam))) > 30


def test_who_loses_his_server_gives_his_tools_back():
    assert n_waits(twins(CELL.replace("MORE", ", preempt: restart"))) > 20


def test_tools_of_a_station_go_on_to_the_next_of_a_batch():
    batch = ("at: c, tasks: [one], buffer: 9", "at: c, tasks: [one], buffer: 2, batch: {size: 2, most_wait: 30 s}")
    line = ("s2, s3]}", "s2, s3, s4]}"), ("s3: {", "s4: {at: a, tasks: [two], buffer: 0}\n  s3: {")
    more = ("v: {walk: 1 m/s, skills: {", "v: {walk: 1 m/s, skills: {s4: 1.0, ")
    log = twins(CELL.replace("MORE", ""), batch, *line, more)
    assert len(log.of(TOOL)) > 40


def test_a_horizon_in_the_midst_leaves_the_same_open_rows():
    log = twins(CELL.replace("MORE", ""), ("900 s", "331.5 s"))
    assert 331.5 in log.of(TOOL)["end_s"].tolist() and n_waits(log)


@pytest.mark.parametrize("rule", ["nearest", "oldest_job", "longest_queue"])
def test_who_has_waited_longest_for_a_tool_that_many_call_for_is_found(rule):
    text = """
opsim: 1
name: shared
run: {horizon: 1800 s, seed: 1}
layout: {places: {here: [0 m, 0 m], there: [5 m, 0 m]}}
tools: {gun: {n: 2}}
tasks: {x: {fixed: 60 s, needs: {gun: 1}}, y: {fixed: 40 s, needs: {gun: 2}}}
stations:
  a: {at: here, tasks: [x], buffer: 1}
  b: {at: there, tasks: [y], buffer: 1}
  c: {at: here, tasks: [x, y], buffer: 1, servers: 2}
products: {p: {route: [[a, b, c]]}}
release: {kind: saturated}
workers: {u: {walk: 1 m/s, skills: {a: 1, b: 1}}, v: {walk: 1 m/s, skills: {b: 1, c: 1}}, w: {skills: {c: 1, a: 1}}}
"""
    log = twins(text + f"allocation: {{rule: {rule}}}\n")
    assert n_waits(log) > 10


SHARED = """
opsim: 1
name: crib
run: {start: Mon 06:00, horizon: 1200 s, seed: 2}
layout: {places: {a: [0 m, 0 m], b: [0 m, 3 m], c: [0 m, 6 m]}}
tools: {gun: {n: 1}, jig: {n: 2}}
tasks:
  long: {fixed: 8 s, needs: {gun: 1, jig: 1}}
  short: {fixed: 4 s, needs: {jig: 2}}
  held: {fixed: 6 s, needs: {jig: 1}, hold: {tool: gun, from: 0.5, to: 1}}
defaults: {stations: {buffer: 2}}
stations: {s: {at: a, tasks: [long], servers: 2}, t: {at: b, tasks: [short, held]}, u: {at: c, tasks: [held, long]}}
products: {x: {share: 0.4, route: [s, t, u]}, y: {share: 0.6, priority: 1, route: [u, s]}}
release: {kind: renewal, every: {fixed: 10 s}, at_once: 2}
workers:
  k: {walk: 1 m/s, skills: {s: 1.0, t: 1.0, u: 1.0}}
  l: {walk: 1 m/s, skills: {s: 1.0, t: 1.0, u: 1.0}}
"""


def crib_n_waits(log):
    return len(log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL)))


def test_what_one_takes_others_call_for_no_more():
    log = twins(SHARED)
    assert crib_n_waits(log) > 20 and len(log.of(TOOL)) > 20


def test_a_station_that_closes_or_stops_in_the_midst_changes_nothing_of_that():
    jam = "maintenance: {clean: {every: 50 s, lasts: 20 s, when: at_once}}, "
    log = twins(SHARED, ("u: {at: c,", f"u: {{at: c, {jam}"), ("t: {at: b,", f"t: {{at: b, {jam}"))
    assert crib_n_waits(log) > 10


def test_people_who_go_on_a_break_put_their_tools_back():
    shift = "shifts: {day: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:03, lasts: 2 min}}}}\n"
    log = twins(SHARED + shift, ("k: {", "k: {shift: day, "), ("l: {", "l: {shift: day, "))
    assert crib_n_waits(log) > 10


@pytest.fixture
def nothing_kept(monkeypatch):
    """NOTE: logs that tests before have left in cycles would come back in the middle, and push out what is kept."""
    gc.disable()
    monkeypatch.setattr(log_rows, "_kept", type(log_rows._kept)())
    yield
    gc.enable()


def place_of(memory):
    return memory.ctypes.data


def kept_bytes():
    return [memory.nbytes for memory in log_rows._kept]


def test_what_came_back_is_lent_again_and_what_is_in_use_is_not(nothing_kept):
    first, second = lent(1 << 16), lent(1 << 16)
    assert place_of(first) != place_of(second)
    at, part = place_of(first), first[10:20]
    del first
    assert place_of(lent(1 << 16)) != at, "a part of it is in use"
    del part
    assert at in {place_of(memory) for memory in log_rows._kept}


def test_the_smallest_that_is_large_enough_is_lent(nothing_kept):
    for n_bytes in (3000, 2000, 1000):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert lent(1500).nbytes == 2000


def test_a_small_log_does_not_hold_large_memory(nothing_kept):
    log_rows._keep(np.empty(1000 * MOST_WASTE, np.uint8))
    assert lent(999).nbytes == 999
    assert lent(1000).nbytes == 1000 * MOST_WASTE


def test_no_more_is_kept_than_a_few_and_the_first_to_go_is_the_oldest(nothing_kept):
    for n_bytes in range(1, 10):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert kept_bytes() == [9, 8, 7, 6][:MOST_KEPT]


def test_all_that_is_kept_is_bounded_and_what_is_larger_is_let_go(nothing_kept, monkeypatch):
    monkeypatch.setattr(log_rows, "MOST_BYTES", 1000)
    for n_bytes in (400, 500, 1001, 300):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert kept_bytes() == [300, 500]


def test_memory_that_comes_back_while_some_is_taken_is_not_lent_twice(nothing_kept):
    """Python may collect what is unused at any moment: here, as soon as it is looked at what there is."""
    for n_bytes in (100, 200, 300):
        log_rows._keep(np.empty(n_bytes, np.uint8))

    class Collecting(np.ndarray):
        @property
        def nbytes(self):
            if late:
                log_rows._keep(late.pop())
            return self.size

    late = [np.empty(5, np.uint8), np.empty(50, np.uint8)]
    log_rows._kept.appendleft(np.empty(250, np.uint8).view(Collecting))
    taken = log_rows._taken(90)
    kept = list(log_rows._kept)
    assert taken.size == 100 and not late
    assert len({place_of(one) for one in (taken, *kept)}) == 1 + len(kept)


BENCH = """
opsim: 1
name: holds
run: {horizon: 600 s, seed: 1}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m]}}
tools: {gun: {n: 1}}
tasks: {make: {fixed: 10 s, hold: {tool: gun, from: 0.2, to: 0.6}}, pack: {fixed: 3 s}}
stations:
  s1: {at: a, tasks: [make, pack], servers: 2, buffer: 1}
  s2: {at: b, tasks: [make], buffer: 1}
products: {part: {route: [[s1, s2]]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 0.7, s1: 1.1}}, w3: {skills: {s1: 0.9}}}
"""
JAM = "breakdowns: {jam: {every: {fixed: 13 s}, by: busy, repair: {fixed: 7 s}, job: %s}}, "


def holds_n_waits(log, kind=WAIT):
    return len(log.where((log["kind"] == kind) & (log["cause"] == NO_TOOL)))


@pytest.mark.parametrize(
    "moments", ["from: 0.2, to: 0.6", "to: 0.5", "from: 0.5", "from: 0, to: 1", "from: 0.3, to: 0.31"]
)
def test_who_finds_no_tool_waits_at_the_same_moment(moments):
    log = twins(BENCH, ("from: 0.2, to: 0.6", moments))
    assert moments.endswith("0.31") or (holds_n_waits(log) > 20 and holds_n_waits(log, HELD) > 20)


@pytest.mark.parametrize("job", ["resume", "restart", "scrap"])
def test_what_is_broken_off_goes_on_with_the_same_moments(job):
    log = twins(BENCH, ("s1: {at: a,", f"s1: {{at: a, {JAM % job}"), ("s2: {at: b,", f"s2: {{at: b, {JAM % job}"))
    assert holds_n_waits(log) > 10 and len(log.of(TOOL)) > 20


def test_an_attended_run_holds_the_tool_at_the_station_s_pace():
    log = twins(
        BENCH,
        ("fixed: 10 s", "fixed: 10 s, automatic: attended"),
        ("s1: {at: a,", f"s1: {{at: a, {JAM % 'resume'}"),
    )
    assert holds_n_waits(log) > 10


@pytest.mark.parametrize("how", ["", "automatic: attended, "])
def test_drawn_times_bring_their_own_moments(how):
    drawn = f"make: {{{how}dist: lognormal, mean: 10 s, cv: 0.3, "
    log = twins(BENCH, ("make: {fixed: 10 s, ", drawn), ("600 s", "1 h"))
    assert holds_n_waits(log) > 50
