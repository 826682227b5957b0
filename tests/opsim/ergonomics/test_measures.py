import warnings
from dataclasses import dataclass, replace

import numpy as np
import pytest

import emulator.skeleton
from opsim.ergonomics.angles import AT, CANONICAL, COLUMNS, SIDES, bone_chain, joint_places
from opsim.ergonomics.measures import (
    first_measures,
    has_body,
    measures_of,
    measures_of_positions,
    missing_scores,
    n_cells,
)
from opsim.ergonomics.options import USUAL
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.streams import BLOCK, stream
from opsim.subjects.tasks.variability import retimed
from opsim.tasks import TimePerformances
from tests.opsim.ergonomics.made_work import SKELETON, Bends, BendsApart, up_and_down

LIBRARIES = shipped_folder() / "libraries"
DRAWN = [("public_movements", "deep_squat"), ("bench_work", "stoop")]


@pytest.fixture(scope="module", params=DRAWN, ids="/".join)
def block(request):
    library, task = request.param
    return load_library(LIBRARIES / f"{library}.npz")[task].sample(BLOCK, stream(3, 0, "measured", 0))


def naive(block, rows, options=USUAL, neutral_rad=0.0):
    """Each performance alone, its whole path found, at the middles of even parts of its own time."""
    shares = (np.arange(n_cells(block, options)) + 0.5) / n_cells(block, options)
    bodies = [block[row].positions_m(times_s=shares * block.duration_s[row])[0] for row in rows]
    return measures_of_positions(np.array(bodies), block.skeleton.names, options, neutral_rad)


# Known answers


@pytest.mark.parametrize("kind", [Bends, BendsApart])
def test_a_performance_that_bends_evenly_is_measured_in_the_middles_of_its_parts(kind):
    """9 s at 2 postures a second: 18 parts; the course is straight between 0, the middle and the end."""
    bends = kind(np.full(4, 9.0), np.array([90.0, 60.0, 30.0, 0.0]))
    options = replace(USUAL, rate_hz=2.0)
    found = measures_of(bends, [2, 0], options)
    shares = (np.arange(18) + 0.5) / 18
    assert found.shape == (2, 18, len(COLUMNS))
    assert np.allclose(found[0, :, AT["trunk_flexion"]], up_and_down(shares) / 3)
    assert np.allclose(found[1, :, AT["trunk_flexion"]], up_and_down(shares))


def test_parts_are_as_many_as_the_longest_of_the_block_needs():
    bends = Bends(np.array([2.0, 3.01]), np.zeros(2))
    assert n_cells(bends, replace(USUAL, rate_hz=10.0)) == 31 and n_cells(bends, replace(USUAL, rate_hz=0.1)) == 1
    assert n_cells(Bends(np.array([1e9]), np.zeros(1))) == 2**16


def test_first_measures_are_of_the_postures_at_the_start():
    bends = Bends(np.full(2, 9.0), np.array([90.0, 45.0]))
    assert np.allclose(first_measures(bends)[:, AT["trunk_flexion"]], 0)


def test_times_without_a_body_have_none(block):
    assert has_body(block) and not has_body(TimePerformances(np.ones(3)))


# The kernel and its twin


@pytest.mark.parametrize("reference", ["trunk", "gravity"])
def test_measures_from_bones_are_those_of_the_joints_in_the_room(block, reference):
    options, rows = replace(USUAL, arm_reference=reference), [5, 60, 7]
    expected = naive(block, rows, options, 0.15)
    assert np.allclose(measures_of(block, rows, options, 0.15), expected, rtol=0, atol=1e-9)
    assert not np.isnan(expected).any()


def test_rows_alone_are_as_in_the_whole_block(block):
    whole = measures_of(block, range(BLOCK))
    assert np.allclose(measures_of(block, [63]), whole[63:], rtol=0, atol=1e-9)
    assert measures_of(block, []).shape == (0, *whole.shape[1:])


def test_a_performance_that_takes_longer_passes_through_the_same_postures(block):
    longer = retimed(block, block.duration_s * 1.0)
    assert np.allclose(measures_of(longer, [4, 9]), measures_of(block, [4, 9]), rtol=0, atol=1e-9)
    slow = retimed(block, block.duration_s * 2.0)
    twice = measures_of(slow, [4, 9], replace(USUAL, rate_hz=6.0))
    assert np.allclose(twice, measures_of(block, [4, 9]), rtol=0, atol=1e-9)


# What is asked of the seam


@dataclass(frozen=True, eq=False)
class Counted:
    """A block that says which of its rows were decoded."""

    block: object
    asked: list

    skeleton = property(lambda self: self.block.skeleton)
    duration_s = property(lambda self: self.block.duration_s)

    def __getitem__(self, rows):
        self.asked.append(np.size(rows))
        return self.block[rows]


def test_only_rows_that_are_asked_for_are_decoded(block):
    counted = Counted(block, [])
    measures_of(counted, [1, 2, 40])
    assert sum(counted.asked) == 3


def test_long_performances_are_decoded_a_few_at_a_time(block):
    long = retimed(block, np.full(BLOCK, 600.0))
    counted = Counted(long, [])
    found = measures_of(counted, range(8))
    assert len(counted.asked) > 1 and sum(counted.asked) == 8 and found.shape[:2] == (8, 7200)


