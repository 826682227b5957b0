"""The whole pass beside its naive twin: each row's performance again, posture by posture, without blocks or hours."""

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.angles import AT
from opsim.ergonomics.measures import measures_of_positions, n_cells
from opsim.ergonomics.redraw import neck_neutrals_rad, performance_again
from opsim.ergonomics.scores.scoring import bounds_of, score
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.ledger import Booking
from opsim.ergonomics.strain.posture_limits import repeated_rows
from opsim.log import WORK

CELL = """
opsim: 1
name: cell
run: {start: Mon 05:57, horizon: 6 min, warm_up: 1 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks:
  fasten: {emulator: bench/fasten, load: 3 kg, loaded: {from: 0.25, to: 0.5}}
  stoop:  {emulator: bench/stoop, load: 12 kg, handling: {grip: poor, sitting: false}}
stations: {low: {at: here, tasks: [stoop, fasten], servers: 2, buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}, ben: {skills: {low: 0.8}}}
"""
HUMAN = "human: {fatigue: {model: lffrm, tires_half_in: 10 min}}"


def naive(log, plan):
    """(workers, tasks, 4): seconds at RULA 5 or more, at least, at most; RULA seconds; seconds bent by 20 degrees."""
    found = np.zeros((len(plan.workers), len(plan.tasks), 4))
    neutral_rad = neck_neutrals_rad({task.name: task.model for task in plan.tasks})
    repeated, (low, high) = repeated_rows(log), plan.window_s
    for row in np.flatnonzero((log["kind"] == WORK) & (log.clipped_s(low, high) > 0)).tolist():
        rank, piece = int(log["task"][row]), performance_again(log, plan, row)
        task = plan.tasks[rank]
        cells = n_cells(piece.drawn.block, plan.ergonomics)
        joints_m = piece.drawn.decoded("positions_m", n_times=2 * cells + 1)[1::2]
        measures = measures_of_positions(joints_m, piece.skeleton.names, plan.ergonomics, neutral_rad[task.name])
        middle = (np.arange(cells) + 0.5) / cells
        carrying = (middle >= task.handling.start.share) & (middle < task.handling.end.share)
        rula = score(measures, bounds_of(task.handling), plan.ergonomics, bool(repeated[row]), False, carrying).rula
        whole_s = (piece.end_s - piece.start_s) / (piece.progress_to - piece.progress_from)
        begun_s = piece.start_s - piece.progress_from * whole_s
        for cell in range(cells):
            from_s, to_s = (begun_s + whole_s * edge / cells for edge in (cell, cell + 1))
            spent_s = min(to_s, piece.end_s, high) - max(from_s, piece.start_s, low)
            if spent_s > 0:
                bent = measures[cell, AT["trunk_flexion"]] >= 20
                counted = (rula[cell, 0] >= 5, rula[cell, 1] >= 5, rula[cell, 0], bent)
                found[int(log["worker"][row]), rank] += spent_s * np.array(counted, float)
    return found


@pytest.mark.parametrize(("human", "within_s"), [("", 1e-3), (HUMAN, 2.0)], ids=["fresh", "tired"])
def test_the_whole_pass_is_its_naive_twin(human, within_s):
    """Of ten minutes of work to a millisecond. Where people tire a block is cut by its slowest of all rows, and one
    performance again by its own time: frames begin elsewhere, and less than one of each performance scores otherwise.
    """
    log, plan = ran(CELL + human)
    booking = Booking(plan.start_s)
    fold(log, plan, [booking])
    ledger, expected = booking.close(), naive(log, plan)
    assert (np.nanmax(log["pace_shift"]) > 0) == bool(human) and set(ledger.key[:, 4]) == {5, 6}
    for rank in range(len(plan.workers)):
        own = ledger.where(ledger.key[:, 0] == rank).by("task", np.arange(len(plan.tasks)))
        assert own.from_s("rula", 5) == pytest.approx(expected[rank, :, 0], abs=within_s)
        assert own.from_s("rula_at_most", 5) == pytest.approx(expected[rank, :, 1], abs=within_s)
        assert own.score_seconds("rula") == pytest.approx(expected[rank, :, 2], abs=5 * within_s)
        assert own.from_s("trunk", 20) == pytest.approx(expected[rank, :, 3], abs=within_s)
    assert expected[:, :, 0].sum() > 10 and expected[:, :, 0].sum() < expected[:, :, 1].sum()
