"""The kernel against its naive twin, and what unknowns do to scores.

Which part of the body a score is from, and every sub-score beside it.
"""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.options import USUAL, Options, Thresholds
from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.scoring import ASKED, EITHER, NOTHING_OPEN, WALKING, Bounds, bounds_of, score
from opsim.subjects.exposure.plan import Handling
from tests.opsim.ergonomics.made_measures import frames, said, upright
from tests.opsim.ergonomics.naive_scores import naive_scores

OTHER = Thresholds(twist=15.0, trunk_upright=8.0, neck_extended=0.0, across_m=0.1, owas_knee=120.0)


@st.composite
def options(draw):
    return Options(
        rula_table_a=draw(st.sampled_from(["published", "worksheet2000"])),
        rula_force=draw(st.sampled_from(["paper", "worksheet"])),
        owas_disputed=draw(st.sampled_from([(), ("3373",), ("3373", "4132")])),
        thresholds=draw(st.sampled_from([Thresholds(), Thresholds(spread=True), OTHER])),
    )


@settings(max_examples=100)
@given(frames(), said(), options(), st.booleans(), st.booleans(), st.booleans())
def test_the_kernel_is_every_posture_that_what_is_unknown_allows(row, bounds, options, repeated, static, carrying):
    found = score(row[None], bounds, options, repeated, static, carrying)
    expected = naive_scores(row, bounds, options, repeated, static, carrying)
    assert (tuple(found.rula[0]), tuple(found.reba[0]), tuple(found.owas[0])) == expected


def one(row, bounds=NOTHING_OPEN, options=USUAL, **flags):
    found = score(row[None], bounds, options, **flags)
    return tuple(found.rula[0]), tuple(found.reba[0]), tuple(found.owas[0])


def test_a_body_that_hangs_its_arms_scores_the_least_but_for_its_straight_elbows():
    # RULA: upper arm 1, lower arm 2 (0 degrees), wrist 1, mid: table A "22" 2; table B 1; table C (2, 1): 2.
    # REBA: table A (1, 1, 1) 1; table B (1, 2, 1) 1; table C 1. OWAS 1121: 1.
    assert one(upright()) == ((2, 2), (1, 1), (1, 1))


def test_what_nobody_said_is_everything_it_may_be():
    # RULA low: as above less arms that may be supported (already 1): 2. High: twist 2, force 3, legs 2:
    # table A "22" 2 + 3 = 5; table B (1, 1, 2) 3 + 3 = 6; table C (5, 6): 7.
    # REBA low 1. High: legs 2, load 3: table A 2 + 3 = 5; coupling 3: 1 + 3 = 4; table C (5, 4) 5, rapid 1: 6.
    # OWAS: 1121, 1131 with any load: 1 (both knees straight: nobody sits so).
    assert one(upright(), bounds_of()) == ((2, 7), (1, 6), (1, 1))


def test_empty_hands_hold_nothing_of_an_unknown_load():
    # RULA high: force 0: table A 2; table B 3; table C (2, 3): 3. REBA high: 2; 1; table C (2, 1): 1, rapid 2.
    assert one(upright(), bounds_of(), carrying=False) == ((2, 3), (1, 2), (1, 1))


def test_a_load_counts_only_while_it_is_carried():
    bounds = bounds_of(Handling(12.0, "poor", "static", "mid", False, False, "balanced", False))
    empty, loaded = one(upright(), bounds, carrying=False), one(upright(), bounds, carrying=True)
    # loaded, RULA: 2 + 3 = 5 and 1 + 3 = 4: table C (5, 4): 5. REBA: 1 + 2 = 3, 1 + 2 = 3: table C (3, 3): 3.
    assert empty == ((2, 2), (1, 1), (1, 1)) and loaded == ((5, 5), (3, 3), (1, 1))


def test_muscle_use_and_activity_come_from_the_shift():
    # RULA: 2 + 1, 1 + 1: table C (3, 2): 3, whichever it was. REBA: 1, and 1 more for each.
    assert one(upright(), repeated=True) == one(upright(), static=True) == ((3, 3), (2, 2), (1, 1))
    assert one(upright(), repeated=True, static=True) == ((3, 3), (3, 3), (1, 1))


