"""Places that are asked for before, and buffers behind: kept, given up and cleared as SimPy's engine does."""

import pytest
from twins import twins

from opsim.log import AFTER, BLOCKED, HELD, NO_PLACE, QUEUE, REWORK

LINE = """
opsim: 1
name: places
run: {horizon: 1200 s, seed: 4}
layout: {places: {p: [0 m, 0 m], q: [4 m, 0 m], r: [8 m, 0 m]}}
tasks: {quick: {fixed: 5 s}, slow: {fixed: 8 s}, look: {fixed: 6 s}}
stations:
  a: {at: p, tasks: [quick], servers: 2, buffer: 1MORE}
  b: {at: q, tasks: [slow], servers: 2, buffer: 0MORE}
  c: {at: r, tasks: [look], buffer: 1, inspect: {finds: 0.8, false_alarms: 0.2, then: {rework: a}, most: 2}}
products:
  x: {share: 0.5, route: [a, b, c]}
  y: {share: 0.5, routing: {start: a, a: {a: 0.3, b: 0.4, out: 0.3}, b: {b: 0.2, c: 0.8}, c: out}}
release: {kind: renewal, every: {fixed: 5 s}}
workers:
  u: {walk: 2 m/s, skills: {a: 1.0, b: 1.0}}
  v: {walk: 2 m/s, skills: {b: 1.0, c: 1.0}}
  w: {walk: 2 m/s, skills: {a: 1.0, c: 1.0}}
"""


def line(more):
    return LINE.replace("MORE", more)


def n_rows(log, kind, cause):
    return len(log.where((log["kind"] == kind) & (log["cause"] == cause)))


def test_jobs_that_ask_first_wait_with_their_work_undone():
    log = twins(line(", blocking: before"))
    assert n_rows(log, HELD, NO_PLACE) > 5 and len(log.of(REWORK)) > 1


@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("carried", ["false", "true"])
def test_finished_jobs_clear_their_servers(held, carried):
    end = f"allocation: {{when_blocked: {held}}}\n"
    log = twins(line(", buffer_after: 1") + end, ("x: {share", f"x: {{carried: {carried}, share"))
    assert n_rows(log, QUEUE, AFTER) > 5 and len(log.of(BLOCKED)) > 2


def test_a_place_that_is_kept_and_a_buffer_behind_go_together():
    log = twins(line(", blocking: before, buffer_after: 1"))
    assert n_rows(log, HELD, NO_PLACE) > 5


def test_who_loses_his_server_may_have_lost_his_place_too():
    jam = ", breakdowns: {jam: {every: {fixed: 11 s}, by: busy, repair: {fixed: 5 s}, job: restart}}, preempt: resume"
    log = twins(line(f", blocking: before{jam}"), ("buffer: 0", "buffer: 2"), ("y: {share", "y: {priority: 2, share"))
    assert n_rows(log, HELD, NO_PLACE) > 5
