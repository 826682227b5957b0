import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made.scene import run_of, scene
from plans import CELL, plan

from opsim.log import TRANSPORT
from opsim.viewer.floor import NEAR_M, Site, facings, kept
from opsim.viewer.frame_corrections import STEP, amends, corners
from opsim.viewer.playback import DRAWN_S, stand_ins, with_walking
from opsim.viewer.pose import standing
from opsim.viewer.routes import Doing, placed
from opsim.viewer.segments import IN_HANDS, ON_VEHICLE
from opsim.viewer.skeletons import tree_of


def test_a_vehicle_is_always_somewhere():
    shown, plan = scene("forklift"), run_of("forklift").plan
    n = sum(pool.n for pool in plan.transporters)
    moves = shown.moves
    for time_s in np.random.default_rng(0).uniform(shown.low_s, shown.high_s, 40):
        there = (moves.start_s <= time_s) & (moves.end_s > time_s) & (moves.kind == ON_VEHICLE)
        assert there.sum() == n


def test_what_is_carried_is_in_the_hands_of_who_walks():
    shown, log = scene("walking_cell"), run_of("walking_cell").log()
    moves = shown.moves
    carried = np.flatnonzero(moves.kind == IN_HANDS)
    assert carried.size == ((log["kind"] == TRANSPORT) & (log["job"] >= 0)).sum()
    for row in carried[:20]:
        at = shown.segments.row(int(moves.worker[row]), float(moves.start_s[row]))
        assert shown.states[shown.segments.state[at]] == "walk"


def doing(performances, far_m):
    n = len(performances)
    alike = np.zeros(n, int)
    far = np.array([[far_m.get(performance, 0.0), 0.0] for performance in performances])
    return Doing(np.arange(n), alike, alike, alike, np.array(performances), far)


def ends(done, frames):
    """Where each row begins and ends along x, for who faces +x."""
    x, _, yaw = frames
    return list(zip(x.tolist(), (x + np.cos(yaw) * done.far_m[:, 0]).tolist()))


def still(n):
    return np.zeros(n), np.zeros(n), np.zeros(n)


def test_a_task_that_leads_somewhere_ends_at_the_bench():
    done = doing([4, 7, 5], {7: 3.0})
    assert np.array(ends(done, placed(done, still(3)))) == pytest.approx(np.array([(0, 0), (-3, 0), (0, 0)]))


def test_to_and_fro_meet():
    """Pick up, bring 3 m, put down, go back 3 m: each begins where the one before ended."""
    done = doing([1, 2, 3, 4, 5], {2: 3.0, 4: 3.0})
    found = placed(done, still(5))
    assert np.array(ends(done, found)) == pytest.approx(np.array([(0, 0), (0, -3), (-3, -3), (-3, 0), (0, 0)]))
    assert found[2] == pytest.approx([0, np.pi, np.pi, 0, 0])


def test_pieces_of_one_performance_have_one_frame():
    done = doing([2, 2, 3, 4], {2: 3.0, 4: 3.0})
    found = placed(done, still(4))
    assert found[0][0] == found[0][1] and found[2][0] == found[2][1]


def test_what_leads_nowhere_stays():
    done = doing([1, 2], {})
    assert np.array_equal(placed(done, still(2)), still(2))


WALKS = st.lists(st.tuples(st.integers(0, 2), st.sampled_from([1.0, 2.0, 2.001, 7.5, 30.0])), max_size=60)


@given(WALKS, st.sampled_from([1.0, 40.0, 400.0]))
def test_walks_are_shown_by_one_of_the_same_person_about_as_long(walks, whole_s):
    worker, long_m = np.array([w for w, _ in walks], int), np.array([m for _, m in walks])
    shown = stand_ins(worker, long_m, np.full(long_m.size, whole_s))
    assert np.array_equal(worker[shown], worker)
    assert np.all(np.abs(np.log(long_m[shown] / long_m)) < 0.3)
    assert np.array_equal(shown[shown], shown)
    if long_m.size * whole_s <= DRAWN_S:
        assert np.array_equal(shown, np.arange(long_m.size))


