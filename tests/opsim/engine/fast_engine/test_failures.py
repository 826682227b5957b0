"""Stops of stations on both engines: what they interrupt, who sees to them, what happens with them at one instant."""

import pytest
from twins import twins

from opsim.log import DOWN, FINISH, HELD, NO_WORKER, REPAIR, SCRAP, SETUP

ONE = """
opsim: 1
name: shop
run: {horizon: 400 s, seed: 5}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 9 s, automatic: true}, trim: {fixed: 4 s, automatic: true}}
stations:
  m: {at: hall, tasks: [press], buffer: 3, servers: 1, STOPS}
  n: {at: hall, tasks: [trim], buffer: 1, breakdowns: {jam: {every: {fixed: 30 s}, repair: {fixed: 6 s}, team: crew}}}
products: {part: {route: [m, n]}}
release: {kind: saturated}
repair_teams: {crew: {n: 1}}
"""
JAM = "STOPS", "breakdowns: {jam: {every: {fixed: 30 s}, repair: {fixed: 6 s}, team: crew, by: BY, job: JOB}}"
TWO_KINDS = (
    "STOPS",
    "breakdowns: {jam: {every: {dist: exponential, mean: 40 s}, repair: {dist: exponential, mean: 5 s}, team: crew}, "
    "die: {every: {dist: geometric, mean: 4}, by: cycles, repair: {fixed: 7 s}, job: restart}}, "
    "maintenance: {oil: {every: 50 s, lasts: 5 s, when: after_job}, wash: {every: 70 s, first: 30 s, lasts: 3 s}}",
)
BY_HAND = (
    ("press: {fixed: 9 s, automatic: true}", "press: {dist: exponential, mean: 9 s}"),
    ("trim: {fixed: 4 s, automatic: true}", "trim: {dist: exponential, mean: 4 s}"),
    ("repair_teams:", "workers: {ana: {skills: {m: 1.0, n: 1.0}}}\nrepair_teams:"),
)


@pytest.mark.parametrize("job", ["resume", "restart", "scrap"])
@pytest.mark.parametrize("by", ["clock", "busy"])
def test_two_stations_that_break_down_at_one_instant_wait_for_one_team(by, job):
    log = twins(ONE, JAM, ("BY", by), ("JOB", job))
    assert len(log.of(REPAIR)) > 8 and len(log.of(FINISH)) > 8
    assert len(log.of(DOWN)) > 0 or by == "busy"
    assert (len(log.of(SCRAP)) > 0) == (job == "scrap")


@pytest.mark.parametrize("replication", [0, 1])
def test_stops_of_all_kinds_follow_each_other_at_a_station_of_two_servers(replication):
    log = twins(ONE, TWO_KINDS, ("servers: 1", "servers: 2"), replication=replication)
    assert len(set(log.of(REPAIR)["task"].tolist())) == 5


@pytest.mark.parametrize("servers", ["servers: 1", "servers: 2"])
def test_workers_are_called_off_where_maintenance_waits_for_what_was_begun(servers):
    log = twins(ONE, TWO_KINDS, *BY_HAND, ("servers: 1", servers))
    assert NO_WORKER in log.of(HELD)["cause"]


def test_a_set_up_is_broken_off_and_goes_on_after_the_repair():
    log = twins(
        ONE,
        TWO_KINDS,
        *BY_HAND,
        ("buffer: 3,", "buffer: 3, setup: {otherwise: 6 s, attended: true, by: product},"),
        ("{part: {route: [m, n]}}", "{part: {route: [m, n], share: 0.5}, other: {route: [m], share: 0.5}}"),
    )
    assert len(log.of(SETUP)) > 10


def test_what_was_in_a_batch_on_a_server_that_breaks_down_is_scrap_together():
    log = twins(ONE, JAM, ("BY", "clock"), ("JOB", "scrap"), ("buffer: 3,", "buffer: 3, batch: {size: 2},"))
    assert len(log.of(SCRAP)) >= 2 and len(log.of(SCRAP)) % 2 == 0


def test_a_clock_stands_still_while_its_station_is_closed():
    shifts = "\nshifts: {a: {from: 00:00:20, to: 00:01:00}, b: {from: 00:01:40, to: 00:05:00}}\ntasks:"
    for at_close in ("resume", "finish"):
        hours = ("buffer: 3,", f"buffer: 3, shift: [a, b], at_close: {at_close},")
        log = twins(ONE, TWO_KINDS, hours, ("\ntasks:", shifts))
        assert len(log.of(REPAIR)) > 5
