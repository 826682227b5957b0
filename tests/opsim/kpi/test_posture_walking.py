"""Figures of walking, where it has postures."""

from dataclasses import replace

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi import figures
from opsim.kpi.catalogue import POSTURE, WALKING, headline
from opsim.log import WALK
from tests.opsim.ergonomics.made_work import Bending
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.made_walks import Walk, walking

FLOOR = """
opsim: 1
name: floor
run: {horizon: 2 h, warm_up: 1 h, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 0.2 m]}}
tasks: {bend: {fixed: 9 s}, glue: {dist: exponential, mean: 8 s}}
stations: {s1: {at: a, tasks: [bend], buffer: 1}, s2: {at: b, tasks: [glue], buffer: 1}}
products: {p: {route: [s1, s2]}}
release: {kind: saturated}
workers: {ana: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}, ben: {walk: 2 m/s, skills: {s1: 1.0, s2: 1.0}}}
"""
HOUR_S = 3600.0
TRUNK = ("trunk_beyond_60_min_per_h", "trunk_beyond_20_min_per_h", "trunk_flexion_mean_deg", "trunk_flexion_p95_deg")


class Leans(Walk):
    """Everybody leans by 25 degrees."""

    def sample(self, n, rng, **how):
        drawn = super().sample(n, rng, **how)
        return type(drawn)(drawn.distance_m, drawn.duration_s, drawn.n_steps, np.full(n, 25.5))


def floor():
    found = plan(FLOOR)
    found = replace(found, tasks=(replace(found.tasks[0], model=Bending()), found.tasks[1]))
    return walking(found, Leans())


def values(rows, of):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(made(rows, of), of, POSTURE) if f.kpi in POSTURE}


def bend(at, worker=0, k=0):
    return work(at, at + 9, 0, worker=worker, k=k)


def walk(at, worker=0, places=(0, 1), seconds=6):
    return row(WALK, at, at + seconds, worker=worker, places=places)


@pytest.fixture(scope="module")
def by_hand():
    """In an hour ana bends 10 times for 9 s and walks 20 times 6 m in 6 s, and once 0.2 m; ben walks once, in 3 s."""
    rows = [bend(HOUR_S + 100 * k, k=k) for k in range(10)]
    rows += [walk(HOUR_S + 50 + 100 * k) for k in range(20)] + [walk(HOUR_S + 3000, places=(1, 2), seconds=0.2)]
    return values([*rows, walk(HOUR_S + 1, 1, seconds=3)], floor())


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("walking_min_per_h", "ana", "", 2),
        ("walking_min_per_h", "ben", "", 3 / 60),
        ("walking_min_per_h", "", "", (2 + 3 / 60) / 2),
        ("steps_per_h", "ana", "", 20 * 12),
        ("step_length_m", "ana", "", 0.5),
        ("step_length_m", "ben", "", 0.6),
        ("step_length_m", "", "", 126 / 250),
        ("cadence_per_min", "ana", "", 120),
        ("trunk_beyond_20_min_per_h", "ana", "", 70 / 60),
        ("trunk_beyond_20_min_per_h", "ana", "walking", 2),
        ("trunk_beyond_20_min_per_h", "ana", "together", 2 + 70 / 60),
        ("trunk_beyond_60_min_per_h", "ana", "walking", 0),
        ("trunk_beyond_60_min_per_h", "ben", "together", 0),
        ("trunk_flexion_mean_deg", "ana", "", 45),
        ("trunk_flexion_mean_deg", "ana", "walking", 25.5),
        ("trunk_flexion_mean_deg", "ana", "together", (45 * 90 + 25.5 * 120) / 210),
        ("trunk_flexion_p95_deg", "ben", "walking", 25.95),
        ("trunk_flexion_share", "ana", "below_20", 20 / 3600),
        ("trunk_flexion_share", "ana", "walking_from_20", 120 / 3600),
        ("trunk_flexion_share", "ana", "walking_below_20", 0),
        ("trunk_flexion_share", "ana", "walking_unmeasured", 0.2 / 3600),
        ("trunk_flexion_share", "ana", "waits", 1 - 210.2 / 3600),
        ("posture_measured_share", "ana", "", 1),
        ("walking_measured_share", "ana", "", 120 / 120.2),
        ("walking_measured_share", "", "", 123 / 123.2),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected, rel=0.005, abs=1e-9)


def test_shares_of_the_window_sum_to_one(by_hand):
    for subject in ("", "ana", "ben"):
        shares = [value for (kpi, of, _), value in by_hand.items() if (kpi, of) == ("trunk_flexion_share", subject)]
        assert len(shares) == 8 and sum(shares) == pytest.approx(1, abs=1e-12)


def test_who_does_not_walk_takes_no_steps_and_has_no_step_length():
    found = values([bend(HOUR_S)], floor())
    assert found["walking_min_per_h", "ana", ""] == found["steps_per_h", "ana", ""] == 0
    assert np.isnan(found["step_length_m", "ana", ""]) and np.isnan(found["cadence_per_min", "ana", ""])
    assert found["trunk_beyond_20_min_per_h", "ana", "walking"] == 0
    assert np.isnan(found["trunk_flexion_mean_deg", "ana", "walking"])


def test_figures_of_work_are_those_without_walking():
    """The same names mean the same, and only parts and names of walking are new."""
    of = replace(floor(), horizon_s=4200.0)
    log = run_plan(of)
    with_it = {f[:3]: f.value for f in figures(log, of, POSTURE)}
    without = {f[:3]: f.value for f in figures(log, replace(of, walking=None), POSTURE)}
    same = without.keys() & with_it.keys()
    assert all(np.array_equal(with_it[key], without[key], equal_nan=True) for key in same)
    assert {key[2] for key in without.keys() - same} == {"not_at_work"}
    new = with_it.keys() - same
    assert {key[0] for key in new} <= {*WALKING, *TRUNK, "trunk_flexion_share"}
    assert not any(kpi in WALKING for kpi, *_ in without)


def test_walking_minutes_are_the_share_of_time_that_workers_walk():
    of = walking(plan(FLOOR.replace(", ben: {walk: 2 m/s, skills: {s1: 1.0, s2: 1.0}}", "")))
    found = {f[:3]: f.value for f in figures(run_plan(of), of, POSTURE)}
    share = found["worker_states", "ana", "walk"]
    assert found["walking_min_per_h", "ana", ""] == pytest.approx(60 * share, rel=1e-9) and share > 0.05
    metres = found["steps_per_h", "ana", ""] * found["step_length_m", "ana", ""]
    assert metres == pytest.approx(found["walked_m", "ana", ""], rel=1e-6)


def test_who_walks_faster_walks_less_long_and_with_longer_steps(by_hand):
    assert by_hand["step_length_m", "ben", ""] > by_hand["step_length_m", "ana", ""]


def test_how_much_walking_was_measured_stands_beside_what_was_asked_of_it():
    assert headline(["steps_per_h"]) == {"steps_per_h", "walking_measured_share", "posture_measured_share"}
    assert "walking_measured_share" not in headline(["trunk_flexion_mean_deg"])
