from dataclasses import replace

import numpy as np
import pytest

from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.real_time import RealTime, beyond_range, bone_change, real_time, sentence
from emulator.motion import MotionSet
from emulator.synthetic.tasks import make
from tests.emulator.fitted import made
from tests.emulator.judge.made_clips import NO_FEET, SKELETON, clips, still, waved


def test_recordings_against_themselves_are_as_recorded():
    recorded = waved(6, np.random.default_rng(0))
    found = real_time(recorded, recorded)
    assert found.too_fast == 0 and found.outside < 0.05 and np.isnan(found.auc)
    ratios = found.speed_ratio, found.acceleration_ratio, found.jerk_ratio
    assert np.allclose(ratios, 1) and np.allclose([found.places_mm, found.speeds_mm_per_s], 0, atol=1e-9)
    assert "draws are as recorded in places" in sentence(found, found) and "not as" not in sentence(found, found)


def test_what_trembles_is_told_of_in_words():
    rng = np.random.default_rng(1)
    recorded, other, drawn = waved(8, rng), waved(8, rng), waved(8, rng, shake_m=0.01)
    found, usual = (real_time(some, recorded, rng, n_permutations=9) for some in (drawn, other))
    assert found.jerk_ratio > 3 and found.auc > 0.95 and found.bone_change > usual.bone_change
    words = sentence(found, usual)
    assert "not as recorded in" in words and "smoothness (peak jerk" in words
    assert "a classifier nearly always tells them from recordings" in words


def test_a_bone_that_stretches_by_a_tenth_changes_by_a_tenth():
    body = still()
    hand, wrist = (SKELETON.index(f"left_{name}") for name in ("hand", "wrist"))
    body[60, hand] = body[60, wrist] + 1.1 * (body[60, hand] - body[60, wrist])
    assert np.isclose(bone_change(clips(body)), 0.1) and bone_change(clips(still())) == 0


def test_a_knee_bent_further_than_anybodys_is_beyond_the_range_by_so_much():
    bent = still()
    bent[30:61, SKELETON.index("left_ankle")] = [-0.4, 0.1, 0.5]
    degrees, share = beyond_range(clips(bent), clips(still()))
    assert np.isclose(degrees, 90) and np.isclose(share, 31 / 121)


def test_a_body_without_feet_or_limbs_says_so():
    body = np.cumsum(np.random.default_rng(0).normal(size=(40, 3, 3)), axis=0)
    made_of_three = clips(body, body + 0.1, skeleton=NO_FEET)
    found = real_time(made_of_three, made_of_three, np.random.default_rng(0))
    assert found.notes[0].startswith("feet: the skeleton has none")
    assert any(note.startswith("angles: ") for note in found.notes) and any(n.startswith("test: ") for n in found.notes)
    assert np.isnan(found.slide_cm) and "feet" not in sentence(found, found)


def test_who_stands_still_can_be_measured():
    stands = clips(still(), still(), still())
    found = real_time(stands, stands, np.random.default_rng(0), n_permutations=3)
    assert found.too_fast == 0 and np.isnan(found.jerk_ratio) and found.planted == 1
    assert np.isfinite(found.figures["auc"]) and " nan " not in sentence(found, found)


def test_two_skeletons_are_refused():
    with pytest.raises(ValueError, match="another skeleton"):
        real_time(clips(still()), clips(np.zeros((9, 3, 3)), skeleton=NO_FEET))


def test_the_sentence_says_what_is_good_and_what_is_not():
    fine = RealTime(9, 9, 0.0, 3.0, 1.0, 1.0, 1.0, 10.0, 20.0, 1.0, 1.0, 2.0, 3.0, 0.1)
    bad = replace(fine, too_fast=0.3, jerk_ratio=14.0, slide_cm=6.0, sunk_mm=40.0, auc=0.99, telling="greatest jerk")
    assert sentence(bad, fine) == (
        "draws are as recorded in places (energy 10 mm, recordings 10) and balance (10 % of the time off the feet, "
        "recorded 10 %); they are not as recorded in speed (30 % of draws with a joint over 1.1 x the fastest recorded,"
        " median peak 1.00 x), smoothness (peak jerk 14.0 x) and feet (slide 6.0 cm a stance, recorded 2.0, 40 mm into "
        "the floor, recorded 3); a classifier nearly always tells them from recordings (0.99), most by greatest jerk"
    )


def test_draws_of_a_fitted_emulator_are_measured_beside_its_recordings():
    motions, emulator = made("lift")
    recorded = Clips.recorded(motions, emulator.skeleton)
    drawn = Clips.drawn(emulator.sample(12, np.random.default_rng(0)), frame_rate_hz(motions))
    found = real_time(drawn, recorded)
    assert 0 < found.jerk_ratio < 20 and found.bone_change < 1e-6 and 0 <= found.unsupported <= 1
    assert emulator.report.jerk_ratio > 0 and 0 <= emulator.report.too_fast <= 1


def test_recorded_clips_are_the_recordings_at_even_times():
    motions = make("reach", 2, 2, seed=1)[0]
    some = Clips.recorded(motions)
    assert np.allclose(some.positions_m[0], motions.motions[0].positions_m()) and len(some[1:3]) == 2
    few = replace(motions.motions[0], time_s=motions.motions[0].time_s ** 1.5)
    uneven = Clips.recorded(MotionSet("reach", (few,), motions.mark_names))
    assert np.allclose(uneven.positions_m[0][[0, -1]], few.positions_m()[[0, -1]])
