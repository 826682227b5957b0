"""Where on the line jobs are handed over: from rows made by hand."""

import numpy as np
import pytest
from plans import plan

from opsim.kpi.lines import crews, hand_overs
from opsim.log import WORK, event_log, names_of, row

TEXT = """
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
    brigade = plan(TEXT)
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
    no_crews = plan(TEXT[: TEXT.index("crews:")])
    assert list(crews(log, no_crews)) == [] and len(list(crews(log, brigade))) == 3
