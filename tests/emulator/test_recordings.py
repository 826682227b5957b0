"""Takes and recordings: what flows between readers, cleaning and cutting."""

import json
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from emulator import read_motions as read_motions_of
from emulator.recordings import RecordingError, read_motions
from emulator.recordings.npz import read_recording, write_recording
from emulator.recordings.selection import WhereError, rows_where
from emulator.recordings.take import Recording, Take
from emulator.skeleton import CANONICAL, standard_skeleton
from emulator.synthetic.tasks import make
from tests.emulator.test_library import huge_npy
from tests.recordings import recording

COLUMNS = {
    "cov_correct": [1, 0, 1, 1],
    "worker": ["s01", "s02", "s10", "s02"],
    "cov_style": ["old", "new", "old", "old"],
}


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("cov_correct==1", [1, 0, 1, 1]),
        ("correct == 1", [1, 0, 1, 1]),
        ("cov_correct < 1", [0, 1, 0, 0]),
        ("worker == s02 and correct == 1", [0, 0, 0, 1]),
        ("subject in (s01, 's10') or correct != 1", [1, 1, 1, 0]),
        ("not (worker == s02 or style == new)", [1, 0, 1, 0]),
        ("worker not in (s02)", [1, 0, 1, 0]),
        ("worker == s01 or worker == s02 and correct == 1", [1, 0, 0, 1]),
    ],
)
def test_expressions_choose_rows(text, rows):
    assert rows_where(text, COLUMNS).tolist() == [bool(row) for row in rows]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("cov_corect == 1", "no covariate 'cov_corect'; did you mean 'cov_correct'"),
        ("cov_correct = 1", "cannot read '= 1'; write == for equals"),
        ("cov_correct ==", "expected a value, found 'the end'"),
        ("(cov_correct == 1", "expected '\\)', found 'the end'"),
        ("cov_correct == 1 worker", "expected 'and', 'or' or the end, found 'worker'"),
        ("worker < s02", "words have no order"),
        ("", "expected a covariate, found 'the end'"),
        ("__import__('os')", "no covariate '__import__'"),
    ],
)
def test_wrong_expressions_say_what_was_expected(text, word):
    with pytest.raises(WhereError, match=word):
        rows_where(text, COLUMNS)


def write(path, **changes):
    """A small recording: repetitions of 12, 10 and 11 frames; the second was executed wrongly, the third jumps."""
    rng = np.random.default_rng(0)
    body = standard_skeleton()
    positions = rng.normal(size=(body.n_joints, 3)) + 0.01 * rng.normal(size=(33, body.n_joints, 3))
    positions[28, 4] += 1.0
    arrays = {
        "positions": positions.astype(np.float32),
        "offsets": np.array([0, 12, 22, 33]),
        "fps": 50.0,
        "names": np.array([name.replace("left_", "l").replace("right_", "r") for name in body.names]),
        "parents": np.array(body.parents),
        "subject": np.array(["a", "a", "b"]),
        "trial": np.array(["1", "2", "1"]),
        "cov_correct": np.array([1, 0, 1]),
        "ann_turn_frame": np.array([6, 5, 4]),
        "meta": json.dumps({"source": "made here", "licence": "MIT"}),
    } | changes
    np.savez(path, **{key: value for key, value in arrays.items() if value is not None})
    return path


def test_a_recording_is_read_with_names_marks_notes_and_source(tmp_path):
    motions = read_motions(write(tmp_path / "uiprmd_wave.npz"))
    assert (motions.task, motions.source, motions.licence) == ("wave", "made here", "MIT")
    assert motions.skeleton.names == CANONICAL and motions.mark_names == ("turn",)
    assert [m.name for m in motions.motions] == ["a/1"] and motions.selection == "cov_correct==1"
    assert motions.mark_s.tolist() == [[pytest.approx(6 / 50)]]
    assert motions.motions[0].duration_s == pytest.approx(11 / 50)
    assert "left out b/1: a joint moves at" in motions.notes[0]


