"""Made walks: people as the sources say, feet that stay where they stand."""

import numpy as np
import pytest

from emulator.cyclic.contacts import foot_skate_m, path_from_contacts
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import Body
from emulator.synthetic.cycles import make_cycles
from emulator.synthetic.gait import double_support, leg_m, step_length_m
from emulator.synthetic.walking import make_walks


@pytest.fixture(scope="module")
def walks():
    return make_walks(3, 4, seed=4)


def legs(take):
    for side in ("left", "right"):
        yield [take.positions_m[:, take.names.index(f"{side}_{joint}")] for joint in ("hip", "knee", "ankle", "toe")]


def test_a_step_at_the_walk_ratio_of_the_source_is_that_of_the_law():
    for speed in (0.8, 1.2, 1.6):
        cadence = 60 * speed / step_length_m(speed, 0.92)
        assert step_length_m(speed, 0.92) / cadence == pytest.approx(0.0063, rel=1e-9)


def test_bodies_of_other_sizes_walk_dynamically_alike():
    small, large = 0.75, 1.05
    speed = 1.1
    same_froude = speed * np.sqrt(large / small)
    assert step_length_m(same_froude, large) / large == pytest.approx(step_length_m(speed, small) / small)
    assert double_support(same_froude, large) == pytest.approx(double_support(speed, small))


def test_a_planted_foot_does_not_move_at_all(walks):
    for take in walks[0].takes:
        assert foot_skate_m(take.positions_m, take.contact).max() < 1e-9


def test_bones_are_rigid_and_no_knee_bends_backwards_or_locks(walks):
    skeleton = standard_skeleton()
    for take in walks[0].takes:
        assert np.ptp(skeleton.bone_lengths(take.positions_m), axis=0).max() < 1e-12
        for hip, knee, ankle, _ in legs(take):
            thigh, shank = knee - hip, ankle - knee
            flexion = np.degrees(
                np.arccos(np.sum(thigh * shank, 1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1))
            )
            assert flexion.min() > 4 and 50 < flexion.max() < 85
            assert np.all(np.cross(thigh, shank)[:, 1] > 0)


def test_the_swinging_toe_clears_the_floor(walks):
    for take in walks[0].takes:
        for *_, toe in legs(take):
            assert toe[:, 2].min() > 0.015


def test_speed_steps_and_distance_are_those_of_the_plan(walks):
    for take, plan in zip(walks[0].takes, walks[1].plans):
        root = take.positions_m[:, 0, 0]
        assert root[-1] - root[0] == pytest.approx(plan.place_m[-1], abs=0.01)
        assert plan.step_length_m[1:].mean() / plan.step_time_s.mean() == pytest.approx(plan.speed_m_per_s, rel=0.05)


def test_stride_times_scatter_by_two_per_cent():
    _, truth = make_walks(6, 6, seed=1, n_steps=(40,))
    strides = [plan.strike_s[2:] - plan.strike_s[:-2] for plan in truth.plans]
    cv = np.sqrt(np.mean([(one.std() / one.mean()) ** 2 for one in strides]))
    assert 0.017 < cv < 0.023


def test_the_same_seed_makes_the_same_walks():
    one, other = make_walks(1, 2, seed=3)[0], make_walks(1, 2, seed=3)[0]
    assert all(np.array_equal(a.positions_m, b.positions_m) for a, b in zip(one.takes, other.takes))


def test_the_way_follows_from_the_feet(walks):
    for take in walks[0].takes:
        way = path_from_contacts(take.positions_m - take.positions_m[:, :1], take.contact)
        root = take.positions_m[:, 0, :2] - take.positions_m[0, 0, :2]
        assert np.abs(way - root).max() < 0.07  # a label is right to a frame


def test_walks_of_nobody_are_refused():
    with pytest.raises(ValueError, match="found 0 workers"):
        make_walks(0, 1)


def test_a_leg_is_as_high_as_the_hip_of_the_body():
    assert leg_m(Body(1.75)) == pytest.approx(0.918)


@pytest.mark.parametrize("task", ["hammer", "crank"])
def test_made_cycles_begin_where_the_truth_says(task):
    recording, truth = make_cycles(task, 2, 2, seed=1)
    for take, beat_s in zip(recording.takes, truth.beat_s):
        assert take.duration_s == pytest.approx(beat_s[-1] + 0.6, abs=0.02)
        assert foot_skate_m(take.positions_m, take.contact).max() < 1e-9


def test_an_unknown_cycle_is_refused_with_the_nearest():
    with pytest.raises(ValueError, match="did you mean 'hammer'"):
        make_cycles("hamer")
