"""Moving lines in the compiled engine: people walk with their jobs and back, and the line stands and runs."""

import pytest
from twins import twins

from opsim.log import FULL, SENT_ON, STANDS, UNFINISHED, WALK

LINE = """
opsim: 1
name: moving
run: {start: Mon 06:00, horizon: 2400 s, seed: 2}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], d: [21 m, 0 m]}}
tasks:
  t1: {dist: lognormal, mean: 42 s, cv: 0.3}
  t2: {dist: lognormal, mean: 66 s, cv: 0.35}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2]}, gap: {at: b, tasks: []}, s3: {at: d, tasks: [t1]}}
lines:
  trim: {kind: moving, stations: [s1, s2, gap, s3], takt: 60 s, length: 6 m, lengths: {s2: 9 m, gap: 2.5 m},
         speed: 0.1 m/s, upstream: UP m, drift: DRIFT m, unfinished: UNFINISHED}
products: {car: {route: [s1, s2, gap, s3]}}
release: {kind: saturated}
workers:
  w1: {walk: 1.1 m/s, skills: {s1: 1.0, s2: 0.8}}
  w2: {walk: 0.4 m/s, skills: {s2: 1.1}}
  w3: {walk: 1.1 m/s, skills: {s3: 1.0}}
"""
SECOND = "{kind: moving, stations: [gap, s3], takt: 60 s, length: 6 m, unfinished: send_on}"


@pytest.mark.parametrize("unfinished", ["send_on", "stop"])
@pytest.mark.parametrize(("upstream", "drift"), [(0, 0), (2, 1.5), (7, 8)])
def test_walks_meetings_and_limits_are_the_same_to_the_bit(upstream, drift, unfinished):
    text = LINE.replace("UP m", f"{upstream} m").replace("DRIFT", str(drift)).replace("UNFINISHED", unfinished)
    log = twins(text)
    assert log.of(WALK)["worker"].size > 20
    if not drift:
        assert (UNFINISHED in log.of(STANDS)["cause"]) == (unfinished == "stop")
        assert (log.of(SENT_ON)["job"].size > 0) == (unfinished == "send_on")


def test_two_lines_one_after_the_other_keep_their_own_time_alike():
    """The limit of the last station is beyond the end of its line: its alarm comes when the job is on the next one."""
    text = LINE.replace("UP m", "1 m").replace("DRIFT", "20").replace("UNFINISHED", "send_on")
    log = twins(
        text,
        ("[s1, s2, gap, s3], takt", "[s1, s2], takt"),
        (", lengths: {s2: 9 m, gap: 2.5 m}", ""),
        ("products:", f"  more: {SECOND}\nproducts:"),
    )
    assert log.of(SENT_ON)["job"].size > 0


def test_a_job_that_cannot_leave_the_line_stops_it_alike():
    text = LINE.replace("UP m", "1 m").replace("DRIFT", "1").replace("UNFINISHED", "send_on")
    log = twins(
        text,
        ("stations: {s1", "stations: {after: {at: d, tasks: [t3], buffer: 1}, s1"),
        ("tasks:\n", "tasks:\n  t3: {fixed: 80 s, automatic: true}\n"),
        ("[s1, s2, gap, s3]}}", "[s1, s2, gap, s3, after]}}"),
    )
    assert FULL in log.of(STANDS)["cause"]