def test_walks_are_as_long_as_their_ways():
    """So that feet do not slide: drawn over the way between the spots, or stretched by a hundredth at most."""
    shown = scene("two_shift_plant")
    ways = [way for way in np.unique(shown.segments.way) if way >= 0]
    long_m = np.array([np.hypot(*np.diff(shown.ways.points_m(way), axis=0).T).sum() for way in ways])
    assert np.all(np.abs(np.log(long_m / shown.ways.own_m[ways])) < 0.011)


ALONE = """
opsim: 1
name: nobody here
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {cut: {fixed: 20 s, automatic: true}}
stations: {saw: {at: here, tasks: [cut], buffer: 1}}
products: {part: {route: [saw]}}
release: {kind: saturated}
"""


def stood(text):
    return standing(with_walking(plan(text))[0], 0)


def test_everybody_has_bones_of_the_skeleton_that_stands():
    found = stood(CELL)
    n_bones = len(tree_of(found.skeleton)[1]) - 1
    assert found.bone_m.shape == (3, n_bones) and np.all(found.bone_m >= 0)
    assert np.allclose(np.linalg.norm(found.directions, axis=1), 1)


def test_where_there_are_no_workers_nobody_stands():
    found = stood(ALONE)
    assert found.bone_m.shape == (0, 1)
    assert found.directions.shape == (1, 3) and np.isclose(np.linalg.norm(found.directions), 1)


PLACES = st.lists(
    st.tuples(st.integers(0, 30), st.integers(0, 30)).map(lambda p: (float(p[0]), float(p[1]))), min_size=1, max_size=8
)


def site(points):
    return Site([f"p{rank}" for rank in range(len(points))], tuple(points), [])


@given(PLACES, PLACES)
def test_a_place_with_the_same_around_it_faces_the_same_way_in_two_variants(points, far):
    one = site(points)
    other = site([*points, *((x + 30.0 + NEAR_M, y) for x, y in far)])
    alone, beside = facings(one, {}), facings(other, kept(other, one))
    assert beside[: len(points)] == alone
    assert kept(one, one) == dict(zip(one.names, alone))


def test_a_place_to_whose_side_something_came_is_looked_at_again():
    one, other = site([(0.0, 0.0), (9.0, 0.0)]), site([(0.0, 0.0), (9.0, 0.0), (1.0, 0.0)])
    assert set(kept(other, one)) == {"p1"}


BONE_M = np.array([0.5, 0.2])


def off(at_s):
    """(S, 2, 3) a foot that is turned at once at 0.7310 s, and a shin that is not."""
    found = np.zeros((at_s.size, 2, 3))
    found[:, 1, 2] = np.where(at_s < 0.731, 0.0, 0.06) * np.clip((0.75 - at_s) / 0.01, 0, 1)
    return found


def far(at_s):
    return (np.linalg.norm(off(at_s), axis=2) * BONE_M).max(axis=1)


def shown(knots, at_s):
    own = np.column_stack([np.interp(at_s, knots.at_s, STEP * knots.by[:, c]) for c in range(3)])
    return np.linalg.norm(off(at_s)[:, 1] - own, axis=1) * BONE_M[1]


def test_what_comes_at_once_is_met_at_once():
    knots = amends(far, off, BONE_M, 2.0, 50.0)
    assert set(knots.bone) == {1} and np.all(np.diff(knots.at_s) > 0) and len(knots) < 12
    assert shown(knots, np.linspace(0.0, 2.0, 20_011)).max() < 2.5e-4
    assert not knots.by[[0, -1]].any() and np.diff(knots.at_s).min() < 2e-6


def test_good_frames_are_left_alone():
    assert len(amends(lambda at_s: 0.9e-3 + 0 * at_s, off, BONE_M, 2.0, 50.0)) == 0


def test_corners_come_as_near_as_is_asked():
    at_s = np.linspace(0.0, 1.0, 200)
    by = np.column_stack([np.sin(9 * at_s), np.cos(5 * at_s), at_s])
    rows = corners(at_s, by, 0.02)
    line = np.column_stack([np.interp(at_s, at_s[rows], by[rows, c]) for c in range(3)])
    assert np.linalg.norm(line - by, axis=1).max() <= 0.02 and len(rows) < 40
    assert corners(at_s, np.outer(at_s, [1.0, 2.0, 3.0]), 1e-9) == pytest.approx([0, 199])