@pytest.mark.parametrize("kind", [Bends, BendsApart])
def test_postures_that_are_nan_are_nan_without_a_word(kind):
    class Lost(kind):
        def positions_m(self, n_times):
            bodies = super().positions_m(n_times)
            bodies[0, : n_times // 2] = np.nan
            return bodies

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = measures_of(Lost(np.full(3, 3.0), np.zeros(3)), [0, 1])
    assert np.isnan(found[0, :18]).all() and not np.isnan(found[0, 18:]).any() and not np.isnan(found[1]).any()


def test_a_skeleton_of_a_few_joints_has_the_measures_they_make():
    names = ("pelvis", "neck", "left_hip", "right_hip")

    class Few(Bends):
        def positions_m(self, n_times):
            return super().positions_m(n_times)[..., [CANONICAL.index(name) for name in names], :]

    few = Few(np.full(2, 3.0), np.full(2, 40.0), SKELETON._replace(names=names))
    found = measures_of(few, [0, 1])
    seen = {name for name in COLUMNS if not np.isnan(found[..., AT[name]]).any()}
    assert seen == {"trunk_flexion", "trunk_side"}


def test_postures_of_another_shape_are_refused_by_name(block):
    class Short(Bends):
        def positions_m(self, n_times):
            return super().positions_m(n_times)[:, 1:]

    with pytest.raises(ValueError, match=r"Short.positions_m gave \(2, 6, 21, 3\), expected \(2, 7, 21, 3\)"):
        measures_of(Short(np.full(2, 1.0), np.zeros(2)), [0], replace(USUAL, rate_hz=3.0))
    with pytest.raises(ValueError, match="did you mean 'gravity'"):
        measures_of(block, [0], replace(USUAL, arm_reference="gravitty"))


def test_bones_of_another_number_are_refused_by_name(block):
    class Odd:
        skeleton, duration_s, bone_length_m = block.skeleton, block.duration_s, block.bone_length_m[:, 1:]
        directions = block.directions

    with pytest.raises(ValueError, match=r"Odd.bone_length_m gave \(64, 19\), expected \(64, 20\)"):
        measures_of(Odd(), [0])


def test_a_parent_comes_before_its_children_however_joints_are_numbered():
    """Joint 2 is the root; 0 hangs on 1, 1 on 3, 3 on 2: bones end at joints 0, 1 and 3."""
    assert bone_chain((1, 3, -1, 2)).tolist() == [[2, 2, 3], [1, 3, 1], [0, 1, 0]]


def test_places_of_joints_that_are_missing_are_beyond_the_last():
    places = joint_places(("neck", "pelvis", "tail"))
    assert places[CANONICAL.index("pelvis")] == 1 and places[CANONICAL.index("neck")] == 0
    assert np.count_nonzero(places == 3) == len(CANONICAL) - 2


def test_the_canonical_names_are_those_of_the_emulator():
    assert CANONICAL == emulator.skeleton.CANONICAL


def test_every_joint_of_a_limb_has_its_other_side():
    limbs = [name for name in CANONICAL if "_" in name]
    assert all(f"{side}_{name.partition('_')[2]}" in CANONICAL for name in limbs for side in SIDES)


def without(*words):
    return missing_scores([name for name in CANONICAL if not name.endswith(words)])


def test_the_canonical_joints_miss_nothing_that_is_scored():
    assert missing_scores(CANONICAL) == [] and without("spine", "chest") == []


def test_without_hands_the_wrist_is_not_known_and_stands_for_them():
    (said,) = without("hand")
    assert said.startswith("no hands: how far the wrist is bent is not known, so RULA and REBA are wider by it")
    assert "OWAS does not ask" in said and "those of the wrist" in said


def test_without_wrists_and_head_three_things_are_not_known():
    head, wrists = without("wrist", "hand", "head")
    assert head.startswith("no head: the neck is not known") and wrists.startswith(
        "no wrists or hands: how far elbow and wrist"
    )


def test_whatever_a_missing_joint_hides_is_named():
    """Without hips thighs have no upper end; without a shoulder the neck has no frame."""
    assert without("hip")[0].startswith("no hips: how far trunk and knees are bent")
    assert without("left_shoulder")[0].startswith("no left shoulder: twist of the trunk, neck and upper arms")


def test_one_side_is_named():
    assert missing_scores([name for name in CANONICAL if name != "left_knee"])[0].startswith("no left knee: ")


def test_a_skeleton_of_nothing_says_so_of_every_score():
    trunk, shoulders, head, elbows, wrists, legs, feet = missing_scores(())
    assert trunk.startswith("no pelvis, neck or hips: ") and "RULA, REBA and OWAS" in trunk
    assert (
        shoulders.startswith("no shoulders")
        and elbows.startswith("no elbows")
        and legs.startswith("no knees or ankles")
    )
    assert head.startswith("no head") and wrists.startswith("no wrists") and feet.startswith("no ankles")


def test_without_toes_the_floor_is_an_ankle_and_without_ankles_no_lift_is_seen():
    (toes,), (legs, ankles) = without("toe"), without("ankle", "toe")
    assert toes.startswith("no toes: the floor is taken where the lower ankle is")
    assert legs.startswith("no ankles: how far knees") and "no lift is seen" in ankles
