import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.geometry.flattening import SIEM
from tests.emulator.fitted import made, recorded


def postures(rng, *shape):
    return sphere.normalise(np.array([0.2, 0.1, 1.0]) + 0.6 * rng.normal(size=(*shape, 3)))


def test_the_reference_itself_is_the_origin():
    siem = SIEM.fit(postures(np.random.default_rng(0), 30, 5))
    assert np.abs(siem.forward(siem.reference)).max() < 1e-15


def test_a_coordinate_pair_is_as_long_as_the_angle_to_the_reference():
    siem = SIEM(np.array([[0.0, 0, 1], [1.0, 0, 0]]))
    there = np.array([[0.0, np.sin(0.7), np.cos(0.7)], [0.0, 0.0, 1.0]])
    assert np.allclose(np.linalg.norm(siem.forward(there).reshape(2, 2), axis=1), [0.7, np.pi / 2], atol=1e-14)


def test_coordinates_of_the_training_postures_have_mean_zero():
    y = postures(np.random.default_rng(1), 40, 6)
    assert np.abs(SIEM.fit(y).forward(y).mean(axis=0)).max() < 1e-11


def test_forward_and_back_keeps_made_postures_to_1e_12():
    y = postures(np.random.default_rng(2), 7, 50, 20)
    siem = SIEM.fit(y)
    assert np.abs(siem.inverse(siem.forward(y)) - y).max() < 1e-12


def test_back_and_forward_keeps_coordinates_to_1e_12():
    siem = SIEM.fit(postures(np.random.default_rng(3), 9, 20))
    flat = np.random.default_rng(4).uniform(-1.5, 1.5, (11, 40))
    assert np.abs(siem.forward(siem.inverse(flat)) - flat).max() < 1e-12


@pytest.mark.parametrize("name", ["deep_squat", "shoulder_abduction"])
def test_forward_and_back_keeps_aligned_recordings_to_1e_12(name):
    aligned = align([m.directions for m in recorded(name).motions[:12]], max_iterations=2).directions
    siem = SIEM.fit(aligned)
    assert np.abs(siem.inverse(siem.forward(aligned)) - aligned).max() < 1e-12


def test_place_size_and_proportions_do_not_enter():
    motions, _, _ = made("reach")
    skeleton, position = motions.skeleton, motions.motions[0].positions_m()
    siem = SIEM.fit(motions.motions[0].directions)
    longer = skeleton.bone_lengths(position[0]) * np.linspace(0.8, 1.3, skeleton.n_bones)
    bent = skeleton.positions(skeleton.directions(position), longer, position[:, 0])
    for changed in (position + np.array([3.0, -1.0, 0.5]), 1.7 * position, bent):
        difference = siem.forward(skeleton.directions(changed)) - siem.forward(skeleton.directions(position))
        assert np.abs(difference).max() < 1e-12


def test_a_bone_opposite_to_the_reference_is_refused():
    siem = SIEM(np.array([[0.0, 0, 1]]))
    with pytest.raises(ValueError, match="opposite"):
        siem.forward(np.array([[0.0, 0, -1]]))
