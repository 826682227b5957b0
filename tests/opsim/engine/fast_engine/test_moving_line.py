"""Moving lines in the compiled engine: people walk with their jobs and back, and the line stands and runs."""

import pytest
from made_moving_line import moving_line
from twins import twins

from opsim.log import FULL, SENT_ON, STANDS, UNFINISHED, WALK

UNEVEN = (
    ("w1: {walk: 1.1 m/s, skills: {s1: 1.0}}", "w1: {walk: 1.1 m/s, skills: {s1: 1.0, s2: 0.8}}"),
    ("w2: {walk: 1.1 m/s", "w2: {walk: 0.4 m/s"),
)
"""Two can do the work of the second station, and one of them is slow on his feet."""
SECOND = "{kind: moving, stations: [gap, s3], takt: 60 s, length: 6 m, unfinished: send_on}"


@pytest.mark.parametrize("unfinished", ["send_on", "stop"])
@pytest.mark.parametrize(("upstream", "drift"), [(0, 0), (2, 1.5), (7, 8)])
def test_walks_meetings_and_limits_are_the_same_to_the_bit(upstream, drift, unfinished):
    log = twins(moving_line(upstream, drift, unfinished), *UNEVEN)
    assert log.of(WALK)["worker"].size > 20
    if not drift:
        assert (UNFINISHED in log.of(STANDS)["cause"]) == (unfinished == "stop")
        assert (log.of(SENT_ON)["job"].size > 0) == (unfinished == "send_on")


def test_two_lines_one_after_the_other_keep_their_own_time_alike():
    """The limit of the last station is beyond the end of its line: its alarm comes when the job is on the next one."""
    log = twins(
        moving_line(1, 20, "send_on"),
        *UNEVEN,
        ("[s1, s2, gap, s3], takt", "[s1, s2], takt"),
        (", lengths: {s2: 9 m, gap: 2.5 m}", ""),
        ("products:", f"  more: {SECOND}\nproducts:"),
    )
    assert log.of(SENT_ON)["job"].size > 0


def test_a_job_that_cannot_leave_the_line_stops_it_alike():
    log = twins(
        moving_line(1, 1, "send_on"),
        *UNEVEN,
        ("stations: {s1", "stations: {after: {at: d, tasks: [t4], buffer: 1}, s1"),
        ("tasks:\n", "tasks:\n  t4: {fixed: 80 s, automatic: true}\n"),
        ("[s1, s2, gap, s3]}}", "[s1, s2, gap, s3, after]}}"),
    )
    assert FULL in log.of(STANDS)["cause"]
