"""Known answers by hand arithmetic: a belt of 6 m at 0.5 m/s is ridden in 12 s; at a pitch of 1 m one gets on every 2 s
and 6 are on it.
"""

from itertools import pairwise

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.log import BLOCKED, CREATE, FINISH, QUEUE, TRANSPORT

BELT = """
opsim: 1
name: belt
run: {horizon: 100 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {feed: {fixed: 1 s, automatic: true}, pack: {fixed: 1 s, automatic: true}}
stations: {feeder: {at: a, tasks: [feed], buffer: 1}, packer: {at: b, tasks: [pack], buffer: 0}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
products: {x: {route: [feeder, belt, packer]}}
release: {kind: saturated}
"""
RIGID = BELT.replace("pitch: 1 m}", "pitch: 1 m, accumulating: false}")
SLOW = "pack: {fixed: 5 s,"


def logged(text):
    p = plan(text)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    return log, p


def rows(log, kind, job=None, station=None):
    """(start, end) of the rows of a kind, of a job or at a station."""
    found = log.of(kind)
    for column, value in (("job", job), ("station", station)):
        found = found if value is None else found.where(found[column] == value)
    return list(zip(found["start_s"].tolist(), found["end_s"].tolist()))


@pytest.mark.parametrize("text", [BELT, RIGID])
def test_a_belt_takes_a_job_every_pitch_and_brings_it_after_its_length(text):
    log, _ = logged(text)
    # fed at 1 s, then every 2 s (the belt's pace, not the feeder's); 12 s on the belt and 1 s packed
    assert rows(log, TRANSPORT)[:3] == [(1.0, 13.0), (3.0, 15.0), (5.0, 17.0)]
    assert log.of(FINISH)["end_s"][:3].tolist() == [14.0, 16.0, 18.0]
    assert len(log.of(QUEUE).where(log.of(QUEUE)["station"] == 0)) == 0


def test_behind_a_slow_station_jobs_close_up_and_leave_as_it_takes_them():
    log, p = logged(BELT.replace("pack: {fixed: 1 s,", SLOW))
    assert log.of(FINISH)["end_s"][:4].tolist() == [18.0, 23.0, 28.0, 33.0]
    # the second is free to the end at 15 s, waits there till 18 s; the third rides 5-17 s, stands behind the second,
    # and is at the end 2 s after that one left it
    assert rows(log, TRANSPORT, job=2) == [(5.0, 17.0)]
    assert rows(log, QUEUE, job=2, station=0) == [(17.0, 20.0)]
    assert rows(log, BLOCKED, job=2, station=0) == [(20.0, 23.0)]
    assert max(_inside(log)) == p.conveyors[0].capacity == 6


def test_while_nobody_takes_jobs_the_belt_fills_to_its_capacity_and_no_further():
    log, _ = logged(BELT.replace("pack: {fixed: 1 s,", "pack: {fixed: 1 h,"))
    # one is packed from 13 s; six stand on the belt, got on at 3, 5, .. 13 s: the next could get on at 15 s, and cannot
    got_on = sorted(start for start, _ in rows(log, TRANSPORT))
    assert got_on == [1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0]


def test_a_full_belt_takes_the_next_job_when_the_last_one_has_closed_up():
    text = BELT.replace("pack: {fixed: 1 s,", "pack: {fixed: 20 s,").replace("pitch: 1 m", "pitch: 1.25 m")
    log, p = logged(text)
    # 6 m hold 4.8 jobs, so 5; all stand from 21 s, the last at 6 - 4 * 1.25 = 1 m. The packer takes one at 33 s; half a
    # second later the last one has moved by the 0.25 m that it lacked
    assert p.conveyors[0].capacity == 5
    got_on = sorted(start for start, _ in rows(log, TRANSPORT))
    assert got_on[:8] == [1.0, 3.5, 6.0, 8.5, 11.0, 13.5, 33.5, 53.5]


def test_a_belt_that_does_not_accumulate_stands_still_as_a_whole():
    log, _ = logged(RIGID.replace("pack: {fixed: 1 s,", SLOW))
    # at 15 s the second job is at the end, the packer busy till 18 s: nobody moves for 3 s; the third is there at 20 s
    assert rows(log, TRANSPORT, job=2) == [(5.0, 15.0), (18.0, 20.0)]
    assert rows(log, QUEUE, job=2, station=0) == [(15.0, 18.0)]
    assert rows(log, BLOCKED, job=2, station=0) == [(20.0, 23.0)]
    assert log.of(FINISH)["end_s"][:4].tolist() == [18.0, 23.0, 28.0, 33.0]


def test_jobs_on_a_rigid_belt_keep_their_distances():
    text = RIGID.replace("pack: {fixed: 1 s,", SLOW).replace("feed: {fixed: 1 s,", "feed: {fixed: 3 s,")
    log, _ = logged(text)
    at_end = sorted(start for start, _ in rows(log, BLOCKED, station=0))
    # 3 s apart: the first passes at 15 s; the second is there at 18 s, leaves at 20 s; so the third is there at 23 s
    assert at_end[:3] == [18.0, 23.0, 28.0]


