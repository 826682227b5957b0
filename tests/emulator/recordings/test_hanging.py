"""On which joint each joint hangs."""

import numpy as np

from emulator.recordings.markers import depths, hung_as_bodies_are, hung_as_in_the_file, without_length
from emulator.skeleton import CANONICAL, EXTRA, Skeleton, standard_skeleton


def test_the_canonical_joints_hang_as_in_the_standard_skeleton():
    assert hung_as_bodies_are(CANONICAL) == standard_skeleton().parents


def test_any_part_of_a_body_with_a_pelvis_is_a_tree_with_the_pelvis_as_root():
    rng = np.random.default_rng(0)
    others = [*CANONICAL[1:], *EXTRA]
    for _ in range(200):
        joints = ("pelvis", *rng.choice(others, rng.integers(1, len(others)), replace=False).tolist())
        assert Skeleton(joints, hung_as_bodies_are(joints)).root == 0


def test_a_limb_does_not_hang_on_the_other_side():
    joints = ("pelvis", "left_hip", "right_knee", "right_wrist", "left_shoulder")
    parents = hung_as_bodies_are(joints)
    assert parents == (-1, 0, 0, 0, 0)


def test_children_of_those_left_out_hang_on_the_nearest_ancestor():
    assert hung_as_in_the_file((-1, 0, 1, 2, 3), [0, 2, 4]) == (-1, 0, 1)
    assert hung_as_in_the_file((-1, 0, 1, 0, 3), [2, 4]) is None
    assert depths((-1, 0, 1, 0)) == [0, 1, 2, 1]


def test_a_chain_of_joints_at_one_place_leaves_the_most_needed():
    joints = ("pelvis", "spine", "chest", "neck", "left_hip")
    places = np.zeros((3, 5, 3))
    places[:, 4] = 1.0
    assert sorted(without_length(joints, (-1, 0, 1, 2, 0), places)) == [1, 2, 3]
