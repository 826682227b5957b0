"""Left and right, found from the body: exchanged and mirrored takes are found, true ones are not accused."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings.npz import read_recording
from emulator.recordings.plausibility import checked_sides, mirrored, swapped_names
from emulator.skeleton import Skeleton
from tests.emulator.recordings.body import body
from tests.recordings import recording

RECORDINGS = [
    "bandai2_walk", "bandai2_walk_turn_left", "hdm05_deposit_floor", "hdm05_grab_high", "hdm05_jog_circle",
    "hdm05_sneak_2steps", "hdm05_squat_once", "hdm05_throw_ball", "uiprmd_deep_squat", "uiprmd_inline_lunge",
    "uiprmd_leg_raise", "uiprmd_shoulder_abduction", "uiprmd_shoulder_scaption", "uiprmd_side_lunge",
    "uiprmd_sit_to_stand",
]  # fmt: skip
LIMBS = {
    "lower legs": ("knee", "ankle", "foot", "toe"),
    "feet": ("ankle", "foot", "toe"),
    "arms": ("clavicle", "shoulder", "elbow", "wrist", "hand"),
    "forearms": ("elbow", "wrist", "hand"),
    "hands": ("wrist", "hand"),
}


def exchanged(take, joints):
    names = [
        name.replace("left_", "right_") if name in left else name.replace("right_", "left_") if name in right else name
        for left, right in [({f"left_{j}" for j in joints}, {f"right_{j}" for j in joints})]
        for name in take.names
    ]
    at = [names.index(name) for name in take.names]
    return replace(take, positions_m=take.positions_m[:, at])


@pytest.mark.parametrize("name", RECORDINGS)
@pytest.mark.parametrize("each", [6, pytest.param(1, marks=pytest.mark.slow)], ids=["sixth", "every"])
def test_every_exchange_is_found_in_real_takes_and_no_true_one_is_accused(name, each):
    for take in read_recording(recording(name)).takes[::each]:
        same, found = checked_sides(take)
        assert (found.verdict, found.mended) == ("as named", ()) and same is take, take.name
        for wrong in (swapped_names(take), mirrored(take)):
            assert checked_sides(wrong)[1].verdict == "swapped", take.name


@pytest.mark.parametrize("name", ["bandai2_walk", "hdm05_deposit_floor", "uiprmd_side_lunge"])
@pytest.mark.parametrize("limb", LIMBS)
@pytest.mark.parametrize("each", [10, pytest.param(5, marks=pytest.mark.slow)], ids=["tenth", "fifth"])
def test_names_of_one_limb_alone_are_mended(name, limb, each):
    for take in read_recording(recording(name)).takes[::each]:
        mended, found = checked_sides(exchanged(take, LIMBS[limb]))
        assert (found.verdict, found.mended) == ("as named", (limb,)), take.name
        assert np.array_equal(mended.positions_m, take.positions_m)


@pytest.mark.parametrize("name", ["bandai2_walk", "hdm05_squat_once", "uiprmd_deep_squat"])
def test_knees_tell_where_there_are_no_toes(name):
    for take in read_recording(recording(name)).takes[::7]:
        slim = without(take, "left_toe", "right_toe", "left_foot", "right_foot")
        assert checked_sides(slim)[1].verdict == "as named"
        assert checked_sides(mirrored(slim))[1].verdict == "swapped"


def without(take, *names):
    keep = [i for i, name in enumerate(take.names) if name not in names]
    parents = tuple(keep.index(take.parents[i]) if take.parents[i] in keep else -1 for i in keep)
    return replace(
        take, names=tuple(take.names[i] for i in keep), parents=parents, positions_m=take.positions_m[:, keep]
    )


def test_sides_do_not_depend_on_where_the_body_looks():
    take = body()
    for angle in np.linspace(0, 2 * np.pi, 7):
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        turned = replace(take, positions_m=take.positions_m @ turn.T)
        assert checked_sides(turned)[1].verdict == "as named"
        assert checked_sides(mirrored(turned))[1].verdict == "swapped"


def test_contact_goes_with_the_feet():
    contact = np.zeros((60, 2), bool)
    contact[:, 0] = True
    take = replace(body(60), contact=contact)
    assert swapped_names(take).contact[:, 1].all() and not swapped_names(take).contact[:, 0].any()
    assert np.array_equal(mirrored(take).contact, contact)


def test_two_exchanges_are_none():
    take = body()
    assert np.array_equal(swapped_names(swapped_names(take)).positions_m, take.positions_m)
    assert np.array_equal(mirrored(mirrored(take)).positions_m, take.positions_m)


def test_a_body_without_legs_tells_nothing_and_is_left_as_it_is():
    legs = [f"{side}_{joint}" for side in ("left", "right") for joint in ("knee", "ankle", "toe")]
    slim = without(body(), *legs)
    same, found = checked_sides(slim)
    assert found.verdict == "not told" and same is slim


def test_toes_and_knees_that_contradict_each_other_tell_nothing():
    from emulator.recordings.plausibility import _verdict

    assert _verdict({"toes": 0.9, "knees": -0.9}) == "not told"
    assert _verdict({"toes": 0.9, "knees": -0.1, "walking": -1.0}) == "as named"
    assert _verdict({"walking": -0.9, "elbows": 0.9}) == "swapped"
    assert _verdict({"elbows": -0.9}) == "not told"


def test_gaps_do_not_accuse():
    take = body()
    holes = take.positions_m.copy()
    holes[np.random.default_rng(3).random(holes.shape[:2]) < 0.3] = np.nan
    assert checked_sides(replace(take, positions_m=holes))[1].verdict == "as named"
    assert checked_sides(mirrored(replace(take, positions_m=holes)))[1].verdict == "swapped"


def test_mending_keeps_every_bone_length_of_a_whole_exchange():
    take = body()
    skeleton = Skeleton(take.names, take.parents)
    lengths = skeleton.bone_lengths(mirrored(take).positions_m)
    assert np.allclose(lengths, skeleton.bone_lengths(take.positions_m))
