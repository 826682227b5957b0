"""``opsim motion score``: a table, JSON and a page; what is missing is said, and what is wrong, all at once."""

import json
from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.npz import write_recording
from emulator.recordings.take import Recording, Take
from emulator.skeleton import standard_skeleton
from opsim.ergonomics.options import NOT_SEEN, RULES
from tests.opsim.cli.calls import opsim
from tests.opsim.ergonomics.bodies import bent

SKELETON = standard_skeleton()
ALL_SAID = ("--load", "0 kg", "--forearm", "mid", "--arms-supported", "no", "--sitting", "no", "--legs", "balanced")
ALL_SAID = (*ALL_SAID, "--rapid", "no")


def take(*flexions_deg, trial="1", names=SKELETON.names):
    """Bent forward by each of some angles, a second each, at 12 frames a second."""
    bodies = np.repeat([bent(angle) for angle in flexions_deg], 12, axis=0)
    kept = [SKELETON.names.index(name) for name in names]
    parents = tuple(names.index(SKELETON.names[SKELETON.parents[j]]) if SKELETON.parents[j] >= 0 else -1 for j in kept)
    return Take(tuple(names), parents, bodies[:, kept], 12.0, "ana", trial)


@pytest.fixture
def recording(tmp_path):
    """Takes that bend by 0, 40 and 70, and by 0 and 10 degrees."""
    file = tmp_path / "bends.npz"
    write_recording(Recording((take(0, 40, 70), take(0, 10, trial="2")), "made", "MIT"), file)
    return file


def told(*words):
    code, shown, _ = opsim("motion", "score", *words, "--json")
    assert code == 0
    return json.loads(shown)


def test_shares_of_a_recording_are_those_of_its_time(recording):
    """5 s, of which 2 with the trunk flexed by 20 degrees or more, 1 by 60 or more; arms never raised by 60 or more but
    where they stick out from the trunk at 70 degrees, as these bodies' do: 1 s."""
    found = told(recording, *ALL_SAID)
    figures = {name: figure["low"] for name, figure in found["figures"].items()}
    assert found["movements"] == 2 and found["seconds"] == pytest.approx(5.0)
    assert figures["trunk_beyond_20_share"] == pytest.approx(0.4)
    assert figures["trunk_beyond_60_share"] == pytest.approx(0.2) == pytest.approx(figures["arm_beyond_60_share"])
    assert all(figure["low"] == figure["high"] for figure in found["figures"].values())


def test_what_is_not_said_is_listed_and_makes_intervals(recording):
    found = told(recording, "--load", "8 kg")
    (said,) = [note for note in found["notes"] if note.startswith("not said")]
    assert "--grip" in said and "--sitting" in said and "--load" not in said
    assert found["figures"]["rula_mean"]["low"] < found["figures"]["rula_mean"]["high"]


def test_the_table_has_at_least_and_at_most(recording):
    code, shown, _ = opsim("motion", "score", recording)
    assert code == 0 and "at least" in shown and "at most" in shown
    assert "RULA 5 or more" in shown and "neutral of the neck: 0.0 degrees forward" in shown
    assert "bends.npz: 2 takes (made)" in shown


def test_the_reference_of_the_arms_is_an_option(recording):
    """Arms stay along the trunk: against it they hang, against gravity they are raised, which scores higher."""
    trunk, gravity = (told(recording, *ALL_SAID, "--arm-reference", word)["figures"] for word in ("trunk", "gravity"))
    assert trunk["arm_beyond_60_share"] == gravity["arm_beyond_60_share"]
    assert trunk["reba_mean"]["low"] < gravity["reba_mean"]["low"]


def test_a_neutral_of_the_neck_can_be_given(recording):
    notes = told(recording, "--neck-neutral", "12 deg")["notes"]
    assert "neutral of the neck: 12.0 degrees, as given" in notes


def test_performances_are_drawn_from_a_library_by_one_word_or_two():
    one, two = told("bench_work/stoop", "-n", 3), told("bench_work", "stoop", "-n", 3)
    assert one == two and one["movements"] == 3 and one["source"].startswith("stoop: 3 drawn")
    assert told("bench_work/stoop", "-n", 3, "--seed", 1)["figures"] != one["figures"]