def test_a_measure_that_is_not_known_widens_the_scores_that_ask_for_it_and_no_other():
    known = one(upright())
    for name in COLUMNS:
        rula, reba, owas = one(upright(**{name: np.nan}))
        for (low, high), (was, _) in zip((rula, reba, owas), known):
            assert low <= was <= high
        if name not in ASKED:
            assert (rula, reba, owas) == known, name
    assert one(upright(neck_flexion=np.nan))[0] == (2, 4)  # neck 4: table B 5; table C (2, 5): 4


def test_nothing_known_is_the_whole_range():
    nothing = np.full(len(COLUMNS), np.nan)
    # RULA low: all 1: 1; high 7. REBA 1 to 12 + 1. OWAS 1111 to 4.
    assert one(nothing, bounds_of()) == ((1, 7), (1, 13), (1, 4))


@pytest.mark.parametrize("seed", range(3))
def test_more_known_is_never_wider(seed):
    rng = np.random.default_rng(seed)
    rows = rng.normal(0, 40, (300, len(COLUMNS)))
    holes = np.where(rng.random(rows.shape) < 0.2, np.nan, rows)
    narrow, wide = score(rows, NOTHING_OPEN), score(holes, bounds_of())
    for name in ("rula", "reba", "owas"):
        low, high = getattr(narrow, name).T
        assert np.all(getattr(wide, name)[:, 0] <= low) and np.all(high <= getattr(wide, name)[:, 1]), name


def test_spread_says_how_much_hangs_on_the_thresholds_of_twist_and_side():
    twisted = upright(trunk_twist=12.0)
    # trunk 2: table B (1, 2, 1) 2: table C (2, 2) 2; not twisted, trunk 1: C (2, 1) 2
    assert one(twisted)[0] == (2, 2)
    both = upright(trunk_twist=12.0, trunk_side=12.0)
    # trunk 3: table B (1, 3, 1) 3: table C (2, 3): 3; without, trunk 1: 2
    assert one(both)[0] == (3, 3)
    assert one(both, options=Options(thresholds=Thresholds(spread=True)))[0] == (2, 3)
    assert one(upright(trunk_twist=4.0, trunk_side=21.0), options=Options(thresholds=Thresholds(spread=True)))[0] == (
        2,
        2,
    )


def test_the_worse_arm_is_told():
    raised = [upright(left_arm_flexion=100.0), upright(right_arm_flexion=100.0), upright()]
    found = score(np.array(raised), NOTHING_OPEN)
    assert found.worse.tolist() == [0, 1, 0]
    assert found.rula[0].tolist() == found.rula[1].tolist() != found.rula[2].tolist()


def test_an_arm_overhead_that_leans_back_is_not_extended():
    assert one(upright(left_arm_flexion=-175.0)) == one(upright(left_arm_flexion=175.0))


def test_an_abducted_arm_scores_its_flexion_and_one_more():
    # table A (2, 2, 1, 1) 3, table B 1: table C (3, 1): 3, as skeleton 10 of the worked cases
    assert one(upright(left_arm_abduction=80.0, left_outside_m=0.6))[0] == (3, 3)


def test_the_flexion_of_an_arm_straight_out_to_the_side_is_its_elevation():
    # to shoulder height 3, abducted 4: A (4, 2, 1, 1) 4: C (4, 1) 3; above 4, 5: A (5, 2, 1, 1) 5: C (5, 1) 4
    for flexion, expected in ((0.0, 3), (-80.0, 3), (100.0, 4), (-170.0, 4)):
        assert one(upright(left_arm_abduction=85.0, left_arm_flexion=flexion))[0] == (expected, expected)
    nobody = Options(thresholds=Thresholds(arm_sideways=90.0))
    assert one(upright(left_arm_abduction=85.0, left_arm_flexion=-80.0), options=nobody)[0] == (3, 3)
    assert one(upright(left_arm_abduction=-85.0, left_arm_flexion=np.nan))[0] == (3, 4)


