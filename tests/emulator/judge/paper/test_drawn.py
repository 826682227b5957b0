from dataclasses import replace
from functools import cache

import numpy as np

from emulator.judge import distances
from emulator.judge.paper import (
    DRAWERS,
    N_PEOPLE,
    OURS,
    PWI,
    RECORDED,
    SIEM,
    SPAN,
    draws_of,
    people,
    roughness_over_time,
    scaled,
)
from tests.emulator.judge.paper.classes import drawing, lifts, still


@cache
def draws():
    return draws_of(lifts())


def test_as_many_are_drawn_as_recorded_on_the_same_part_of_the_clock():
    assert list(draws()) == [RECORDED, *DRAWERS]
    assert np.array_equal(draws()[RECORDED], lifts().aligned[:, SPAN])
    assert {made.shape for made in draws().values()} == {lifts().aligned[:, SPAN].shape}


def test_the_seed_decides_what_is_drawn_and_not_what_was_recorded():
    again, other = draws_of(lifts()), draws_of(replace(lifts(), seed=9))
    for name, made in draws().items():
        assert np.array_equal(made, again[name])
        assert np.array_equal(made, other[name]) == (name == RECORDED)


def test_people_are_seven_of_the_mean_body_with_their_root_at_zero():
    found = people(lifts(), draws())
    bones = np.mean([motion.bone_length_m for motion in lifts().motions.motions], axis=0)
    skeleton = lifts().motions.skeleton
    child = [i for i, parent in enumerate(skeleton.parents) if parent >= 0]
    for joints in found.values():
        assert joints.shape == (N_PEOPLE, skeleton.n_joints, 3) and np.all(joints[:, 0] == 0)
        length = np.linalg.norm(joints[:, child] - joints[:, [skeleton.parents[i] for i in child]], axis=-1)
        assert np.allclose(length, bones)
    first, last = draws()[SIEM][0][[0, -1]]
    again = skeleton.positions(np.stack([first, last]), bones, np.zeros((2, 3)))
    assert np.allclose(found[SIEM][[0, -1]], again)


def test_recordings_drawn_again_lie_on_the_recordings():
    points = scaled(draws_of(drawing(lifts(), lifts().aligned)))
    assert set(points) == set(DRAWERS)
    for recorded, drawn in points.values():
        assert recorded.shape == drawn.shape == (15, 2) and np.allclose(recorded, drawn, atol=1e-5)


def test_the_plane_keeps_the_distance_of_those_who_stand_still():
    """They lie far from everybody, so the first direction is the one from the recordings to them."""
    made = {RECORDED: lifts().aligned[:, SPAN], "still": still(lifts())[:, SPAN]}
    recorded, drawn = scaled(made)["still"]
    apart = np.linalg.norm(recorded.mean(axis=0) - drawn.mean(axis=0))
    between = distances(made["still"], made[RECORDED]).mean()
    assert 0.8 * between < apart < 1.1 * between
    assert np.ptp(recorded[:, 0]) + np.ptp(drawn[:, 0]) < apart


def test_points_of_the_recordings_come_first():
    recorded, drawn = scaled({RECORDED: lifts().aligned[:, SPAN], "few": draws()[SIEM][:4]})["few"]
    assert recorded.shape == (15, 2) and drawn.shape == (4, 2)


def test_pointwise_draws_are_rough_at_every_time_and_who_stands_still_is_not():
    found = roughness_over_time(draws() | {"still": still(lifts())[:, SPAN]})
    assert all(made.shape == (60,) for made in found.values())
    assert np.all(found[PWI] > 2 * found[RECORDED]) and found["still"].max() < 1e-12
    assert abs(found[OURS].mean() / found[RECORDED].mean() - 1) < 0.15
