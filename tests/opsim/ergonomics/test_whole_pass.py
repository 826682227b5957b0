"""The whole pass beside its naive twin: each row's performance again, posture by posture, without blocks or hours.

Postures follow a shift of pace: drawn from the same noise, stretched to the time that was really taken.
"""

from functools import cache

import numpy as np
import pytest
from human_plans import shipped
from plans import plan, ran

from opsim.engine.floor.run import run_plan
from opsim.ergonomics import trunk as exposure
from opsim.ergonomics.angles import AT
from opsim.ergonomics.measures import measures_of_positions, n_cells
from opsim.ergonomics.redraw import drawn_again, neck_neutrals_rad, performance_again, pieces_in_window
from opsim.ergonomics.scores.scoring import bounds_of, score
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.ledger import Booking
from opsim.ergonomics.strain.posture_limits import repeated_rows
from opsim.external_draws import OwnLuck
from opsim.laws.audit import audit
from opsim.log import SETUP, WORK
from opsim.streams import BLOCK
from opsim.subjects.tasks.distributions import Fixed
from opsim.subjects.tasks.variability import switched
from opsim.task_model import takes_shift

CELL = """
opsim: 1
name: cell
run: {start: Mon 05:57, horizon: 4 min, warm_up: 1 min, seed: 3}
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
    """Of six minutes of work to a millisecond. Where people tire a block is cut by its slowest of all rows, and one
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


SLOWED_POSTURES_CELL = """
opsim: 1
name: cell
run: {horizon: 20 min, seed: 3}
libraries: {work: libraries/bench_work.npz, moves: libraries/public_movements.npz, walks: libraries/walking.npz}
walking: {emulator: walks/walk}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  lift: {emulator: moves/deep_squat}
  kit: {motions: [work/reach, work/fasten]}
  fetch: {motions: [work/reach, {walk: 3 m}, work/place]}
  timed: {fixed: 5 s}
stations: {s: {at: a, tasks: [lift, kit, fetch, timed], buffer: 1}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {skills: {s: 1.0}}}
human: {fatigue: {model: lffrm, tires_half_in: 5 min, slows: 0.5}}
"""


@cache
def made():
    return plan(SLOWED_POSTURES_CELL)


@cache
def made_log():
    log = run_plan(made())
    audit(log, made())
    return log


def luck(of=None):
    of = of or made()
    return OwnLuck("ana", {task.name: task.model for task in of.tasks}, of.seed, 0, 0, of.workers[0].body)


def shifts(value=0.0, row=5):
    found = np.zeros(BLOCK)
    found[row] = value
    return found


@pytest.mark.parametrize("task", ["lift", "kit", "fetch"])
def test_no_shift_gives_the_same_bits_through_the_condition(task):
    model = {one.name: one.model for one in made().tasks}[task]
    plain, asked = (
        model.sample(BLOCK, np.random.default_rng(7), condition=condition)
        for condition in (None, {"log_duration_shift": np.zeros(BLOCK)})
    )
    assert np.array_equal(plain.duration_s, asked.duration_s)
    assert np.array_equal(plain[:4].directions(n_times=9), asked[:4].directions(n_times=9))


@pytest.mark.parametrize("task", ["lift", "kit", "fetch"])
def test_only_who_is_shifted_moves_and_takes_so_much_longer(task):
    plain, slowed = luck().performance(task, 0).block, luck().slowed(task, 0, shifts(0.3))
    others = np.arange(BLOCK) != 5
    assert np.array_equal(np.asarray(slowed.duration_s)[others], np.asarray(plain.duration_s)[others])
    assert slowed.duration_s[5] / plain.duration_s[5] == pytest.approx(np.exp(0.3), rel=0.02)
    moved = np.abs(slowed.directions(n_times=9) - plain.directions(n_times=9)).max(axis=(1, 2, 3))
    assert moved[5] > 1e-4
    assert not moved[others].any()


def test_what_takes_no_shift_is_left_as_it_is():
    squat = {one.name: one.model for one in made().tasks}["lift"]
    assert takes_shift(squat)
    assert not takes_shift(Fixed(5.0)) and not takes_shift(switched(squat, "none"))
    own = luck()
    assert own.slowed("timed", 0, shifts(0.3)) is own.performance("timed", 3).block


def test_rows_are_drawn_with_their_own_shift():
    log, of = made_log(), made()
    pieces = pieces_in_window(log, of)
    assert pieces.pace_shift.max() > 0.1
    for block, some in drawn_again(pieces, 0, of):
        name = of.tasks[some.task[0]].name
        plain = luck(of).performance(name, int(some.k[0])).block
        longer = np.exp(some.pace_shift) if takes_shift(of.tasks[some.task[0]].model) else 1.0
        rows = some.k % BLOCK
        assert np.asarray(block.duration_s)[rows] == pytest.approx(plain.duration_s[rows] * longer, rel=0.03)


def test_a_performance_again_lasts_as_its_row_and_moves_with_its_shift():
    log, of = made_log(), made()
    rows = np.flatnonzero((log["kind"] == WORK) & (log["pace_shift"] > 0.1))
    for row in rows[:: max(1, rows.size // 6)]:
        again = performance_again(log, of, int(row))
        if log["progress_to"][row] == 1.0:
            assert again.duration_s == log["end_s"][row] - log["start_s"][row]
        if of.tasks[log["task"][row]].name == "lift":
            plain = luck(of).performance("lift", int(log["k"][row]))
            assert np.abs(again.directions(9) - plain.decoded("directions", n_times=9)).max() > 1e-4


def test_without_effects_nothing_is_shifted():
    plain = shipped("low_pallet", 0.3)
    log = run_plan(plain)
    assert pieces_in_window(log, plain).pace_shift is None
    work = np.isin(log["kind"], (WORK, SETUP))
    assert not log["pace_shift"][work].any()
    assert exposure.trunk_exposure(log, plain).seconds_by_degree.sum() > 0