def test_a_forearm_turned_out_or_across_scores_one_more_and_one_out_with_its_whole_arm_does_not():
    # table A (1, 2, 2, 1) 2: C (2, 1) 2; lower arm 3: (1, 3, 2, 1) 3: C (3, 1) 3
    bent = {"left_wrist": 10.0}
    assert one(upright(**bent))[0] == (2, 2)
    assert one(upright(**bent, left_outside_m=0.3))[0] == one(upright(**bent, left_across_m=0.1))[0] == (3, 3)
    # abducted, wrist 3, trunk 4: A (2, 2, 3, 1) 3, B (1, 4, 1) 5: C (3, 5) 4; with lower arm 3, A 4: C (4, 5) 5
    wide = {"left_arm_abduction": 40.0, "left_wrist": 20.0, "trunk_flexion": 65.0}
    assert one(upright(**wide, left_outside_m=0.4))[0] == (4, 4)
    assert one(upright(**wide, left_across_m=0.1))[0] == (5, 5)


def test_walking_counts_as_standing_on_both_feet_and_has_a_digit_of_its_own():
    stride = upright(left_knee=65.0, right_knee=20.0)
    bounds = replace(WALKING, rula_force=(0, 0), reba_load=(0, 0), owas_load=(1, 1), coupling=(0, 0), rapid=(0, 0))
    assert one(stride, bounds)[1:] == ((1, 1), (1, 1))
    assert one(upright(trunk_flexion=30.0), replace(bounds, owas_load=(3, 3)))[2] == (3, 3)  # 2173
    assert one(upright(trunk_flexion=30.0, left_knee=65.0, right_knee=65.0), NOTHING_OPEN)[2] == (3, 3)  # 2141


def test_whoever_sits_needs_no_knees_and_whoever_leans_back_is_supported():
    sitting = Bounds(sitting=(1, 1))
    seated = upright(left_knee=90.0, right_knee=90.0, trunk_flexion=-15.0)
    # standing: trunk 2: 2; sitting, leaning back: 1. REBA trunk 2, legs 1: table A (1, 2, 1) 2 against (1, 2, 3) 4.
    assert one(seated, sitting) == ((2, 2), (1, 1), (1, 1))
    assert one(seated, NOTHING_OPEN) == ((2, 2), (3, 3), (2, 2))  # squatting 1141: 2; table C (4, 1): 3


def test_a_single_precision_row_scores_as_a_double_one():
    rows = np.random.default_rng(1).normal(0, 40, (200, len(COLUMNS))).astype(np.float32)
    single, double = score(rows, bounds_of()), score(rows.astype(float), bounds_of())
    assert all(
        np.array_equal(getattr(single, name), getattr(double, name)) for name in ("rula", "reba", "owas", "worse")
    )


def test_some_are_a_few_of_them():
    found = score(np.array([upright(), upright(trunk_flexion=70.0)]), NOTHING_OPEN)
    assert np.array_equal(found.some(np.array([1])).rula, found.rula[1:])


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match=r"measures must be \(N, 30\), found \(30,\)"):
        score(upright(), NOTHING_OPEN)
    with pytest.raises(ValueError, match=r"static must be \(1,\) or one for all, found \(2,\)"):
        score(upright()[None], NOTHING_OPEN, static=[True, False])
    with pytest.raises(ValueError, match="rula_force: no 'papers'; did you mean 'paper'"):
        score(upright()[None], NOTHING_OPEN, Options(rula_force="papers"))
    assert score(np.empty((0, len(COLUMNS))), NOTHING_OPEN).rula.shape == (0, 2)


def test_an_arm_of_which_only_the_flexion_is_known_may_be_out_to_the_side():
    """Hanging (1) or, out beyond 80 degrees, raised to at most 90 (3), and abducted (1 more); RULA's table A at 4."""
    row = upright()
    row[AT["left_arm_abduction"]] = np.nan
    codes = explained_arm(row)
    assert codes == (1, 4)
    row[AT["left_arm_flexion"]] = 120.0
    assert explained_arm(row) == (4, 5)