def test_walks_are_scored_as_walking():
    (said,) = [note for note in told("walking/walk", "-n", 1)["notes"] if note.startswith("not said")]
    assert "--load" in said and "--sitting" not in said and "--legs" not in said


def test_a_bvh_file_is_read(tmp_path):
    write_bvh(take(0, 30, 50), tmp_path / "bend.bvh")
    found = told(tmp_path / "bend.bvh")
    assert found["figures"]["trunk_beyond_20_share"]["low"] == pytest.approx(2 / 3)


def test_the_page_shows_the_worst_postures_with_their_scores(recording, tmp_path):
    page = tmp_path / "new" / "page.html"
    code, shown, _ = opsim("motion", "score", recording, "-o", page, "--load", "8 kg")
    text = page.read_text()
    assert code == 0 and f"page: {page}" in shown
    assert "A. ana/1, at" in text and "Trunk flexed 70°" in text and "not said, so scores are intervals" in text
    assert text.count("<svg") >= 5 and not any(f'{word}="http' in text for word in ("src", "href"))


# Bad input


def test_every_mistake_is_said_at_once_with_the_nearest_word(recording, tmp_path):
    words = ["--load", "8", "--grip", "fai", "--sitting", "perhaps", "--arm-reference", "gravitty", "--rate", "100"]
    words += ["--threshold", "twis=3 deg", "--threshold", "side=200 deg", "--owas-disputed", "3374", "-n", "3"]
    code, shown, said = opsim("motion", "score", recording, *words, "-o", tmp_path / "page.png")
    assert code == 2 and not shown
    for words in (
        "--load: 8.0 has no unit; expected a mass",
        "--grip: no 'fai'; did you mean 'fair'?",
        "--sitting: no 'perhaps'",
        "--arm-reference: no 'gravitty'; did you mean 'gravity'?",
        "--threshold: found 'twis=3 deg', expected e.g. 'twist=15 deg'; did you mean 'twist'?",
        "--threshold side: found 200.0, expected 1 to 90 degrees",
        "--owas-disputed: no '3374'; did you mean '3373'?",
        "--rate: found 100.0, expected 1 to 60 a second",
        "page.png: found the ending '.png', expected .html",
        "-n: found 3 beside a recording",
    ):
        assert words in said, words


@pytest.mark.parametrize("rate", ["nan", "0", "inf"])
def test_a_rate_that_is_no_rate_is_refused(recording, rate):
    code, _, said = opsim("motion", "score", recording, "--rate", rate)
    assert code == 2 and "--rate: found" in said


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--load=-3 kg"], "expected a mass of 0 kg to 500 kg in both hands"),
        (["--load", "3000 kg"], "expected a mass of 0 kg to 500 kg in both hands"),
        (["--loaded", "0.8..0.2"], "--loaded: found '0.8..0.2', expected FROM..TO"),
        (["--loaded", "1..5"], "--loaded: found '1..5', expected FROM..TO"),
        (["--loaded", "grasp"], "--loaded: found 'grasp', expected FROM..TO"),
        (["--loaded", "grasp..1"], "no mark 'grasp'; the movement has no marks, only shares"),
        (["--load", "3 m"], "--load: "),
        (["--neck-neutral", "95 deg"], "expected -90 deg to 90 deg"),
        (["--threshold", "across_m=9 deg"], "--threshold across_m: "),
        (["stoop"], "TASK: found 'stoop' beside a recording"),
    ],
)
def test_words_that_cannot_be_meant_are_refused(recording, words, expected):
    code, _, said = opsim("motion", "score", recording, *words)
    assert code == 2 and expected in said


def test_what_is_neither_file_nor_library_is_said_with_what_is_expected():
    code, _, said = opsim("motion", "score", "bench_wrok/stoop")
    assert code == 2 and "bench_wrok/stoop: found neither a file nor a library" in said and "bench_work" in said
    code, _, said = opsim("motion", "score", "bench_work/stop")
    assert code == 2 and "did you mean 'stoop'?" in said


