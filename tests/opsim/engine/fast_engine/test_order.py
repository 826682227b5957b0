"""Which waiting job is next, and which of several stations it goes to: as SimPy's engine decides.

Disassembly: pieces on one server, as SimPy's engine has them.

Jobs that wait for one worker, on both engines: what he began, and what he has to carry.

What a Plan needs before its first row: known beforehand, and not noted where it was not done.

Events come in the order of their times, and of one time in that in which they were set.
"""

import heapq

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made.machine import Floor, Given, empty_floor, entered
from plans import plan, queue
from twins import twins

from opsim.engine.fast_engine import run
from opsim.engine.fast_engine.event_list import forget_event, new_event, pop_event, push_event
from opsim.engine.fast_engine.keys import ROUTING, SEQUENCING
from opsim.engine.fast_engine.run import EMULATED, LUCK_S, STEP_S, STEPS_S, compiling_s, ready
from opsim.log import AWAY, BAD, BREAK, CREATE, FINISH, HELD, SETUP, SPLIT, TRANSPORT, WORK

SHOP = """
opsim: 1
name: shop
run: {horizon: 900 s, seed: 5}
layout: {places: {p: [0 m, 0 m], q: [4 m, 0 m], r: [8 m, 3 m]}}
tasks: {quick: {dist: exponential, mean: 4 s}, slow: {fixed: 7 s, repeat: 2}, cut: {fixed: 5 s}}
stations:
  m1: {at: p, tasks: [cut], buffer: 2}
  m2: {at: q, tasks: [slow], servers: 2, buffer: 3, setup: {otherwise: 3 s}}
  m3: {at: r, tasks: [quick], buffer: 2, setup: {times: {a: {c: 1 s}}, otherwise: 2 s, attended: false}}
  end: {at: r, tasks: [quick], setup: {otherwise: 2 s, by: family}}
products:
  a: {route: [[m3, m1, m2], end], due: 60 s, family: x}
  b: {route: [[m2, m3], m1, end], priority: 1, family: x, lot: 2}
  c: {route: [[m1, m3, m2], end], due: 30 s}
sources: {jobs: {kind: poisson, every: 8 s, products: [a, b, c]}}
flow: {dispatch: fifo, routing: shortest_queue}
workers:
  u: {walk: 1 m/s, skills: {m1: 1.0, m2: 0.8, end: 1.0}}
  v: {walk: 2 m/s, skills: {m2: 1.0, m3: 1.2, end: 1.0}}
  w: {walk: 2 m/s, skills: {m1: 1.0, m3: 1.0}}
"""


@pytest.mark.parametrize("rule", SEQUENCING)
def test_every_rule_takes_the_same_job_out_of_a_queue(rule):
    log = twins(SHOP, ("dispatch: fifo", f"dispatch: {rule}"))
    assert len(log.of(WORK)) > 150 and len(log.of(SETUP)) > 20


@pytest.mark.parametrize("rule", ROUTING)
def test_every_rule_takes_the_same_station(rule):
    log = twins(SHOP, ("routing: shortest_queue", f"routing: {rule}"))
    assert set(log.of(WORK)["station"]) == {0, 1, 2, 3}


def test_jobs_put_away_behind_a_station_do_not_count_against_it():
    log = twins(SHOP, ("buffer: 3,", "buffer: 3, buffer_after: 2,"), ("every: 8 s", "every: 5 s"))
    assert len(log.of(WORK)) > 150


SAW = """
opsim: 1
name: saw
run: {horizon: 900 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 12 s}, plane: {fixed: 4 s, automatic: true}, press: {fixed: 5 s}}
stations:
  saw: {at: here, tasks: [cut], servers: 2, buffer: 2MORE}
  plane: {at: here, tasks: [plane], buffer: 0}
  press: {at: here, tasks: [press], buffer: 1}
products:
  log: {route: [saw], lot: 2, split: {saw: {board: 3, dust: 1}}}
  beam: {route: [saw, press]}
  board: {route: [plane], lot: 4}
  dust: {route: [press], split: {press: {grain: 2}}}
  grain: {route: [plane]}
sources:
  logs: {kind: poisson, every: 25 s, products: [log, beam]}
  others: {kind: poisson, every: 90 s, products: [log]}
workers: {w1: {skills: {saw: 1.0, press: 1.0}}, w2: {skills: {saw: 1.0}}}
"""


def saw(more=""):
    return SAW.replace("MORE", more)


def test_pieces_share_a_server_and_are_split_again():
    log = twins(saw())
    assert len(log.of(SPLIT)) > 30 and len(log.of(CREATE)) > 100 and len(log.of(FINISH)) > 50


def test_jobs_of_a_batch_are_split_where_they_stand():
    log = twins(saw(", batch: {size: 2, most_wait: 40 s}"))
    assert len(log.of(SPLIT)) > 20


def test_pieces_go_behind_the_station_where_there_is_room():
    log = twins(saw(", buffer_after: 3"))
    assert len(log.of(SPLIT)) > 30


def test_pieces_of_a_bad_job_are_bad():
    log = twins(saw(", yield: 0.7"))
    assert len(log.of(SPLIT)) > 30 and BAD in log.of(FINISH)["cause"]


