"""More tools, cards, repair teams or vehicles in use than there are: each is found."""

import pytest
from plans import plan

from opsim.laws.capacity import shared
from opsim.laws.jobs import Stays
from opsim.log import CREATE, QUEUE, REPAIR, TOOL, TRANSPORT
from tests.opsim.kpi.made_logs import made, row, work

FLOOR = """
opsim: 1
name: shared
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a:
    at: here
    tasks: [t]
    servers: 9
    needs: {gun: 1}
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 1 s}, team: men}}
  b: {like: a, at: there}
  c: {at: there, tasks: [t], servers: 9}
tools: {gun: {n: 2}, jig: {n: 1}}
repair_teams: {men: {n: 1}}
transporters: {cart: {n: 2, at: here, speed: 1 m/s, legs: [[a, b]]}}
cards: {loop: {n: 2, from: a, to: b}, round: {n: 2, from: b, to: c}}
products: {p: {route: [a, b, c]}}
release: {kind: saturated}
"""


def found(*rows):
    p = plan(FLOOR)
    log = made([*rows, *(row(CREATE, 0, 0, job=job) for job in {r[8] for r in rows if r[8] >= 0})], p)
    return list(shared(log, p, Stays(log)))


def tools(n, k=0):
    return [row(TOOL, 10, 20, station=0, job=job, k=k) for job in range(n)]


def in_loop(n):
    """Jobs at a, then at b."""
    return [r for job in range(n) for r in (work(10, 20, 0, job=job), work(20, 30, 1, job=job))]


@pytest.mark.parametrize(
    ("rows", "most", "name"),
    [
        (tools, 2, "tool gun: 3 in use"),
        (lambda n: tools(n, k=1), 1, "tool jig: 2 in use"),
        (lambda n: [row(REPAIR, 10, 20, station=s, task=s) for s in range(n)], 1, "repair team men: at 2"),
        (in_loop, 2, "loop loop: 3 jobs"),
    ],
)
def test_one_more_than_there_are_is_found(rows, most, name):
    assert [complaint for complaint in found(*rows(most)) if name[:8] in complaint] == []
    assert any(complaint.startswith(name) for complaint in found(*rows(most + 1)))


def test_repairs_one_after_the_other_are_right():
    assert found(row(REPAIR, 10, 20, station=0, task=0), row(REPAIR, 20, 30, station=1, task=1)) == []


def test_a_card_is_given_back_on_leaving_the_end_of_its_loop():
    waits_behind = [row(QUEUE, 30, 90, station=2, job=job) for job in range(2)]
    third = work(30, 40, 0, job=2)
    assert found(*in_loop(2), *waits_behind, third) == []
    too_soon = work(29, 39, 0, job=2)
    assert found(*in_loop(2), *waits_behind, too_soon) == ["loop loop: 3 jobs in it at once on 2 cards"]


def vehicle(k, start, end):
    return row(TRANSPORT, start, end, places=(0, 1), k=k)


def test_a_vehicle_does_one_thing_at_a_time():
    assert found(vehicle(0, 10, 20), vehicle(0, 20, 30), vehicle(1, 10, 30)) == []
    assert found(vehicle(0, 10, 20), vehicle(0, 19, 30)) == ["vehicle 0 does two things at once"]


def test_a_vehicle_that_nobody_has_is_found():
    assert found(vehicle(2, 10, 20)) == ["vehicle 2 drives, and there are 2"]
