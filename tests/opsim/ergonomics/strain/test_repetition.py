"""Repeated work, counted from rows alone.

Arms before and behind the trunk.

Movements beyond an angle.

Walking within a task, told by feet.

Zones of EN 1005-4 and movements a minute.
"""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import ran

from opsim.ergonomics.angles import AT, CANONICAL
from opsim.ergonomics.angles import COLUMNS as COLUMNS_of_stepping
from opsim.ergonomics.measures import measures_of_positions
from opsim.ergonomics.strain.energy import stepping
from opsim.ergonomics.strain.posture_limits import (
    CONDITIONAL,
    NOT_RECOMMENDED,
    begun,
    per_minute,
    repeated_rows,
    verdicts,
    zoned_angles_deg,
)
from opsim.ergonomics.strain.static_holds import Movements, arm_angle_deg, movements
from opsim.log import COLUMNS, SETUP, WAIT
from opsim.subjects.exposure.strain_figures import repetitions
from tests.opsim.ergonomics.bodies import arm, bent, standing, turn
from tests.opsim.ergonomics.made_frames import made_frames
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.kpi.made_logs import made, row, work

PLAN = made_plan()


def log_of(begins, worker=0, task=BEND, lasting=1.0):
    return made([work(t, t + lasting, 0, worker=worker, task=task, k=k) for k, t in enumerate(begins)], PLAN)


def test_four_beginnings_in_a_minute_are_repeated_work():
    """0, 15, 30, 45: three cycles of 15 s are 4 a minute. The fifth, 46 s later, makes 4 in 76 s with those before."""
    assert repeated_rows(log_of([0, 15, 30, 45, 91])).tolist() == [True] * 4 + [False]


def test_a_cycle_of_15_seconds_is_4_a_minute_and_a_longer_one_is_not():
    """A cycle of 16 s is 3.75 a minute, one of 20 s is 3, though four of them begin within a minute."""
    assert repeated_rows(log_of(15.0 * np.arange(9))).all() and repeated_rows(log_of(0.1 + 15.0 * np.arange(9))).all()
    for cycle_s in (15.1, 16.0, 19.9, 20.0):
        assert not repeated_rows(log_of(cycle_s * np.arange(9))).any()
    assert repeated_rows(log_of([0, 1, 2, 45])).all() and not repeated_rows(log_of([0, 1, 2, 45.1])).any()