CELL = """
opsim: 1
name: ties
run: {start: Mon 06:00, horizon: 70 min, seed: 4}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m]}}
tasks: {weld: {fixed: 50 s}, pack: {fixed: 80 s, automatic: true}}
stations:
  bench: {at: bay, tasks: [weld], servers: 2, buffer: 2}
  packer: {at: shed, tasks: [pack], servers: 1, buffer: 0}
products: {part: {route: [bench, packer], carried: true}, big: {route: [bench, packer], carried: true, priority: 1}}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 300 s, products: [big]}}
shifts:
  early:
    from: 06:00
    to: 06:20
    at_end: RULE
    at_break: RULE
    breaks: {tea: {at: 06:05, lasts: 3 min}, rest: {at: 06:11, lasts: 2 min}}
  late: {from: 06:25, to: 07:30, at_break: RULE, breaks: {tea: {at: 06:41, lasts: 90 s}}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0}}
  ben: {shift: [early], walk: 1 m/s, skills: {bench: 0.9}}
  cem: {shift: late, walk: 1 m/s, skills: {bench: 1.1}}
  dora: {shift: late, walk: 2 m/s, home: shed, absence: 0.4, skills: {bench: 0.7}}
allocation: {when_blocked: BLOCKED}
"""


@pytest.mark.parametrize("blocked", ["held", "free"])
@pytest.mark.parametrize("rule", ["resume", "restart", "finish_job"])
def test_what_he_has_to_carry_waits_for_him_or_for_anybody_once_he_is_off(rule, blocked):
    log = twins(CELL, ("RULE", rule), ("BLOCKED", blocked))
    assert len(log.of(TRANSPORT)) > 5 and len(log.of(BREAK)) > 3


def test_what_he_began_waits_for_him():
    log = twins(CELL, ("RULE", "resume"), ("BLOCKED", "free"), ("weld: {fixed: 50 s}", "weld: {fixed: 500 s}"))
    assert (log.of(HELD)["cause"] == AWAY).any() and len(log.of(FINISH))


@pytest.mark.parametrize("at_close", ["finish", "resume"])
def test_what_he_began_is_for_anybody_where_its_station_has_closed(at_close):
    hours = ("tasks: [weld], servers: 2,", f"tasks: [weld], servers: 2, shift: early, at_close: {at_close},")
    log = twins(CELL, ("RULE", "resume"), ("BLOCKED", "free"), ("weld: {fixed: 50 s}", "weld: {fixed: 200 s}"), hours)
    assert (log.of(HELD)["cause"] == AWAY).any()


@pytest.fixture
def made():
    return plan(queue(horizon="1 h"))


@pytest.fixture
def cold(monkeypatch):
    """Nothing compiled, nothing noted."""
    monkeypatch.setattr(run, "lacking", list)
    monkeypatch.setattr(run, "is_marked", lambda _what: False)
    run.is_trusted.cache_clear()


def test_what_is_ready_needs_no_compiling(made):
    ready(made)
    assert compiling_s(made) == 0


def test_compiling_takes_time_for_each_step_and_for_what_draws_numbers(made, cold):
    n_steps = (compiling_s(made) - STEPS_S - LUCK_S) / STEP_S
    assert n_steps == pytest.approx(round(n_steps)) and n_steps > 9


def test_what_is_ready_is_said_part_by_part(made, cold, monkeypatch):
    done, told = [], []
    monkeypatch.setattr(run, "complete", lambda steps: done.append("steps"))
    monkeypatch.setattr(run, "_compile_luck", lambda: done.append("luck"))
    ready(made, lambda *so_far: told.append(so_far))
    assert done[:2] == ["steps", "luck"] and told == [(0, 2), (1, 2), (2, 2)]


def test_emulators_that_could_not_draw_are_not_noted_as_compiled(made, monkeypatch):
    noted = []
    monkeypatch.setattr(run, "mark", noted.append)
    run._draw(made, [0])
    assert noted == [EMULATED]
    run._draw(made, [99])
    assert noted == [EMULATED]


@entered
def gone_through(floor: Floor, given: Given) -> int:
    """Pushes where a time is said and pops where it is negative; ``a`` (n,) numbers of what was popped."""
    times, found = given.floats, given.a
    n = 0
    for i in range(given.n):
        if times[i] >= 0:
            event = new_event(floor)
            event.number = i
            push_event(floor, times[i], event)
        elif floor.heap_n:
            event = pop_event(floor)
            found[n] = event.number
            forget_event(floor, event)
            n += 1
    return n


@settings(max_examples=150, deadline=None)
@given(st.lists(st.sampled_from([-1.0, 0.0, 0.5, 1.0, 2.0, 3.5]), max_size=300))
def test_the_heap_is_that_of_python(times):
    arena, floor = empty_floor()
    arena.freeze()
    found = np.zeros(len(times), dtype=np.int64)
    n = gone_through(floor.address, floats=np.array(times), a=found, n=len(times))
    heap, wanted = [], []
    for i, at_s in enumerate(times):
        if at_s >= 0:
            heapq.heappush(heap, (at_s, i))
        elif heap:
            wanted.append(heapq.heappop(heap)[1])
    assert found[:n].tolist() == wanted