@pytest.mark.parametrize("text", [BELT, RIGID])
def test_a_belt_at_the_end_of_a_route_brings_jobs_out(text):
    log, _ = logged(text.replace("route: [feeder, belt, packer]", "route: [feeder, belt]"))
    assert log.of(FINISH)["end_s"][:3].tolist() == [13.0, 15.0, 17.0]


@pytest.mark.parametrize("text", [BELT, RIGID])
def test_a_belt_may_be_where_jobs_come_in(text):
    log, _ = logged(text.replace("route: [feeder, belt, packer]", "route: [belt, packer]"))
    assert log.of(CREATE)["end_s"][:3].tolist() == [0.0, 2.0, 4.0]
    assert log.of(FINISH)["end_s"][:3].tolist() == [13.0, 15.0, 17.0]


@pytest.mark.parametrize("text", [BELT, RIGID])
def test_a_belt_delays_a_faster_flow_by_its_ride_alone(text):
    """Arrivals further apart than a pitch: departures are arrivals later by the constant ride."""
    text = text.replace("release: {kind: saturated}", "release: {kind: renewal, every: {fixed: 7 s}}")
    log, _ = logged(text)
    enter, leave = log.of(CREATE), log.of(FINISH)
    assert len(leave) >= 10
    assert np.all(leave["end_s"] - enter["end_s"][: len(leave)] == 14.0)


@pytest.mark.parametrize("accumulating", ["true", "false"])
def test_a_random_belt_keeps_every_law_and_every_pitch(accumulating):
    text = BELT.replace("pitch: 1 m", f"pitch: 0.7 m, accumulating: {accumulating}").replace("100 s", "4000 s")
    text = text.replace("feed: {fixed: 1 s", "feed: {dist: exponential, mean: 2 s")
    text = text.replace("pack: {fixed: 1 s", "pack: {dist: exponential, mean: 2 s")
    log, p = logged(text)
    assert len(log.of(FINISH)) > 500
    first = {}
    for start, job in zip(log.of(TRANSPORT)["start_s"], log.of(TRANSPORT)["job"]):
        first[job] = min(start, first.get(job, start))
    got_on = np.array(sorted(first.values()))
    assert np.diff(got_on).min() >= p.conveyors[0].headway_s
    assert max(_inside(log)) <= p.conveyors[0].capacity


def test_a_random_accumulating_belt_is_what_positions_of_its_jobs_say():
    """The naive twin: the job ahead bounds where a job can be; it gets on as soon as the last one is a pitch inside."""
    text = BELT.replace("pitch: 1 m", "pitch: 0.7 m").replace("100 s", "2000 s")
    text = text.replace("feed: {fixed: 1 s", "feed: {dist: exponential, mean: 2 s")
    text = text.replace("pack: {fixed: 1 s", "pack: {dist: exponential, mean: 2.2 s")
    log, p = logged(text)
    ride_s, pitch_s, capacity = p.conveyors[0].travel_s, p.conveyors[0].headway_s, p.conveyors[0].capacity
    on = dict(sorted((job, start) for (start, _), job in zip(rows(log, TRANSPORT), log.of(TRANSPORT)["job"])))
    here = log.where(log["station"] == 0)
    off = {job: here["end_s"][here["job"] == job].max() for job in on}
    off = {job: np.inf if end == 2000.0 else end for job, end in off.items()}
    waited = {job for job in on if rows(log, BLOCKED, job=job, station=1)}
    jobs = list(on)
    for i, job in enumerate(jobs[1:], start=1):
        now, ahead = on[job], jobs[max(0, i - 2 * capacity) : i]
        place = np.inf
        for other in ahead:
            place = min(place - pitch_s, now - on[other])
            place = ride_s + now - off[other] if off[other] <= now else min(place, ride_s)
        inside = sum(off[other] >= now for other in ahead)
        assert place >= pitch_s and inside <= capacity
        if job in waited and not any(off[other] == now for other in ahead):
            assert place == pitch_s
    ends = {job: start for (start, _), job in zip(rows(log, BLOCKED, station=0), _blocked(log)) if job in on}
    for before, job in pairwise(jobs):
        if off[job] < np.inf:
            assert ends.get(job, off[job]) == max(on[job] + ride_s, off[before] + pitch_s)


def _blocked(log):
    found = log.of(BLOCKED)
    return found["job"][found["station"] == 0]


def _inside(log):
    """Jobs on the belt, after each change."""
    here = log.where((log["station"] == 0) & np.isin(log["kind"], (TRANSPORT, QUEUE, BLOCKED)))
    times = np.concatenate([here["end_s"], here["start_s"]])
    steps = np.repeat([-1, 1], len(here))
    return np.cumsum(steps[np.lexsort([steps, times])])
