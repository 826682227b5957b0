"""Postures follow a shift of pace: drawn from the same noise, stretched to the time that was really taken."""

from functools import cache

import numpy as np
import pytest
from human_plans import shipped
from plans import plan

from opsim.engine.floor import run_plan
from opsim.ergonomics import trunk as exposure
from opsim.ergonomics.redraw import drawn_again, performance_again, pieces_in_window
from opsim.external_draws import OwnLuck, takes_shift
from opsim.laws import audit
from opsim.log import SETUP, WORK
from opsim.streams import BLOCK
from opsim.tasks.distributions import Fixed
from opsim.tasks.variability import switched

CELL = """
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
    return plan(CELL)


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
