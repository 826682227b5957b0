"""What servers do, where a station can be set up, down, short of parts or tools, or shared by several jobs."""

import pytest
from plans import plan

from opsim import log as kinds
from opsim.engine.floor import run_plan
from opsim.kpi.states import possible_states as possible
from opsim.kpi.states import station_states
from opsim.log import BLOCKED, HELD, SETUP
from tests.opsim.kpi.made_logs import made, row, work

FLOOR = """
opsim: 1
name: states
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
flow: {blocking: before}
stations:
  a:
    at: here
    tasks: [t]
    servers: 2
    buffer: 3
    needs: {gun: 1}
    setup: {otherwise: 5 s, attended: false}
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 10 s}}}
  oven: {at: there, tasks: [t], servers: 2, buffer: 9, batch: {size: 3}, blocking: after}
  plain: {at: there, tasks: [t], blocking: after}
tools: {gun: {n: 2}}
stores: {rack: {at: here}}
transporters: {cart: {at: here, speed: 1 m/s, legs: [[a, oven]]}}
products:
  nut: {route: [plain, rack]}
  p: {route: [a, oven, plain], parts: {a: {nut: 1}}}
  q: {route: [a, oven, plain]}
sources: {nuts: {kind: poisson, every: 30 s, products: [nut]}, wholes: {kind: poisson, every: 20 s, products: [p, q]}}
"""
A, OVEN = 0, 1


def states(*rows, station="a"):
    """part -> seconds of a server in the window."""
    p = plan(FLOOR)
    log = made(rows, p)
    found = {f.part: f.value for f in station_states(log, p) if (f.kpi, f.subject) == ("station_states", station)}
    assert sum(found.values()) == pytest.approx(1)
    return {part: pytest.approx(share * 160) for part, share in found.items() if share and part != "starved"}


def test_only_the_states_that_a_station_can_be_in_are_told():
    p = plan(FLOOR)
    assert possible(p, 0) == {"setup", "down", "parts", "tool", "place", "pickup"}
    assert p.stations[2].name == "plain" and possible(p, 2) == set()


@pytest.mark.parametrize(
    ("kind", "cause", "part"),
    [
        (SETUP, 0, "setup"),
        (BLOCKED, 0, "blocked"),
        (HELD, kinds.NO_WORKER, "waiting"),
        (HELD, kinds.NO_PARTS, "parts"),
        (HELD, kinds.NO_TOOL, "tool"),
        (HELD, kinds.NO_PLACE, "place"),
        (HELD, kinds.PICKUP, "pickup"),
    ],
)
def test_what_a_job_on_a_server_waits_for_is_told(kind, cause, part):
    rows = [row(kind, 10, 30, station=A, job=0, cause=cause), row(kind, 50, 70, station=A, job=1, cause=cause)]
    assert states(*rows) == {part: 30}


def test_a_station_that_is_down_is_nothing_else():
    """Both servers from 40 to 60: five seconds nobody is there, then somebody; what stood there does not count."""
    rows = [
        work(30, 40, A, progress=(0, 0.5)),
        row(HELD, 40, 60, station=A, job=0, cause=kinds.IS_DOWN),
        row(BLOCKED, 35, 65, station=A, job=1),
        row(kinds.DOWN, 40, 45, station=A, cause=kinds.BREAKDOWN),
        row(kinds.REPAIR, 45, 60, station=A, cause=kinds.BREAKDOWN),
    ]
    assert states(*rows) == {"work": 10, "blocked": 10, "down": 10, "repair": 30}


def test_the_first_of_a_batch_stands_for_all_of_it():
    rows = [work(30, 40, OVEN), *(row(HELD, 30, 40, station=OVEN, job=n, cause=kinds.BATCH) for n in (1, 2))]
    assert states(*rows, station="oven") == {"work": 10}


def test_a_server_that_a_batch_shares_is_blocked_until_the_last_has_left():
    """Six end at once on two servers; from 60 on there are so few of them that one server may be free."""
    ends = (45, 50, 60, 62, 65, 70)
    rows = [row(BLOCKED, 40, end, station=OVEN, job=n) for n, end in enumerate(ends)]
    assert states(*rows, station="oven") == {"blocked": 20 + 30}


def test_shares_of_a_run_sum_to_one_and_none_is_negative():
    p = plan(FLOOR.replace("100 s", "1 h"))
    sums: dict[str, float] = {}
    for figure in station_states(run_plan(p), p):
        if figure.kpi == "station_states":
            assert figure.value >= -1e-12
            sums[figure.subject] = sums.get(figure.subject, 0) + figure.value
    assert sums == pytest.approx({"a": 1, "oven": 1, "plain": 1})
