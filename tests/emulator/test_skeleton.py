import numpy as np
import pytest

from emulator.skeleton import CANONICAL, Skeleton, canonical_name, canonical_names, standard_skeleton
from tests.naive import naive_positions

RNG = np.random.default_rng(1)
BODY = standard_skeleton()
PLACES = RNG.normal(size=(7, BODY.n_joints, 3))


@pytest.mark.parametrize(
    ("alias", "name"),
    [
        ("lshoulder", "left_shoulder"),
        ("l_shoulder", "left_shoulder"),
        ("LeftShoulder", "left_shoulder"),
        ("shoulder_l", "left_shoulder"),
        ("RShoulder", "right_shoulder"),
        ("rtoe", "right_toe"),
        ("Hips", "pelvis"),
        ("lhip", "left_hip"),
        ("lhumerus", "left_elbow"),
        ("UpperLeg_R", "right_hip"),
        ("root", "pelvis"),
    ],
)
def test_aliases_lead_to_the_canonical_name(alias, name):
    assert canonical_name(alias) == name


def test_canonical_names_are_their_own_aliases():
    assert tuple(canonical_name(name) for name in CANONICAL) == CANONICAL
    assert len(set(CANONICAL)) == 21


def test_an_unknown_joint_is_refused_with_the_nearest_word():
    with pytest.raises(ValueError, match="'lsholder' is not known; did you mean 'left_shoulder'"):
        canonical_name("lsholder")


def test_a_skeleton_is_read_in_its_own_dialect():
    names = ["Hips", "Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L"]
    assert canonical_names(names) == ("pelvis", "left_clavicle", "left_shoulder", "left_elbow", "left_wrist")
    assert canonical_names(["root", "lfemur", "ltibia", "lfoot", "ltoes"])[1:] == (
        "left_knee",
        "left_ankle",
        "left_foot",
        "left_toe",
    )


def test_directions_of_a_known_posture():
    line = Skeleton(("pelvis", "spine", "head"), (-1, 0, 1))
    places = np.array([[0, 0, 0], [0, 0, 2.0], [3.0, 0, 2.0]])
    assert line.directions(places).tolist() == [[0, 0, 1], [1, 0, 0]]
    assert line.bone_lengths(places).tolist() == [2, 3]
    assert line.bone_names == ("spine", "head") and line.edges == ((0, 1), (1, 2))


def test_positions_come_back_from_directions():
    back = BODY.positions(BODY.directions(PLACES), BODY.bone_lengths(PLACES), PLACES[:, BODY.root])
    assert np.abs(back - PLACES).max() < 1e-14


def test_positions_are_the_naive_positions():
    order = RNG.permutation(BODY.n_joints)
    shuffled = Skeleton(
        tuple(BODY.names[j] for j in order),
        tuple(-1 if BODY.parents[j] < 0 else int(np.flatnonzero(order == BODY.parents[j])[0]) for j in order),
    )
    lengths, root = RNG.uniform(0.1, 0.5, shuffled.n_bones), RNG.normal(size=3)
    directions = shuffled.directions(PLACES[0])
    naive = naive_positions(list(shuffled.parents), directions, lengths, root)
    assert np.allclose(shuffled.positions(directions, lengths, root), naive, atol=1e-14)


def test_directions_forget_place_size_and_proportions():
    directions = BODY.directions(PLACES)
    assert np.allclose(BODY.directions(2.5 * PLACES + np.array([3.0, -1.0, 0.2])), directions, atol=1e-13)
    other_body = BODY.positions(directions, RNG.uniform(0.1, 0.6, BODY.n_bones), np.zeros(3))
    assert np.allclose(BODY.directions(other_body), directions, atol=1e-12)


def test_a_bone_without_length_is_named_with_its_frame():
    broken = PLACES.copy()
    broken[4, BODY.index("left_wrist")] = broken[4, BODY.index("left_elbow")]
    with pytest.raises(ValueError, match="'left_wrist' has no length at frame 4"):
        BODY.directions(broken)


def test_a_missing_position_is_named_with_its_frame():
    broken = PLACES.copy()
    broken[2, BODY.index("head"), 1] = np.nan
    with pytest.raises(ValueError, match="'head' is not finite at frame 2"):
        BODY.directions(broken)


@pytest.mark.parametrize(
    ("names", "parents", "word"),
    [
        (("a", "a"), (-1, 0), "named twice"),
        (("a", "b"), (-1, -1), "exactly one joint"),
        (("a", "b", "c"), (-1, 2, 1), "own ancestor"),
        (("a", "b"), (-1,), "one each"),
        (("a", "b"), (-1, 7), "joint numbers"),
    ],
)
def test_a_broken_skeleton_is_refused(names, parents, word):
    with pytest.raises(ValueError, match=word):
        Skeleton(names, parents)


def test_index_takes_aliases_and_says_what_there_is():
    assert BODY.names[BODY.index("lknee")] == "left_knee"
    with pytest.raises(ValueError, match="no joint 'left_heel'; it has pelvis"):
        BODY.index("left_heel")


def test_in_the_chain_a_parent_comes_before_its_children():
    order = np.random.default_rng(5).permutation(len(BODY.names)).tolist()
    shuffled = Skeleton(
        tuple(BODY.names[j] for j in order),
        tuple(order.index(p) if p >= 0 else -1 for p in (BODY.parents[j] for j in order)),
    )
    placed = {shuffled.root}
    for bone, parent, child in shuffled.chain.tolist():
        assert parent in placed and shuffled.edges[bone] == (parent, child)
        placed.add(child)
    assert len(placed) == shuffled.n_joints