def explained_arm(row):
    """RULA's code of the left upper arm, low and high."""
    from opsim.ergonomics.kernels import scores as kernel
    from opsim.ergonomics.scores.scoring import edges_of, phases_of, places

    codes = np.empty((kernel.ARM + 2 * kernel.ARM_CODES, 2), np.int64)
    phases = phases_of(NOTHING_OPEN)
    kernel.find_codes(np.asarray(row, float), places(), edges_of(USUAL.thresholds), phases[1], False, codes)
    return tuple(codes[kernel.ARM].tolist())


SAID = Handling(8.0, "fair", "repeated", "end", True, True, "unbalanced", True)


def test_what_is_said_leaves_nothing_open():
    # 8 kg repeated: RULA 2; REBA 1; OWAS 1; fair grip 1
    found = bounds_of(SAID)
    assert (found.rula_force, found.reba_load, found.owas_load, found.coupling) == ((2, 2), (1, 1), (1, 1), (1, 1))
    assert (found.wrist_twist, found.supported, found.sitting, found.one_legged, found.rapid) == ((2, 2), *[(1, 1)] * 4)


def test_what_is_not_said_is_all_that_it_may_be():
    found = bounds_of(Handling())
    assert (found.rula_force, found.reba_load, found.owas_load, found.coupling) == ((0, 3), (0, 3), (1, 3), (0, 3))
    assert found.wrist_twist == (1, 2)
    assert (found.supported, found.sitting, found.one_legged, found.rapid) == (EITHER,) * 4


@pytest.mark.parametrize(
    ("load_kg", "force", "rula", "worksheet", "reba", "owas"),
    [
        (8.0, None, (1, 3), (1, 3), (1, 2), (1, 1)),
        (12.0, None, (2, 3), (3, 3), (2, 3), (2, 2)),
        (12.0, "intermittent", (2, 2), (3, 3), (2, 2), (2, 2)),
        (None, "intermittent", (0, 2), (0, 3), (0, 2), (1, 3)),
        (None, "shock", (3, 3), (3, 3), (1, 3), (1, 3)),
        (1.0, None, (0, 3), (0, 3), (0, 1), (1, 1)),
        (0.0, None, (0, 0), (0, 0), (0, 0), (1, 1)),
        (0.0, "shock", (3, 3), (3, 3), (1, 1), (1, 1)),
    ],
)
def test_load_and_force_together_make_the_range(load_kg, force, rula, worksheet, reba, owas):
    found = bounds_of(Handling(load_kg=load_kg, force=force))
    assert (found.rula_force, found.rula_force_worksheet, found.reba_load, found.owas_load) == (
        rula,
        worksheet,
        reba,
        owas,
    )


def test_a_load_of_nothing_needs_no_grip_but_one_that_is_named_counts():
    assert bounds_of(Handling(load_kg=0.0)).coupling == (0, 0)
    assert bounds_of(Handling(load_kg=0.0, grip="poor")).coupling == (2, 2)


def test_empty_hands_have_no_load_force_or_grip_and_all_else_as_before():
    found, whole = bounds_of(SAID).empty_handed(), bounds_of(SAID)
    held = {
        "rula_force": (0, 0),
        "rula_force_worksheet": (0, 0),
        "reba_load": (0, 0),
        "owas_load": (1, 1),
        "coupling": (0, 0),
    }
    assert {one.name: getattr(found, one.name) for one in fields(found)} == {
        one.name: held.get(one.name, getattr(whole, one.name)) for one in fields(found)
    }


def test_who_walks_stands_on_both_feet_whatever_he_carries():
    assert WALKING.walking and WALKING.one_legged == WALKING.sitting == WALKING.supported == (0, 0)
    assert WALKING.reba_load == (0, 3) and not NOTHING_OPEN.walking
    assert bounds_of(SAID, walking=True).reba_load == (1, 1)


STOOP = upright(trunk_flexion=70.0, neck_flexion=-10.0, left_arm_flexion=70.0, right_arm_flexion=70.0)


