"""A tool held between two moments of a performance, by hand arithmetic and by the marks of drawn movements."""

import numpy as np
import plans
import pytest

from opsim.clock import on_grid
from opsim.engine.draws import Draws
from opsim.kpi import figures
from opsim.log import HELD, NO_TOOL, TOOL, WAIT, WORK

CELL = """
opsim: 1
name: holds
run: {horizon: 60 s, seed: 1}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [0 m, 0 m]}}
tools: {gun: {n: 1}}
tasks: {make: {fixed: 10 s, hold: {tool: gun, from: 0.2, to: 0.6}}}
stations:
  s1: {at: a, tasks: [make], buffer: 1}
  s2: {at: b, tasks: [make], buffer: 1}
products: {part: {route: [[s1, s2]]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}}
"""


def ran(*edits):
    return plans.ran(CELL, *edits)


def pieces(log, worker):
    rows = log.of(WORK)
    rows = rows.where(rows["worker"] == log.names["worker"].index(worker))
    return list(zip(*(rows[c].tolist() for c in ("start_s", "end_s", "k", "progress_from", "progress_to"))))


def spans(log, mask):
    return sorted(zip(log["start_s"][mask].tolist(), log["end_s"][mask].tolist()))


def test_who_finds_no_tool_at_the_moment_he_wants_it_waits_there_and_goes_on():
    log, _ = ran()
    assert pieces(log, "w1")[:2] == [(0, 10, 0, 0, 1), (10, 20, 1, 0, 1)]
    assert pieces(log, "w2")[:3] == [(0, 2, 0, 0, 0.2), (6, 14, 0, 0.2, 1), (14, 24, 1, 0, 1)]
    assert spans(log, (log["kind"] == WAIT) & (log["cause"] == NO_TOOL)) == [(2, 6)]
    assert spans(log, (log["kind"] == HELD) & (log["cause"] == NO_TOOL)) == [(2, 6)]
    assert spans(log, log["kind"] == TOOL)[:4] == [(2, 6), (6, 10), (12, 16), (16, 20)]


def test_pieces_of_a_performance_are_one_performance():
    log, _ = ran()
    work = log.of(WORK)
    first = work.where(work["performance_id"] == work["performance_id"][np.flatnonzero(work["progress_from"] > 0)[0]])
    assert first["progress_from"].tolist() == [0, 0.2] and first["progress_to"].tolist() == [0.2, 1]


def test_a_hold_from_the_start_is_waited_for_before_anything_is_done():
    log, _ = ran(("from: 0.2, to: 0.6", "to: 0.5"))
    assert pieces(log, "w1")[:2] == [(0, 10, 0, 0, 1), (10, 20, 1, 0, 1)]
    assert pieces(log, "w2")[:2] == [(5, 15, 0, 0, 1), (15, 25, 1, 0, 1)]


def test_a_hold_to_the_end_is_given_back_with_the_work():
    log, _ = ran(("from: 0.2, to: 0.6", "from: 0.5"))
    assert spans(log, log["kind"] == TOOL)[:3] == [(5, 10), (10, 15), (15, 20)]
    assert pieces(log, "w2")[:3] == [(0, 5, 0, 0, 0.5), (10, 15, 0, 0.5, 1), (15, 25, 1, 0, 1)]


def test_a_faster_worker_comes_to_his_moments_sooner():
    log, _ = ran(("s1: 1.0", "s1: 2.0"))
    assert spans(log, log["kind"] == TOOL)[:2] == [(1, 3), (3, 7)]


def test_an_attended_run_takes_the_tool_at_its_own_moments():
    log, _ = ran(("fixed: 10 s", "fixed: 10 s, automatic: attended"), ("s1: 1.0", "s1: 2.0"))
    assert spans(log, log["kind"] == TOOL)[:2] == [(2, 6), (6, 10)]