def test_a_page_never_replaces_what_is_read(tmp_path):
    file = tmp_path / "bend.html"
    write_bvh(take(0, 30), tmp_path / "bend.bvh")
    (tmp_path / "bend.bvh").rename(file)
    code, _, said = opsim("motion", "score", file, "-o", file)
    assert code == 2 and "found the movement that is read" in said


def test_a_skeleton_without_hands_and_head_says_which_scores_remain(tmp_path):
    names = tuple(name for name in SKELETON.names if not name.endswith(("hand", "head")))
    write_recording(Recording((take(0, 70, names=names),), "made", "MIT"), tmp_path / "few.npz")
    found = told(tmp_path / "few.npz", *ALL_SAID)
    missing = [note for note in found["notes"] if note.startswith("missing: ")]
    assert "no head: the neck is not known" in missing[0] and "no hands: how far the wrist is bent" in missing[1]
    assert found["figures"]["rula_mean"]["low"] < found["figures"]["rula_mean"]["high"]
    assert found["figures"]["owas_from_3_share"]["low"] == found["figures"]["owas_from_3_share"]["high"]
    assert not any("neutral of the neck" in note for note in found["notes"])


def test_postures_that_are_nan_are_counted_as_not_known(tmp_path):
    lost = take(0, 70)
    positions = lost.positions_m.copy()
    positions[:6] = np.nan
    write_recording(Recording((replace(lost, positions_m=positions),), "made", "MIT"), tmp_path / "lost.npz")
    page = tmp_path / "page.html"
    found = told(tmp_path / "lost.npz", *ALL_SAID, "-o", page)
    assert any("nothing is known of the posture for 25.0 % of the time" in note for note in found["notes"])
    assert found["figures"]["trunk_beyond_60_share"]["low"] == pytest.approx(2 / 3)
    assert "nan" not in page.read_text().split("<body>")[1].lower()


def changed(tmp_path, change):
    """A recording of one take of 0 and 70 degrees whose positions were changed."""
    made = take(0, 70)
    write_recording(Recording((replace(made, positions_m=change(made.positions_m.copy())),)), tmp_path / "it.npz")
    return tmp_path / "it.npz"


def without(joints, frames=slice(None)):
    def change(positions):
        positions[frames, [SKELETON.names.index(name) for name in joints]] = np.nan
        return positions

    return change


def once_far_off(positions):
    positions[3] = 1e12
    return positions


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda m: m * np.nan, "found no position at all"),
        (lambda m: m * 0.0, "found a body of 0 m, expected 1.05 to 2.35 m: it is not in metres"),
        (lambda m: m * 1000.0, "it is not in metres; see `opsim motion import`"),
        (once_far_off, "found a coordinate of 1e+12 m, expected a place in metres"),
        (lambda m: m[..., [1, 2, 0]], "found a body that stands along y, expected z: it does not stand upright"),
        (without(SKELETON.names[:3] + SKELETON.names[4:]), "found no posture of which anything is known"),
    ],
)
def test_what_is_no_upright_body_in_metres_is_refused(tmp_path, change, expected):
    code, shown, said = opsim("motion", "score", changed(tmp_path, change), "-o", tmp_path / "page.html")
    assert code == 2 and not shown and expected in said and "it.npz" in said
    assert not (tmp_path / "page.html").exists()


def test_takes_with_one_fault_are_one_sentence(tmp_path):
    two = [replace(take(0, 40, trial=str(k)), positions_m=take(0, 40).positions_m * (1000.0 + k)) for k in range(2)]
    write_recording(Recording((*two, take(0, 40, trial="good"))), tmp_path / "mm.npz")
    _, _, said = opsim("motion", "score", tmp_path / "mm.npz")
    assert said.count("it is not in metres") == 1 and "takes ana/0, ana/1: found" in said and "good" not in said


def test_a_body_that_lies_all_along_is_scored_with_a_word(tmp_path):
    """On the floor, its back at 0: nothing tells another axis, so it may well lie."""
    file = changed(
        tmp_path, lambda m: np.stack([-m[..., 2], m[..., 1], m[..., 0] - m[..., 0].min(axis=1)[:, None]], axis=-1)
    )
    assert any("does not stand upright at any time" in note for note in told(file)["notes"])