def test_a_stoop_is_told_part_by_part():
    found = explain(STOOP, NOTHING_OPEN)
    # RULA: upper arm 3, elbow straight 2: A 3; neck 4, trunk 4: B 7; C (3, 7) 6
    assert found["rula"]["score"] == (6, 6) and found["rula"]["level"] == (3, 3)
    assert found["rula"]["text"] == "investigation and changes required soon"
    parts = found["rula"]["parts"]
    assert [parts[name] for name in ("upper_arm", "lower_arm", "wrist", "neck", "trunk", "legs")] == [
        *[(3, 3), (2, 2), (1, 1)],
        *[(4, 4), (4, 4), (1, 1)],
    ]
    assert found["owas"]["parts"] == {"back": (2,), "arms": (1,), "legs": (2,), "load": (1,)}


def test_what_drives_a_score_sums_to_what_is_above_the_least():
    # Shapley by hand, OWAS 2121: only the back differs from 1121: 2 - 1.
    found = explain(STOOP, NOTHING_OPEN)
    assert found["owas"]["drives"] == {"back": 1.0}
    assert sum(found["rula"]["drives"].values()) == pytest.approx(6 - 1)
    assert sum(found["reba"]["drives"].values()) == pytest.approx(5 - 1)
    assert next(iter(found["reba"]["drives"])) == "trunk"


def test_two_parts_share_what_only_both_bring():
    # RULA: neck 4 with trunk 1: B 5, C (1, 5) 4; trunk 4 with neck 1: B 5, 4; both: B 7, C (1, 7) 5; none: 1.
    # Each first: 3, each second: 1: (3 + 1) / 2. (Elbows at 80 degrees, so that arms bring nothing.)
    both = upright(neck_flexion=-10.0, trunk_flexion=70.0, left_elbow=80.0, right_elbow=80.0)
    assert explain(both, NOTHING_OPEN)["rula"]["drives"] == pytest.approx({"neck": 2.0, "trunk": 2.0})


def test_time_and_load_drive_too():
    found = explain(upright(), Bounds(reba_load=(3, 3)), repeated=True, static=True)
    # REBA: A 1 + 3 = 4: C (4, 1) 3, + 2. RULA: C (2 + 1, 1 + 1) 3 against C (1, 1) 1: arms and time
    assert found["reba"]["score"] == (5, 5) and found["reba"]["drives"] == {"load": 2.0, "time": 2.0}
    assert found["reba"]["parts"]["time"] == (2, 2) and found["rula"]["parts"]["time"] == (1, 1)
    assert set(found["rula"]["drives"]) == {"arms", "time"}
    unloaded = explain(upright(), Bounds(reba_load=(3, 3)), carrying=False)
    assert unloaded["reba"]["score"] == (1, 1) and unloaded["reba"]["drives"] == {}


def test_the_worse_arm_is_the_one_that_is_told():
    found = explain(upright(right_arm_flexion=100.0), NOTHING_OPEN)
    assert found["rula"]["side"] == "right" and found["rula"]["parts"]["upper_arm"] == (4, 4)


def test_what_is_open_is_told_as_such():
    found = explain(upright(left_knee=40.0), bounds_of())
    assert found["owas"]["parts"] == {"back": (1,), "arms": (1,), "legs": (1, 2, 3, 4, 5), "load": (1, 2, 3)}
    assert found["reba"]["parts"]["legs"] == (1, 3)


def test_what_is_no_posture_is_refused():
    with pytest.raises(ValueError, match=r"measures must be \(N, 30\), found \(1, 3\)"):
        explain(np.zeros(3), NOTHING_OPEN)


@settings(max_examples=25)
@given(frames(), said())
def test_scores_are_those_of_the_kernel_and_drives_sum_to_their_middle(row, bounds):
    found, scored = explain(row, bounds), score(row[None], bounds)
    least = explain(upright(left_elbow=80.0, right_elbow=80.0), NOTHING_OPEN)
    for name in ("rula", "reba", "owas"):
        assert found[name]["score"] == tuple(getattr(scored, name)[0].tolist())
        if name != "owas" or not bounds.walking:
            middle = np.mean(found[name]["score"]) - least[name]["score"][0]
            assert sum(found[name]["drives"].values()) == pytest.approx(middle)