def test_attended_runs_of_two_stations_are_each_a_beginning():
    """Two stations that one worker attends in turn count their own runs: k is 0, 0, 1, 1."""
    rows = [work(10 * i, 10 * i + 9, i % 2, worker=0, task=BEND, k=i // 2) for i in range(6)]
    log = made(rows, PLAN)
    assert begun(log).size == 6 and repeated_rows(log).all()


def test_a_performance_that_somebody_helps_with_begins_once():
    """Its parts go at paces of their own and have numbers of their own (``performance_id``), but one k."""
    rows = [list(work(10 * i, 10 * i + 10, 0, worker=0, k=0, progress=(i / 4, (i + 1) / 4))) for i in range(4)]
    for number, one in enumerate(rows):
        one[list(COLUMNS).index("performance_id")] = number
    log = made([tuple(one) for one in rows], PLAN)
    assert len(set(log["performance_id"])) == 4 and begun(log).size == 1


ATTENDED = """
opsim: 1
name: attended
run: {horizon: 10 min}
layout: {places: {a: [0 m, 0 m]}}
tasks: {mill: {fixed: 10 s, automatic: attended}}
stations: {s0: {at: a, tasks: [mill], buffer: 1}, s1: {at: a, tasks: [mill], buffer: 1}}
products: {p: {route: [ROUTE]}}
release: {kind: saturated}
workers: {ana: {skills: {s0: 1.0, s1: 1.0}}}
outputs: [repetitions_per_min]
"""


@pytest.mark.parametrize("route", ["s0", "s0, s1"])
def test_who_attends_runs_of_ten_seconds_does_six_a_minute_at_however_many_stations(route):
    log, plan = ran(ATTENDED.replace("ROUTE", route))
    found = {(f.subject, f.part): f.value for f in repetitions(log, plan)}
    assert found["ana", ""] == pytest.approx(6.0) and found["ana", "most"] == pytest.approx(6.0)


def test_workers_and_tasks_are_counted_each_by_itself():
    rows = [work(10 * i, 10 * i + 1, 0, worker=i % 2, task=BEND, k=i) for i in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()
    rows = [work(10 * i, 10 * i + 1, 0, worker=0, task=(BEND, COUNT)[i % 2], k=i) for i in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()


def test_pieces_of_one_performance_are_one_beginning():
    pieces = [work(10 * i, 10 * i + 5, 0, worker=0, k=0, progress=(i / 4, (i + 1) / 4)) for i in range(4)]
    assert not repeated_rows(made(pieces, PLAN)).any()


def test_a_later_piece_is_marked_as_its_performance():
    rows = [work(t, t + 1, 0, worker=0, k=k) for k, t in enumerate((0, 5, 10))]
    rows += [work(15, 16, 0, worker=0, k=3, progress=(0, 0.5)), work(500, 501, 0, worker=0, k=3, progress=(0.5, 1))]
    assert repeated_rows(made(rows, PLAN)).all()


def test_only_work_of_workers_is_repeated():
    rows = [row(WAIT, t, t + 1, worker=0) for t in range(6)] + [work(t, t + 1, 0, task=BEND, k=t) for t in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()
    rows = [row(SETUP, t, t + 1, worker=0, station=0, task=BEND, k=t, progress=(0, 1)) for t in range(6)]
    assert repeated_rows(made(rows, PLAN)).all()


def naive(log, times=4):
    """Any four beginnings of one worker and task whose rate, cycles over the time they take, is 4 a minute or more."""
    begins = [(log["worker"][i], log["task"][i], log["start_s"][i]) for i in range(len(log))]
    found = np.zeros(len(log), bool)
    for some in combinations(range(len(log)), times):
        times_s = [begins[i][2] for i in some]
        alike = len({begins[i][:2] for i in some}) == 1
        if alike and (times - 1) * 60 >= times * (max(times_s) - min(times_s)):
            found[list(some)] = True
    return found


events = st.tuples(st.integers(0, 1), st.sampled_from([BEND, COUNT]), st.integers(0, 150))


@given(st.lists(events, max_size=16, unique_by=lambda e: (e[0], e[2])))
def test_sliding_is_the_naive_counting(begins):
    rows = [work(t, t + 1, 0, worker=w, task=task, k=k) for k, (w, task, t) in enumerate(begins)]
    log = made(rows, replace(PLAN))
    assert np.array_equal(repeated_rows(log), naive(log))


@pytest.mark.parametrize(
    ("flexion", "abduction", "elevation", "angle"),
    [
        (30.0, 0.0, 30.0, 30.0),
        (-30.0, 0.0, 30.0, -30.0),
        (-4.9, 0.0, 4.9, 4.9),
        (-5.1, 0.0, 5.1, -5.1),
        (-20.0, 80.0, 80.6, 80.6),  # asin(cos 80 x sin 20) = 3.4 degrees out of the plane of the trunk: to the side
        (-20.0, 30.0, 35.5, -35.5),  # asin(cos 30 x sin 20) = 17.2
        (-170.0, 0.0, 170.0, 170.0),  # straight up and a little back: above the head, not behind the trunk
        (np.nan, np.nan, 40.0, 40.0),
        (-30.0, 0.0, np.nan, np.nan),
    ],
)
def test_arms_by_hand(flexion, abduction, elevation, angle):
    names = {"flexion": flexion, "abduction": abduction, "elevation": elevation}
    frames = made_frames(1, **{f"right_arm_{name}": value for name, value in names.items()})
    assert arm_angle_deg(frames.measures, "right") == pytest.approx([angle], nan_ok=True)
    assert arm_angle_deg(frames.measures, "left").tolist() == [0.0]


@pytest.mark.parametrize("trunk", [0.0, 40.0])
@pytest.mark.parametrize(("back", "angle"), [(30.0, -1), (-30.0, 1), (-2.0, 1)])
def test_arms_of_bodies_are_behind_their_own_trunk(back, angle, trunk):
    """An arm turned 30 degrees back from the trunk is behind it, upright and bent alike; it keeps its elevation."""
    body = bent(flexion=trunk, body=arm(standing(), "left", turn([0, 1, 0], back)))
    measures = measures_of_positions(body[None], CANONICAL)
    elevation = measures[:, AT["left_arm_elevation"]]
    assert elevation == pytest.approx(abs(trunk + back))
    assert arm_angle_deg(measures, "left") == pytest.approx(angle * elevation)


@given(st.floats(-180, 180), st.floats(-90, 90), st.floats(0, 180))
def test_only_the_sign_of_elevation_changes(flexion, abduction, elevation):
    names = {"flexion": flexion, "abduction": abduction, "elevation": elevation}
    frames = made_frames(1, **{f"left_arm_{name}": value for name, value in names.items()})
    assert np.abs(arm_angle_deg(frames.measures, "left")) == elevation


def test_a_movement_begins_beyond_the_edge_and_ends_well_below_it():
    """Up, a little back (17 is within 5 of 20), up again: one; right back to 14, up: another."""
    angle = np.array([0.0, 25.0, 17.0, 25.0, 14.0, 18.0, 21.0, np.nan, 30.0])
    assert np.flatnonzero(movements(angle, 20.0)).tolist() == [1, 6]
    assert movements(np.array([30.0, 30.0]), 20.0).tolist() == [True, False]
    assert movements(np.empty(0), 20.0).size == 0


def naive_movements(angle, beyond, back):
    up, found = False, []
    for value in angle:
        found.append(not up and value > beyond)
        up = True if value > beyond else False if value < beyond - back else up
    return found


courses = st.lists(st.sampled_from([0.0, 14.9, 15.0, 18.0, 20.0, 20.1, 40.0, np.nan]), max_size=40)


@given(courses, st.lists(st.integers(0, 40), max_size=3))
def test_movements_are_the_naive_ones_wherever_a_day_is_cut(angle, cuts):
    expected = naive_movements(angle, 20.0, 5.0)
    assert movements(np.array(angle), 20.0).tolist() == expected
    one = Movements(20.0)
    parts = np.split(np.array(angle), sorted(min(cut, len(angle)) for cut in cuts))
    assert np.concatenate([one.next(part) for part in parts]).tolist() == expected


def walks(left_m, right_m=0.0, every_s=0.1):
    left_m = np.asarray(left_m, float)
    measures = np.zeros((left_m.size, len(COLUMNS_of_stepping)))
    measures[:, AT["left_ankle_up_m"]], measures[:, AT["right_ankle_up_m"]] = left_m, right_m
    seconds = np.broadcast_to(np.asarray(every_s, float), left_m.shape)
    return stepping(measures, np.cumsum(seconds) - seconds, seconds)


def swing(n, period_s=1.1):
    """Left foot up, right foot up, in turn: above 0 the left is higher, below 0 the right."""
    turn = 0.08 * np.sin(2 * np.pi * np.arange(n) * 0.1 / period_s)
    return np.maximum(turn, 0.0), np.maximum(-turn, 0.0)


def test_feet_that_leave_the_floor_in_turn_walk():
    assert walks(*swing(60)).all()


def test_who_stands_or_stands_on_one_foot_does_not_walk():
    assert not walks(np.zeros(50)).any()
    assert not walks(np.r_[np.zeros(10), np.full(30, 0.3), np.zeros(10)]).any()


def test_a_foot_long_after_the_other_is_no_step():
    left, right = np.zeros(60), np.zeros(60)
    left[5:10], right[40:45] = 0.1, 0.1
    assert not walks(left, right).any()
    right[:], right[14:20] = 0.0, 0.1
    found = np.flatnonzero(walks(left, right, every_s=0.11))
    assert (found[0], found[-1]) == (9, 19)  # middles within 0.6 s of that of frame 14: 5 frames of 0.11 s either side


def test_only_the_walked_part_walks_and_unknown_feet_stand():
    left, right = swing(40)
    still = np.zeros(40)
    found = walks(np.r_[still, left, still], np.r_[still, right, still])
    assert not found[:35].any() and found[46:76].all() and not found[90:].any()
    assert not walks(np.full(20, np.nan)).any() and walks(np.empty(0)).size == 0


MINUTE_S, NEVER = np.arange(60.0), np.zeros(60, bool)


def test_movements_are_counted_by_the_minute_of_the_clock():
    start_s = np.array([0.0, 30.0, 59.9, 60.0, 130.0])
    assert per_minute(np.array([True, True, False, True, False]), start_s).tolist() == [2, 2, 2, 1, 0]


def test_who_stands_upright_is_accepted_a_degree_backward_too():
    """57 s at -1 degree and three bends of a second to 25: the bends are too often, standing is not."""
    angle = np.full(60, -1.0)
    angle[[10, 30, 50]] = 25.0
    for region in ("trunk", "neck"):
        found = verdicts(angle, NEVER, MINUTE_S, region)
        assert (found == NOT_RECOMMENDED).sum() == (3 if region == "trunk" else 0)
        assert not found[angle < 0].any()


def test_each_zone_has_the_frequency_of_the_movements_into_it():
    """Back once, and three bends to 40: bending is too often, leaning back is not."""
    angle = np.zeros(60)
    angle[[10, 20, 30]], angle[40:50] = 40.0, -10.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert (found[[10, 20, 30]] == NOT_RECOMMENDED).all() and (found[40:50] == CONDITIONAL).all()
    twice = angle.copy()
    twice[52:] = -10.0
    assert (verdicts(twice, NEVER, MINUTE_S, "trunk")[40:50] == NOT_RECOMMENDED).all()


def test_from_40_degrees_to_70_again_and_again_is_often_in_zone_3_and_seldom_in_zone_2():
    angle = np.full(60, 40.0)
    angle[[10, 20, 30]] = 70.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert (found == NOT_RECOMMENDED).tolist() == (angle == 70.0).tolist()


def test_who_bends_twice_and_deep_once_is_seldom_in_zone_3():
    angle = np.zeros(60)
    angle[[10, 20]], angle[30] = 40.0, 70.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert found[30] == CONDITIONAL and (found[[10, 20]] == NOT_RECOMMENDED).all()


def test_an_arm_is_behind_the_trunk_by_its_flexion():
    frames = made_frames(60, left_arm_elevation=30.0, left_arm_flexion=-30.0, right_arm_elevation=30.0)
    angles = zoned_angles_deg(frames.measures)
    assert (angles["left_arm"] == -30.0).all() and (angles["right_arm"] == 30.0).all()
    assert (verdicts(angles["left_arm"], NEVER, MINUTE_S, "left_arm") == CONDITIONAL).all()
    assert (verdicts(angles["left_arm"], ~NEVER, MINUTE_S, "left_arm") == NOT_RECOMMENDED).all()
    assert (verdicts(angles["right_arm"], ~NEVER, MINUTE_S, "right_arm") == CONDITIONAL).all()


def test_arms_that_rise_once_a_minute_are_accepted_and_twice_above_60_are_not():
    once, twice = np.zeros(60), np.zeros(60)
    once[10:14], twice[10:14], twice[30:34] = 70.0, 70.0, 70.0
    never, start_s = np.zeros(60, bool), np.arange(60.0)
    for angle, n in ((once, 0), (twice, 8)):
        assert (verdicts(angle, never, start_s, "left_arm") == 2).sum() == n


def test_arms_in_zone_2_become_too_much_ten_times_a_minute():
    start_s, never = np.arange(60.0), np.zeros(60, bool)
    for times, n in ((9, 0), (10, 10)):
        angle = np.zeros(60)
        angle[np.arange(times) * 5] = 40.0
        assert (verdicts(angle, never, start_s, "right_arm") == 2).sum() == n