@pytest.mark.parametrize(
    ("joints", "expected"),
    [
        (["left_wrist"], "missing: no left wrist:"),
        (["left_hip", "right_hip"], "missing: no hips:"),
        (["left_shoulder", "left_elbow", "left_wrist", "left_hand"], "missing: no left elbow:"),
    ],
)
def test_joints_that_are_never_seen_are_named(tmp_path, joints, expected):
    assert any(note.startswith(expected) for note in told(changed(tmp_path, without(joints)))["notes"])


def test_joints_that_are_seen_at_times_are_named_with_their_share(tmp_path):
    """6 of 24 frames."""
    notes = told(changed(tmp_path, without(["right_hand"], slice(6))))["notes"]
    assert [note for note in notes if note.startswith("missing")] == [
        "missing: not seen for a part of the time, where scores are wider: right hand 25.0 %"
    ]


def test_takes_of_which_nothing_is_known_are_named(tmp_path):
    lost = replace(take(0, 70, trial="lost"), positions_m=np.full((24, 21, 3), np.nan))
    write_recording(Recording((take(0, 70), lost)), tmp_path / "lost.npz")
    assert "missing: nothing is known of ana/lost" in told(tmp_path / "lost.npz")["notes"]


# When the hands are full


@pytest.fixture
def marked(tmp_path):
    """Two seconds upright, 24 frames; a mark in frame 12."""
    write_recording(Recording((replace(take(0, 0), mark_frame={"grasp": 12.0}),)), tmp_path / "marked.npz")
    return tmp_path / "marked.npz"


@pytest.mark.parametrize(
    ("moments", "share"), [("grasp..1.0", 0.5), ("grasp..", 0.5), ("0.25..grasp", 0.25), ("..", 1)]
)
def test_a_load_counts_between_its_moments(marked, moments, share):
    """12 kg scores more than nothing: the mean of times with and without it tells for how long it counted."""
    words = [*ALL_SAID[2:], "--grip", "good", "--force", "repeated"]
    held, none = (told(marked, *words, "--load", load)["figures"]["rula_mean"]["low"] for load in ("12 kg", "0.1 kg"))
    found = told(marked, *words, "--load", "12 kg", "--loaded", moments)
    empty = told(marked, *ALL_SAID)["figures"]["rula_mean"]["low"]
    assert held > none >= empty
    assert found["figures"]["rula_mean"]["low"] == pytest.approx(empty + share * (held - empty))
    assert any(f"{100 * share:.1f} % of the time; empty hands before and after" in note for note in found["notes"])


def test_where_nobody_says_when_the_load_is_held_that_is_told(marked):
    (said,) = [note for note in told(marked, "--load", "8 kg")["notes"] if "in the hands" in note]
    assert said == "8 kg in the hands all the time, as nobody said when (--loaded FROM..TO; marks: grasp)"
    assert not any("in the hands" in note for note in told(marked, "--load", "0 kg")["notes"])


def test_marks_that_a_movement_does_not_have_are_refused_with_the_nearest(marked):
    code, _, said = opsim("motion", "score", marked, "--loaded", "grsp..1", "--load", "-1 kg")
    assert code == 2 and "--loaded: no mark 'grsp'; did you mean 'grasp'?" in said and "--load: found" in said
    code, _, said = opsim("motion", "score", marked, "--loaded", "grasp..0.1")
    assert code == 2 and "found hands full at no time from grasp to 10 %" in said


def test_draws_have_their_own_marks():
    found = told("bench_work/stoop", "-n", 3, "--load", "8 kg", "--loaded", "grasp..lift_off")
    always = told("bench_work/stoop", "-n", 3, "--load", "8 kg")
    assert found["figures"]["rula_mean"]["high"] < always["figures"]["rula_mean"]["high"]


def test_what_no_skeleton_shows_is_kept_apart_from_how_the_methods_were_read(recording):
    notes = told(recording)["notes"]
    assert [note for note in notes if note.startswith("not seen: ")] == [f"not seen: {one}" for one in NOT_SEEN]
    assert [note for note in notes if note.startswith("by rule: ")] == [f"by rule: {one}" for one in RULES]
