"""Poses and their latent space: the way there and back."""

import numpy as np
import pytest

from emulator.cyclic.latent import PoseLatent, leg_length_m, path_of, poses_of, positions_of
from emulator.skeleton import standard_skeleton
from tests.made.rowing import RATE_HZ, made_rowing

SKELETON = standard_skeleton()


@pytest.fixture(scope="module")
def rowing():
    return [poses_of(take, SKELETON, RATE_HZ) for take in made_rowing(2, 2)[0]]


def turned_and_moved(positions, angle_rad, way_m):
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return positions @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]]) + way_m


def test_positions_come_back_from_poses_but_for_place_and_heading():
    take = turned_and_moved(made_rowing(1, 1)[0][0], 0.7, (3.0, -2.0, 0.0))
    poses = poses_of(take, SKELETON, RATE_HZ)
    back = positions_of(poses, SKELETON, SKELETON.bone_lengths(take)[0], RATE_HZ)
    root, yaw = path_of(poses, 1.0, RATE_HZ)
    assert np.allclose(root[0, :2], 0) and yaw[0] == 0
    home = turned_and_moved(take - take[0, SKELETON.root] * [1, 1, 0], -0.7, 0.0)
    assert np.allclose(np.diff(back, axis=0), np.diff(home, axis=0), atol=1e-9)
    assert np.allclose(back[..., :2], home[..., :2], atol=1e-9)


def test_poses_know_no_place_heading_or_size():
    take = made_rowing(1, 1)[0][0]
    one = poses_of(take, SKELETON, RATE_HZ)
    other = poses_of(1.2 * turned_and_moved(take, 2.0, (5.0, 1.0, 0.0)), SKELETON, RATE_HZ)
    for name in ("directions", "travel", "height"):
        assert np.allclose(getattr(one, name), getattr(other, name), atol=1e-9), name


def test_a_leg_is_thigh_and_shank():
    length_m = np.arange(1.0, SKELETON.n_bones + 1)
    bones = [SKELETON.bone_names.index(name) for name in ("left_knee", "left_ankle", "right_knee", "right_ankle")]
    assert leg_length_m(SKELETON, length_m) == length_m[bones].sum() / 2


def test_two_frames_are_no_motion():
    with pytest.raises(ValueError, match="3 frames"):
        poses_of(made_rowing(1, 1)[0][0][:2], SKELETON, RATE_HZ)


def test_all_components_give_the_poses_back(rowing):
    latent = PoseLatent.fit(rowing, components=1.0)
    back = latent.inverse(latent.forward(rowing[1]))
    assert np.allclose(back.directions, rowing[1].directions, atol=1e-8)
    assert np.allclose(back.travel, rowing[1].travel, atol=1e-3)


def test_few_components_still_give_unit_directions(rowing):
    latent = PoseLatent.fit(rowing, components=2)
    directions = latent.inverse(3 * latent.forward(rowing[0])).directions
    assert np.allclose(np.linalg.norm(directions, axis=-1), 1)


def test_the_share_of_energy_decides_how_many_components(rowing):
    latent = PoseLatent.fit(rowing, components=0.9)
    kept = latent.n_components
    assert latent.energy[kept - 1] >= 0.9 and (kept == 1 or latent.energy[kept - 2] < 0.9)
    assert np.all(np.diff(latent.energy) >= -1e-12) and latent.energy[-1] == pytest.approx(1)


def test_energy_is_what_the_latents_keep(rowing):
    latent = PoseLatent.fit(rowing, components=3)
    z = np.concatenate([latent.forward(poses) for poses in rowing])
    assert z[:, 0].std() == pytest.approx(1)
    ratio = z.var(axis=0) / z.var(axis=0).sum()
    assert np.allclose(np.cumsum(ratio), latent.energy[:3] / latent.energy[2])


def test_travel_does_not_form_the_components(rowing):
    faster = [type(poses)(poses.directions, 5 * poses.travel, poses.height) for poses in rowing]
    one, other = PoseLatent.fit(rowing, components=3), PoseLatent.fit(faster, components=3)
    assert np.allclose(one.forward(rowing[0]), other.forward(faster[0]), atol=1e-2)
    assert np.allclose(5 * one.inverse(np.ones(3)).travel, other.inverse(np.ones(3)).travel, rtol=1e-2, atol=1e-3)


def test_arrays_keep_a_latent_to_the_bit(rowing):
    latent = PoseLatent.fit(rowing, components=3)
    again = PoseLatent.from_arrays(latent.arrays())
    assert np.array_equal(latent.forward(rowing[0]), again.forward(rowing[0]))


@pytest.mark.parametrize(("components", "words"), [(0.0, "share"), (1.5, "share"), (0, "between 1"), (99, "between 1")])
def test_impossible_numbers_of_components_are_refused(rowing, components, words):
    with pytest.raises(ValueError, match=words):
        PoseLatent.fit(rowing, components=components)


def test_poses_that_never_change_are_refused(rowing):
    still = type(rowing[0])(rowing[0].directions[:1].repeat(5, 0), np.zeros((5, 3)), np.zeros(5))
    with pytest.raises(ValueError, match="never change"):
        PoseLatent.fit([still], components=1)
