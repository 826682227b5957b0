"""What is in the hands of those who walk."""

from dataclasses import replace

import numpy as np
import pytest
from plans import plan, run_plan

from opsim.ergonomics.scores.scoring import WALKING
from opsim.ergonomics.shift.day import days, said_of
from opsim.ergonomics.shift.frames import WALKING as WALKS
from opsim.ergonomics.shift.walks import carried_kg, carries
from opsim.history import walk_rows
from opsim.log import TRANSPORT, WALK
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.made_walks import walking

CELL = """
opsim: 1
name: carrying
run: {horizon: 30 min, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 6 m]}}
tasks: {cut: {fixed: 20 s}}
stations: {s1: {at: a, tasks: [cut], buffer: 3}, s2: {at: b, tasks: [cut], buffer: 3}, s3: {at: c, tasks: [cut]}}
products: {p: {route: [s1, s2], carried: true, mass: 4 kg, lot: 3, share: 0.5}, q: {route: [s2, s3], share: 0.5}}
release: {kind: poisson, every: 40 s}
workers:
  ana: {most_load: 5 kg, skills: {s1: 1.0, s2: 1.0, s3: 1.0}}
  ben: {skills: {s1: 1.0, s2: 1.0}}
"""


@pytest.fixture(scope="module")
def run():
    of = walking(plan(CELL))
    return of, run_plan(of)


def test_walks_from_station_to_station_with_a_job_that_is_carried_are_full_and_all_others_empty(run):
    of, log = run
    rows = walk_rows(log)
    full = carries(log, of, rows)
    ways = set(zip(log["place_from"][rows[full]].tolist(), log["place_to"][rows[full]].tolist()))
    assert ways == {(0, 1)} and set(log["product"][rows[full]].tolist()) == {0}
    assert 0 < full.sum() < rows.size


def test_a_lot_is_brought_in_several_ways_and_the_ways_back_are_empty():
    """12 kg of units of 4 kg, 5 kg at once: three ways there, two back."""
    ways = [row(WALK, 10 * n, 10 * n + 10, worker=0, places=(n % 2, 1 - n % 2), job=7) for n in range(5)]
    log = made([*ways, row(WALK, 60, 70, worker=0, places=(0, 1), job=7), row(TRANSPORT, 0, 50, job=7)], plan(CELL))
    assert carries(log, plan(CELL), walk_rows(log)).tolist() == [True, False, True, False, True, False]
    assert not carries(made(ways, plan(CELL)), plan(CELL), walk_rows(made(ways, plan(CELL)))).any()


def test_what_is_in_the_hands_is_as_much_as_he_may_carry_at_once():
    of = plan(CELL)
    assert (carried_kg(of, 0, 0), carried_kg(of, 1, 0), carried_kg(of, 1, 1)) == (4.0, 12.0, None)


def test_walking_frames_carry_what_the_walk_carries(run):
    of, log = run
    for frames in days(log, of):
        walks = frames.task == WALKS
        rows = walk_rows(log)
        full = dict(zip(rows.tolist(), carries(log, of, rows).tolist()))
        assert frames.carrying[walks].tolist() == [full[at] for at in frames.row[walks].tolist()]


def test_scores_of_walks_know_the_mass_of_what_is_carried():
    of = plan(CELL)
    found = said_of(WALKS, of, 0, 1)  # 12 kg: RULA 2 now and then, 3 steadily; REBA 2 (over 10 kg, no shock); OWAS 2
    assert (found.rula_force, found.reba_load, found.owas_load) == ((2, 3), (2, 2), (2, 2))
    assert (found.coupling, found.walking) == ((0, 3), True)
    unknown = said_of(WALKS, of, 1, 1)
    assert unknown == said_of(WALKS, of) == replace(WALKING, reba_load=(0, 2))
    light = replace(of, products=tuple(replace(one, mass_kg=0.0) for one in of.products))
    assert said_of(WALKS, light, 0).reba_load == (0, 0)
    assert np.isfinite(carried_kg(light, 0, 0))