def test_glitches_can_be_kept_and_are_still_named(tmp_path):
    motions = read_motions(write(tmp_path / "wave.npz"), where=None, glitches="keep")
    assert len(motions) == 3 and motions.selection == "all"
    assert "kept b/1" in motions.notes[0]


def test_a_recording_that_does_not_say_what_is_correct_is_read_whole_and_says_so(tmp_path):
    path = write(tmp_path / "wave.npz", cov_correct=None)
    motions = read_motions(path)
    assert len(motions) == 2 and "does not say which executions are correct" in motions.notes[0]
    with pytest.raises(WhereError, match="no covariate 'cov_correct'"):
        read_motions(path, where="cov_correct==1")


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"fps": None}, "no fps"),
        ({"offsets": np.array([0, 12, 12, 33])}, "offsets: found 12 after 12, expected to rise by two"),
        ({"trial": np.array(["1"])}, "trial: found 1 values, expected 3"),
        ({"fps": 0.0}, "fps: found 0, expected 1 to 10000 frames a second"),
        ({"names": np.array(["wing"] + ["x"] * 20)}, "joint 'wing' is not known"),
        ({"positions": np.zeros((33, 4, 3))}, r"positions: found \(33, 4, 3\), expected \(frames, 21, 3\)"),
        ({"positions": np.full((33, 21, 3), np.nan)}, r"left of those with cov_correct==1\n.*positions are missing"),
        ({"positions": 300 * np.random.default_rng(0).normal(size=(33, 21, 3))}, "a/1: .*; in millimetres it would"),
        ({"positions": np.ones((33, 21, 3))}, "repetition a/1: bone to joint 'spine' has no length at frame 0"),
        ({"subject": np.array([object()] * 3)}, "subject.npy holds Python objects"),
        ({"offsets": np.array([])}, r"offsets: found \[\], expected whole numbers, two or more"),
        ({"subject": np.array([1.0, np.nan, 2.0])}, "subject: .*expected one text or whole number a repetition"),
        ({"offsets": np.array(33)}, "offsets: found one value, '33'"),
        ({"offsets": np.array([0.0, 12.5, 22, 33])}, "offsets: .*expected whole numbers"),
        ({"offsets": np.array([0, 12, 22, 40])}, "offsets: found 0 to 40, expected 0 to 33"),
        ({"fps": np.array([50.0, 60.0])}, r"fps: found shape \(2,\) of float64, expected one number"),
        ({"fps": np.array("fast")}, "fps: found one value, 'fast'"),
        ({"fps": 1e-9}, "fps: found 1e-09, expected 1 to 10000"),
        ({"fps": np.nan}, "fps: found nan"),
        ({"names": np.array("pelvis")}, "names: found one value, 'pelvis'"),
        ({"parents": np.arange(21) + 9}, "parents: .*expected joint numbers from -1 to 20"),
        ({"parents": np.array([-1, 0])}, "parents: found 2 values, expected 21"),
        ({"ann_turn_frame": np.array(5)}, "ann_turn_frame: found one value, '5'"),
        ({"cov_correct": np.ones((3, 2))}, r"cov_correct: found shape \(3, 2\)"),
        ({"core": np.array([0, 77]), "core_parents": np.array([-1, 0])}, "core: .*from 0 to 20"),
        ({"core": np.array([0, 1]), "core_parents": np.array([-1, 5])}, "core_parents: .*from -1 to 1"),
        ({"core": np.array([0, 1])}, "core, core_parents: found one of them"),
    ],
)
def test_a_broken_recording_is_refused_by_name(tmp_path, changes, word):
    path = write(tmp_path / "wave.npz", **changes)
    with pytest.raises(RecordingError, match=word) as error:
        read_motions(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize("read", [read_motions, read_recording])
def test_a_file_of_another_form_is_sent_to_import(tmp_path, read):
    (tmp_path / "take.bvh").write_text("HIERARCHY")
    with pytest.raises(RecordingError, match=r"'opsim motion import take\.bvh -o take\.npz' makes one of it"):
        read(tmp_path / "take.bvh")


def test_all_mistakes_of_a_file_are_said_at_once(tmp_path):
    path = write(tmp_path / "wave.npz", fps=0.0, trial=None, names=np.array("x"), ann_turn_frame=np.array(1))
    with pytest.raises(RecordingError) as error:
        read_motions(path)
    lines = str(error.value).splitlines()
    assert all(line.startswith(f"{path}: ") for line in lines)
    assert {line.split(": ")[1] for line in lines} == {"not a recording", "fps", "names", "ann_turn_frame"}


@pytest.mark.parametrize("frame", [-5, 10**6, 12, np.nan, np.inf])
def test_a_mark_outside_its_repetition_is_refused_by_name(tmp_path, frame):
    path = write(tmp_path / "wave.npz", ann_turn_frame=np.array([frame, frame, 4.0]))
    with pytest.raises(RecordingError, match=r"ann_turn_frame: 2 of 3 marks lie outside: a/1 has .*expected 0 to 11"):
        read_motions(path, where=None)


def test_a_mark_may_be_missing_where_the_repetition_is_not_chosen(tmp_path):
    path = write(tmp_path / "wave.npz", ann_turn_frame=np.array([11.0, np.nan, 0.0]))
    assert len(read_motions(path, where="cov_correct==1")) == 1


def test_of_many_wrong_marks_the_first_are_named(tmp_path):
    arrays = {"subject": np.array(list("abcde")), "trial": np.arange(5), "ann_turn_frame": np.full(5, -5)}
    path = write(tmp_path / "w.npz", offsets=np.array([0, 6, 12, 18, 22, 33]), cov_correct=None, **arrays)
    with pytest.raises(RecordingError, match=r"5 of 5 marks.*a/0.*b/1.*c/2 has -5 \(expected 0 to 5\), \.\.\.$"):
        read_motions(path)


@pytest.mark.parametrize("text", ["(" * 3000 + "correct == 1" + ")" * 3000, "not " * 3000 + "correct == 1"])
def test_a_bottomless_expression_is_refused_in_a_short_word(text):
    with pytest.raises(WhereError, match="nest deeper than 50") as error:
        rows_where(text, COLUMNS)
    assert len(str(error.value)) < 300
    assert rows_where("(" * 40 + "correct == 1" + ")" * 40, COLUMNS).tolist() == [True, False, True, True]


def test_a_recording_that_declares_more_than_it_holds_is_refused_before_anything_is_made(tmp_path):
    path = write(tmp_path / "wave.npz")
    with zipfile.ZipFile(path, "a") as file:
        file.writestr("cov_size.npy", huge_npy())
    with pytest.raises(RecordingError, match=r"cov_size.npy is damaged: it declares \(1000000000000,\)"):
        read_motions(path)


@pytest.mark.parametrize("meta", ["[" * 100_000, "no json", "[1]", np.array([1.0, 2.0])])
def test_a_meta_that_cannot_be_read_is_noted(tmp_path, meta):
    motions = read_motions(write(tmp_path / "wave.npz", meta=meta))
    assert motions.licence == "not stated" and "meta is no JSON object" in motions.notes[-1]


def test_other_files_are_refused_by_name(tmp_path):
    (tmp_path / "wave.npz").write_bytes(b"\x00\x01 nothing")
    for path, word in [("wave.npz", "not a recording"), ("none.npz", "no such file"), ("wave.bvh", "motion import")]:
        if path.endswith("bvh"):
            (tmp_path / path).write_text("HIERARCHY")
        with pytest.raises(RecordingError, match=word):
            read_motions(tmp_path / path)


def test_deep_squat_has_41_correct_repetitions_of_six_people():
    motions = read_motions(recording("uiprmd_deep_squat"), where="cov_correct==1")
    assert len(motions) == 41 and motions.workers == ("s01", "s02", "s03", "s04", "s05", "s06")
    assert motions.skeleton.n_bones == 20 and motions.mark_names == ("turn",)
    assert "Public Domain" in motions.licence


def test_recorded_positions_come_back_from_a_motion():
    path = recording("uiprmd_side_lunge")
    motions = read_motions(path, where=None)
    with np.load(path) as file:
        positions, offsets = file["positions"].astype(float), file["offsets"]
    for i in (0, 40, 81):
        back = motions.motions[i].positions_m(world=True, rigid=False)
        assert np.abs(back - positions[offsets[i] : offsets[i + 1]]).max() < 1e-9


def test_the_glitches_left_in_hdm05_are_left_out_by_name():
    notes = " ".join(read_motions(recording("hdm05_squat_once")).notes)
    assert all(f"left out dg/{trial}" in notes for trial in ("026", "028", "030"))


def made_recording(n=3):
    motions, _ = make("reach", 1, n)
    skeleton = motions.skeleton
    takes = [
        Take(
            skeleton.names, skeleton.parents, m.positions_m(world=True), 50.0, m.worker, m.trial,
            mark_frame={"touch": float(m.mark_s[0] * 50)}, covariates={"cov_correct": 1},
            contact=np.ones((len(m.time_s), 2), bool),
        )
        for m in motions.motions
    ]  # fmt: skip
    return Recording(tuple(takes), "made", "MIT", ("a note",))


def test_a_written_recording_is_read_again_to_the_bit(tmp_path):
    made = made_recording()
    gap = made.takes[0].positions_m.copy()
    gap[3:5, 2] = np.nan
    made = replace(made, takes=(replace(made.takes[0], positions_m=gap), *made.takes[1:]))
    write_recording(made, tmp_path / "a.npz")
    again = read_recording(tmp_path / "a.npz")
    assert (again.source, again.licence, again.notes) == ("made", "MIT", ("a note",))
    for one, other in zip(made.takes, again.takes):
        assert np.array_equal(one.positions_m, other.positions_m, equal_nan=True)
        assert np.array_equal(one.contact, other.contact)
        assert (one.names, one.parents, one.name, one.rate_hz) == (
            other.names,
            other.parents,
            other.name,
            other.rate_hz,
        )
        assert dict(one.mark_frame) == dict(other.mark_frame) and dict(one.covariates) == dict(other.covariates)


def test_the_same_recording_gives_the_same_bytes(tmp_path):
    for name in "ab":
        write_recording(made_recording(), tmp_path / f"{name}.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_a_written_recording_can_be_fitted_from(tmp_path):
    write_recording(made_recording(), tmp_path / "reach.npz")
    motions = read_motions_of(tmp_path / "reach.npz")
    assert (len(motions), motions.mark_names, motions.task) == (3, ("touch",), "reach")
    assert motions.skeleton == standard_skeleton()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rate_hz": float("nan")}, "expected a positive number"),
        ({"rate_hz": 0.0}, "expected a positive number"),
        ({"names": ("pelvis",)}, "positions must be"),
        ({"parents": (-1,)}, "21 names and 1 parents"),
        ({"contact": np.ones((2, 2), bool)}, "contact must be"),
    ],
)
def test_a_take_whose_parts_disagree_is_refused(change, said):
    with pytest.raises(ValueError, match=said):
        replace(made_recording(1).takes[0], **change)


def test_takes_that_are_not_alike_are_no_recording():
    made = made_recording(2)
    for change in ({"rate_hz": 25.0}, {"mark_frame": {}}, {"names": made.names[::-1]}):
        with pytest.raises(ValueError, match="w1/r2"):
            Recording((made.takes[0], replace(made.takes[1], **change)))
    with pytest.raises(ValueError, match="found none"):
        Recording(())
