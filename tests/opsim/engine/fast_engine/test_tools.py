"""Tools of tasks and stations: taken, waited for, passed on and given back as in SimPy's engine."""

import pytest
from twins import twins

from opsim.log import HELD, NO_TOOL, TOOL

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