def test_enough_tools_leave_every_performance_in_one_piece():
    log, _ = ran(("n: 1", "n: 2"))
    none, _ = ran((", hold: {tool: gun, from: 0.2, to: 0.6}", ""))
    assert pieces(log, "w1") == pieces(none, "w1") and pieces(log, "w2") == pieces(none, "w2")


def test_drawn_movements_hold_the_tool_from_mark_to_mark():
    emulated = (
        "fixed: 10 s, hold: {tool: gun, from: 0.2, to: 0.6}",
        "emulator: work/fasten, hold: {tool: gun, from: start, to: stop}",
    )
    log, p = ran(emulated, ("n: 1", "n: 2"), ("60 s", "600 s"))
    hold = p.tasks[0].hold
    draws = Draws(p, 0)
    drawn, plain = draws.durations_with(hold, 0, 0), draws.durations(0, 0)
    work, held = log.of(WORK), log.of(TOOL)
    mine = work.where((work["worker"] == 0) & (work["end_s"] < 600))
    tool = held.where((held["station"] == 0) & (held["end_s"] < 590))
    assert len(tool) > 50
    for i in range(len(tool)):
        duration_s, start, end = next(drawn)
        assert next(plain) == duration_s
        assert mine["end_s"][i] - mine["start_s"][i] == on_grid(duration_s)
        assert tool["start_s"][i] - mine["start_s"][i] == pytest.approx(start * duration_s, abs=2e-6)
        assert tool["end_s"][i] - mine["start_s"][i] == pytest.approx(end * duration_s, abs=2e-6)
    assert 0 < start < end < 1


def test_a_stop_in_the_middle_lets_the_tool_go_and_it_is_taken_again_for_the_rest():
    jam = (
        "s1: {at: a,",
        "s1: {at: a, breakdowns: {jam: {every: {fixed: 4 s}, by: busy, repair: {fixed: 7 s}, job: resume}},",
    )
    log, _ = ran(jam)
    assert pieces(log, "w1")[:2] == [(0, 4, 0, 0, 0.4), (11, 15, 0, 0.4, 0.8)]
    assert spans(log, log["kind"] == TOOL)[:3] == [(2, 4), (4, 8), (11, 13)]
    assert pieces(log, "w2")[:2] == [(0, 2, 0, 0, 0.2), (4, 12, 0, 0.2, 1)]


def test_a_job_that_is_scrapped_by_a_stop_lets_the_tool_go():
    jam = (
        "s1: {at: a,",
        "s1: {at: a, breakdowns: {jam: {every: {fixed: 4 s}, by: busy, repair: {fixed: 7 s}, job: scrap}},",
    )
    log, _ = ran(jam)
    assert spans(log, log["kind"] == TOOL)[:2] == [(2, 4), (4, 8)]


def test_states_of_a_worker_tell_waiting_for_a_tool_apart():
    log, p = ran(("from: 0.2, to: 0.6", "from: 0.5"))
    found = {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}
    waited = log.where((log["kind"] == WAIT) & (log["cause"] == NO_TOOL) & (log["worker"] == 1)).duration_s.sum()
    assert waited > 0 and found["worker_states", "w2", "tool"] == pytest.approx(waited / 60)
    parts = [value for (kpi, who, _), value in found.items() if (kpi, who) == ("worker_states", "w2")]
    assert sum(parts) == pytest.approx(1)


def test_a_tool_that_comes_free_while_the_station_stands_still_stays_free():
    """w2 wants it from 2 s on; when w1 gives it back, at 6 s, s2 is down, and goes on at 11 s."""
    log, _ = ran(("s2: {at: b,", "s2: {at: b, breakdowns: {jam: {every: {fixed: 4 s}, repair: {fixed: 7 s}}},"))
    assert spans(log, log["kind"] == TOOL)[:3] == [(2, 6), (11, 15), (15, 19)]
    assert [piece[:2] for piece in pieces(log, "w2")[:2]] == [(0, 2), (11, 15)]
