import numpy as np
import pytest

from emulator.skeleton import CANONICAL, Skeleton, canonical_name, canonical_names, standard_skeleton
from emulator.synthetic.choreography import REST, Body, joints_m, soft_target, two_bones
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
        (("a", "b"), (-1, -1), "joints a, b have no parent"),
        (("a", "b", "c"), (-1, 2, 1), "joint 'b' is its own ancestor"),
        (("a", "b"), (1, 0), "joint 'a' is its own ancestor"),
        (("a", "b"), (-1,), "one each"),
        (("a", "b"), (-1, 7), "joint 'b': found parent 7, expected a joint number from 0 to 1"),
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


SKELETON = standard_skeleton()


def rest(n=1, **changes):
    fields = {
        name: np.broadcast_to(np.asarray(changes.get(name, value), float), (n, len(value)))
        for name, value in REST.items()
    }
    return fields


def test_a_limb_reaches_a_target_within_reach_with_its_own_lengths():
    start, target = np.zeros((1, 3)), np.array([[0.3, 0.1, -0.2]])
    middle, end = two_bones(start, target, 0.3, 0.25, np.array([[0.0, 0, -1]]))
    assert np.allclose(end, target)
    assert np.isclose(np.linalg.norm(middle - start), 0.3)
    assert np.isclose(np.linalg.norm(end - middle), 0.25)


def test_a_target_out_of_reach_is_approached_on_the_straight_line():
    _, end = two_bones(np.zeros((1, 3)), np.array([[2.0, 0, 0]]), 0.3, 0.25, np.array([[0.0, 0, -1]]))
    assert np.allclose(end, [[0.999 * 0.55, 0, 0]])


def test_a_near_target_is_kept_and_a_far_one_drawn_in_without_a_kink():
    distance = np.linspace(0.1, 3.0, 2901)
    drawn = soft_target(np.zeros((1, 3)), np.stack([distance, 0 * distance, 0 * distance], axis=-1), 1.0)[:, 0]
    assert np.allclose(drawn[distance <= 0.9], distance[distance <= 0.9], atol=1e-15)
    assert np.all(np.diff(drawn) >= 0) and drawn.max() <= 0.999
    assert np.abs(np.diff(drawn, 2)).max() < 2e-5


def test_bones_keep_their_lengths_in_any_posture():
    upright = SKELETON.bone_lengths(joints_m(rest(), Body()))
    bent = rest(
        pelvis=(-0.1, 0, 0.6), pitch=[0.8], lean=[0.1], twist=[0.3], right_wrist=(0.4, -0.2, 0.3), left_toe=[0.3]
    )
    assert np.allclose(SKELETON.bone_lengths(joints_m(bent, Body())), upright, atol=1e-12)


def test_knees_bend_forward_and_elbows_back():
    at = dict(zip(SKELETON.names, joints_m(rest(pelvis=(-0.1, 0, 0.6), right_wrist=(0.3, -0.2, 1.1)), Body())[0]))
    assert at["left_knee"][0] > max(at["left_hip"][0], at["left_ankle"][0])
    line = at["right_wrist"] - at["right_shoulder"]
    assert np.cross(line, at["right_elbow"] - at["right_shoulder"])[1] > 0  # below the line from shoulder to wrist


def test_a_person_stands_on_the_floor_as_tall_as_said():
    for stature in (1.55, 1.75, 1.95):
        at = dict(zip(SKELETON.names, joints_m(rest(), Body(stature))[0]))
        assert np.isclose(at["head"][2] + 0.12 * stature / 1.75, stature, atol=0.02)
        assert 0.0 < at["left_toe"][2] < at["left_ankle"][2]


def test_planted_ankles_stay_while_the_body_sinks():
    low = joints_m(rest(pelvis=(-0.2, 0, 0.55)), Body())[0]
    assert np.allclose(low[SKELETON.index("left_ankle")], REST["left_ankle"])
