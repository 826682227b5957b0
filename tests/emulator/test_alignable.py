import re

import numpy as np
import pytest

from emulator.geometry import base_points as alignable
from emulator.geometry import sphere
from emulator.geometry.base_points import ROOM_RAD, Labels, base_points, checked, mean_posture

ARC = np.stack([[[np.cos(a), np.sin(a), 0.0], [0, 0, 1.0]] for a in np.linspace(0, 1, 41)])
NAMED = Labels(["ana/1", "ben/2"], ["left_knee", "head"])


def test_sound_sequences_come_back():
    assert np.array_equal(checked([ARC])[0], ARC)


def test_the_mean_posture_is_the_karcher_mean():
    assert np.allclose(mean_posture(np.stack([ARC, ARC]))[0], [np.cos(0.5), np.sin(0.5), 0])


def test_a_bone_that_turns_about_is_named():
    bad = ARC.copy()
    bad[5:, 0] *= -1
    with pytest.raises(
        ValueError, match=r"sequence 1 \(ben/2\): the bone to left_knee turns about between frames 4 and 5"
    ):
        checked([ARC, bad], NAMED)
    with pytest.raises(ValueError, match="sequence 1: bone 0 turns about"):
        checked([ARC, bad])


def pair(angle):
    """Fifty postures of one bone upright, one at this angle."""
    return np.array([[[[0.0, 0, 1]]] * 50 + [[[np.sin(angle), 0, np.cos(angle)]]]])


def room(postures, base):
    return np.pi - sphere.angle(np.broadcast_to(base, postures.shape), postures).max()


@pytest.mark.parametrize("angle", [0.5, 2.0, 2.8])
def test_the_base_is_the_mean_while_no_posture_is_near_its_opposite(angle):
    mean, base = base_points(pair(angle))
    assert np.array_equal(mean, base)
    assert np.allclose(mean, sphere.mean(pair(angle)[0]))


@pytest.mark.parametrize("angle", [3.0, 3.1, np.pi])
def test_a_base_with_an_opposite_posture_is_moved_as_little_as_gives_room(angle):
    mean, base = base_points(pair(angle))
    before = room(pair(angle), mean)
    assert before < 0.25
    assert ROOM_RAD <= room(pair(angle), base) < ROOM_RAD + 0.02
    assert sphere.angle(mean, base)[0] < ROOM_RAD - before + 0.03


@pytest.mark.parametrize("n", [40, 400, 1000])
def test_where_postures_are_everywhere_the_base_has_the_most_room_there_is(n):
    rng = np.random.default_rng(n)
    points = sphere.normalise(rng.normal(size=(n, 1, 3)))
    base = base_points(points)[1]
    elsewhere = sphere.normalise(rng.normal(size=(1000, 1, 3)))
    most = min(max(room(points, other) for other in elsewhere), ROOM_RAD)
    assert room(points, base) > most - 0.02


def test_directions_that_cancel_out_have_a_base():
    base = mean_posture(np.stack([ARC, -ARC]))
    assert room(np.stack([ARC, -ARC]), base) > ROOM_RAD - 0.01


def test_a_bone_moved_to_another_base_moves_no_other():
    odd = ARC.copy()
    odd[20, 0] *= -1
    mean, base = base_points(np.stack([ARC] * 20 + [odd]))
    assert np.array_equal(mean[1], base[1])
    assert not np.array_equal(mean[0], base[0])


def test_the_base_does_not_depend_on_the_order_of_the_postures():
    points = sphere.normalise(np.random.default_rng(1).normal(size=(300, 4, 3)))
    assert np.allclose(base_points(points)[1], base_points(points[::-1])[1], atol=1e-9)


def test_exp_undoes_log_at_a_moved_base():
    points = sphere.normalise(np.random.default_rng(2).normal(0.3, 1.0, (500, 8, 3)))
    base = np.broadcast_to(base_points(points)[1], points.shape)
    assert np.abs(sphere.exp(base, sphere.log(base, points)) - points).max() < 1e-13


def test_a_posture_that_no_base_avoids_is_named():
    everywhere = np.stack([ARC, ARC])
    mean = alignable_without_room(everywhere)
    assert re.search(r"1 \(ben/2\): at 50% of its time the bone to head points opposite to its base", mean)


def alignable_without_room(uniform):
    """What is said of postures one of which is opposite to the base that was found."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(alignable, "base_points", lambda u: (u[0, 0], u[0, 0]))
        spoiled = uniform.copy()
        spoiled[1, 20, 1] = -uniform[0, 0, 1]
        with pytest.raises(ValueError) as error:
            mean_posture(spoiled, NAMED)
    return str(error.value)
