import numpy as np

from opsim.ergonomics.angles import CANONICAL, bone_chain, joint_places


def test_a_parent_comes_before_its_children_however_joints_are_numbered():
    """Joint 2 is the root; 0 hangs on 1, 1 on 3, 3 on 2: bones end at joints 0, 1 and 3."""
    assert bone_chain((1, 3, -1, 2)).tolist() == [[2, 2, 3], [1, 3, 1], [0, 1, 0]]


def test_places_of_joints_that_are_missing_are_beyond_the_last():
    places = joint_places(("neck", "pelvis", "tail"))
    assert places[CANONICAL.index("pelvis")] == 1 and places[CANONICAL.index("neck")] == 0
    assert np.count_nonzero(places == 3) == len(CANONICAL) - 2
