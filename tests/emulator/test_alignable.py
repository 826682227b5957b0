import numpy as np
import pytest

from emulator import sphere
from emulator.alignable import Labels, checked, mean_posture

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


def test_a_posture_opposite_to_the_mean_is_named_with_how_many_are():
    other = ARC.copy()
    other[:, 1] *= -1
    with pytest.raises(ValueError, match=r"2 \(c\): at 0% of its time the bone to head points opposite .*\(1 of 3"):
        mean_posture(np.stack([ARC, ARC, other]), Labels(["a", "b", "c"], ["left_knee", "head"]))


def test_directions_that_cancel_out_have_no_mean():
    with pytest.raises(ValueError, match="bone 0 cancel out"):
        mean_posture(np.stack([ARC, -ARC]))


def test_nearly_opposite_is_refused_and_far_from_it_is_not():
    def pair(angle):
        ends = [[0.0, 0, 1], [np.sin(angle), 0, np.cos(angle)]]
        return np.array([[[ends[0]]] * 50 + [[ends[1]]]])

    assert np.allclose(np.linalg.norm(mean_posture(pair(2.9)), axis=-1), 1)
    with pytest.raises(ValueError, match="opposite"):
        mean_posture(pair(3.12))
    assert sphere.angle(np.array([0, 0, 1.0]), np.array([0, 0, -1.0])) == pytest.approx(np.pi)
