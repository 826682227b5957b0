"""The body behind any row: pieces of one performance hang together, and together they are the whole."""

from itertools import pairwise

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.redraw import performance_again
from opsim.ergonomics.trunk import trunk_exposure
from opsim.history import BY_ANOTHER, HANDED_OVER, RESTARTED, RESUMED, job_pieces
from opsim.log import WAIT, WORK
from tests.opsim.ergonomics.made_work import BEND, made_plan
from tests.opsim.kpi.made_logs import made, work

FLOOR = """
opsim: 1
name: pieces
run: {start: Mon 06:00, horizon: 30 min, seed: 4}
layout: {places: {here: [0 m, 0 m]}}
libraries: {moves: libraries/public_movements.npz}
shifts: {day: {from: 06:00, to: 14:00, at_break: RULE, breaks: {BREAKS}}}
tasks: {lift: {emulator: moves/deep_squat}}
stations: {a: {at: here, tasks: [lift], buffer: 1}}
products: {p: {route: [a]}}
release: {kind: saturated}
workers: {ana: {shift: day, skills: {a: 1.0}}, ben: {skills: {a: 0.8}}}
"""
BREAKS = ", ".join(f"b{i}: {{at: 06:{2 * i + 1:02d}, lasts: 1 min}}" for i in range(14))


@pytest.fixture(scope="module", params=["resume", "resume_any", "restart"])
def run(request):
    return request.param, *ran(FLOOR.replace("RULE", request.param).replace("BREAKS", BREAKS))


def test_where_one_piece_ends_the_next_one_begins(run):
    """The same body where the same worker goes on; another one's own, at the same progress, where he took over."""
    rule, log, plan = run
    pieces = job_pieces(log)
    seen = 0
    for at in np.flatnonzero(np.isin(pieces.fate, (RESUMED, BY_ANOTHER, HANDED_OVER, RESTARTED))):
        one, rest = (performance_again(log, plan, int(pieces.row[i])) for i in (at, at + 1))
        if pieces.fate[at] == RESUMED:
            assert np.abs(one.positions_m(n_times=9)[-1] - rest.positions_m(n_times=9)[0]).max() < 1e-10
            assert (one.k, one.duration_s, one.number) == (rest.k, rest.duration_s, rest.number)
        elif pieces.fate[at] == RESTARTED:
            assert rest.progress_from == 0 and (rest.worker, rest.k) != (one.worker, one.k)
        else:
            assert rest.progress_from == one.progress_to and rest.worker != one.worker
        seen += 1
    assert seen >= 3, rule


def test_the_seconds_of_a_piece_are_its_share_of_the_whole(run):
    _, log, plan = run
    for row in np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0))[:40].tolist():
        piece = performance_again(log, plan, row)
        seconds = (piece.progress_to - piece.progress_from) * piece.duration_s
        assert seconds == pytest.approx(piece.end_s - piece.start_s, abs=3e-6)


def test_a_row_without_work_has_no_performance(run):
    _, log, plan = run
    row = int(np.flatnonzero(log["kind"] == WAIT)[0])
    with pytest.raises(ValueError, match=f"row {row} is no work of a worker"):
        performance_again(log, plan, row)


@pytest.mark.parametrize("cuts", [(0.5,), (0.1, 0.4, 0.8)])
def test_pieces_bend_as_much_as_the_whole(cuts):
    plan = made_plan()
    whole = trunk_exposure(made([work(0, 9, 0, worker=0, k=0, task=BEND)], plan), plan)
    edges = [0.0, *cuts, 1.0]
    rows = [
        work(100 * i + 9 * a, 100 * i + 9 * b, 0, worker=0, k=0, task=BEND, progress=(a, b))
        for i, (a, b) in enumerate(pairwise(edges))
    ]
    parts = trunk_exposure(made(rows, plan), plan)
    assert parts.seconds_by_degree == pytest.approx(whole.seconds_by_degree, abs=1e-9)


def test_who_takes_over_bends_through_his_own_second_half():
    plan = made_plan()
    rows = [work(0, 4.5, 0, worker=0, k=0, task=BEND, progress=(0, 0.5))]
    rows += [work(5, 9.5, 0, worker=1, k=0, task=BEND, progress=(0.5, 1))]
    found = trunk_exposure(made(rows, plan), plan)
    assert found.beyond_s(60)[:2] == pytest.approx([1.5, 1.5], rel=0.01)
