"""Jobs that left a line unfinished, by line and by station, and how long it stood, in the window alone."""

import pytest
from plans import ran

from opsim.kpi.table import figures

TEXT = """
opsim: 1
name: line
run: {horizon: 600 s, warm_up: 120 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 30 s}, u: {fixed: 20 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: a, tasks: [u]}}
lines: {final: {kind: indexed, stations: [s1, s2], takt: 60 s, unfinished: send_on}}
products: {one: {route: [s1, s2]}, three: {route: [s1, s2], lot: 3}}
release: {kind: saturated, sequence: [one, one, three]}
workers: {ana: {skills: {s1: 1.0}}, ben: {skills: {s2: 1.0}}}
"""


def values(*edits):
    log, p = ran(TEXT, *edits)
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}


def test_a_job_counts_once_however_often_it_was_sent_on():
    found = values(("u: {fixed: 20 s}", "u: {fixed: 25 s}"))
    # jobs 0, 1, 2, .. leave at 120, 180, 240, .. 540 s; 2 and 5 have three units: 90 s and 75 s
    assert found["incomplete_share", "final", ""] == pytest.approx(2 / 8)
    assert found["incomplete_share", "final", "s1"] == found["incomplete_share", "final", "s2"] == pytest.approx(2 / 8)


def test_stations_are_told_apart_and_sixty_seconds_are_in_time():
    found = values()
    assert found["incomplete_share", "final", "s2"] == 0.0
    assert found["incomplete_share", "final", "s1"] == pytest.approx(2 / 8)


def test_a_line_that_stops_has_no_incomplete_jobs_and_stands_for_what_they_lack():
    found = values((", unfinished: send_on", ""))
    assert not any(kpi == "incomplete_share" for kpi, _, _ in found)
    # job 2 comes on at 120 s and takes 90 s, job 5 at 330 s; the next of its kind after the horizon
    assert found["line_stopped_share", "final", ""] == pytest.approx((30 + 30) / 480)
    assert found["line_stopped_share", "final", "unfinished"] == found["line_stopped_share", "final", ""]


def test_nobody_who_cannot_leave_or_break_down_has_a_share_for_it():
    found = {part for kpi, _, part in values() if kpi == "line_stopped_share"}
    assert found == {""}


def test_bad_jobs_are_no_good_units():
    found = values()
    assert found["defects_out_share", "", ""] == pytest.approx(6 / 12)  # in units
    assert found["throughput_per_h", "", ""] == pytest.approx(6 / (480 / 3600))


PAUSE = (
    ("horizon: 600 s", "start: Mon 06:00, horizon: 600 s"),
    ("tasks: {t", "shifts: {day: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:03:10, lasts: 2 min}}}}\ntasks: {t"),
    ("ana: {", "ana: {shift: day, "),
    ("ben: {", "ben: {shift: day, "),
    (", sequence: [one, one, three]", ""),
    ("{one: {route: [s1, s2]}, three: {route: [s1, s2], lot: 3}}", "{one: {route: [s1, s2]}}"),
)  # fmt: skip


@pytest.mark.parametrize("tea", ["06:03:10", "06:03:25", "06:03:40"])
def test_a_break_of_all_is_a_pause_of_the_line_whether_jobs_are_done_or_not(tea):
    """Work from 180 to 210 s and from 180 to 200 s: the break comes within both, within one, and after both."""
    found = values(*PAUSE, ("06:03:10", tea))
    assert found["line_stopped_share", "final", ""] == 0.0
    assert found["line_stopped_share", "final", "away"] == pytest.approx(120 / 480)
    for station in ("s1", "s2"):
        states = {part: share for (kpi, of, part), share in found.items() if (kpi, of) == ("station_states", station)}
        assert states["pause"] == pytest.approx(120 / 480)
        assert states["away"] == states["line_stop"] == 0.0
        assert sum(states.values()) == pytest.approx(1.0)
        assert min(states.values()) >= 0.0


def test_who_finishes_in_the_pause_is_at_work():
    """The rule finish: at 190 s ben has 10 s left and ana 20 s, so that the line pauses from 210 s to 320 s, when both
    are back: their breaks keep their length."""
    found = values(*PAUSE, ("lasts: 2 min}}", "lasts: 2 min}}, at_break: finish"))
    assert found["line_stopped_share", "final", "away"] == pytest.approx(110 / 480)
    assert found["station_states", "s1", "pause"] == found["station_states", "s2", "pause"] == pytest.approx(110 / 480)


def test_a_break_of_one_while_another_is_there_is_no_pause_of_the_line():
    found = values(*PAUSE, ("ben: {shift: day, ", "ben: {"), (", unfinished: send_on", ""))
    assert found["station_states", "s1", "pause"] == found["line_stopped_share", "final", "away"] == 0.0
    assert found["line_stopped_share", "final", "unfinished"] > 0
