"""Jobs that left a line unfinished, by line and by station, and how long it stood, in the window alone.

Where on the line jobs are handed over: from rows made by hand.
"""

import numpy as np
import pytest
from plans import plan, ran

from opsim.kpi.table import figures
from opsim.log import WORK, event_log, names_of, row
from opsim.subjects.lines.figures import crews, hand_overs

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


CREWS_TEXT = """
opsim: 1
name: brigade
run: {horizon: 100 s, warm_up: 10 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {short: {fixed: 10 s}, long: {fixed: 15 s, repeat: 2}, dry: {fixed: 10 s, automatic: true}}
stations: {a: {at: hall, tasks: [short]}, b: {at: hall, tasks: [long, dry]}}
products: {bag: {route: [a, b]}}
release: {kind: poisson, every: 60 s}
workers: {w1: {skills: {a: 1, b: 1}}, w2: {skills: {a: 1, b: 1}}, w3: {skills: {a: 1, b: 1}}}
crews: {line: {kind: bucket_brigade, stations: [a, b], workers: [w1, w2, w3]}}
"""
DRY, LONG, SHORT = range(3)


def piece(start_s, end_s, worker, station, task, progress=(0.0, 1.0), job=0):
    where = {"worker": worker, "station": station, "source": 0, "job": job, "product": 0, "operation": station}
    return row(WORK, start_s, end_s, **where, task=task, progress_from=progress[0], progress_to=progress[1])


def made(*rows):
    brigade = plan(CREWS_TEXT)
    return event_log(rows, 100.0, names_of(brigade)), brigade


def test_a_position_is_the_share_of_the_jobs_work_that_was_done():
    """10 s at a, 2 x 15 s and 10 s of drying at b: at 4 s of 50, and at 10 + 15 + 3 s of them."""
    log, brigade = made(
        piece(0, 4, 0, 0, SHORT, (0.0, 0.4)), piece(4, 9, 1, 0, SHORT, (0.4, 1.0)), piece(9, 20, 1, 1, LONG),
        piece(20, 24, 1, 1, LONG, (0.0, 0.2)), piece(24, 30, 2, 1, LONG, (0.2, 1.0)), piece(30, 40, -1, 1, DRY),
        piece(5, 50, 0, 0, SHORT, job=1),
    )  # fmt: skip
    found = hand_overs(log, brigade, brigade.crews[0])
    assert found.at_s.tolist() == [4, 24]
    assert list(zip(found.before, found.after)) == [(0, 1), (1, 2)]
    assert found.position == pytest.approx([4 / 50, 28 / 50], abs=1e-12)


def test_a_pause_or_a_machine_between_two_pieces_of_one_worker_is_no_hand_over():
    log, brigade = made(
        piece(0, 4, 0, 1, LONG, (0.0, 0.4)), piece(8, 12, 0, 1, LONG, (0.4, 1.0)), piece(12, 20, -1, 1, DRY),
        piece(20, 40, 0, 1, LONG),
    )  # fmt: skip
    assert hand_overs(log, brigade, brigade.crews[0]).at_s.size == 0


def test_hand_overs_count_where_they_happen_in_the_window():
    """One before the end of the warm-up, two after it; of w2 to w3 there is none."""
    pieces = [(0, 4, 8), (1, 20, 30), (2, 40, 50)]
    rows = [
        piece(start_s, end_s, who, 0, SHORT, (share, share + 0.5), job)
        for job, start_s, end_s in pieces
        for who, share, start_s, end_s in ((0, 0.0, start_s, end_s), (1, 0.5, end_s, end_s + 5))
    ]
    found = {(f.kpi, f.part): f.value for f in crews(*made(*rows))}
    assert found["hand_overs_per_h", ""] == pytest.approx(2 / 90 * 3600)
    assert found["handoff_position", "w1 to w2"] == pytest.approx(5 / 50)
    assert np.isnan(found["handoff_position", "w2 to w3"])


def test_a_scenario_without_crews_has_no_figure_of_them():
    log, brigade = made()
    no_crews = plan(CREWS_TEXT[: CREWS_TEXT.index("crews:")])
    assert list(crews(log, no_crews)) == [] and len(list(crews(log, brigade))) == 3
