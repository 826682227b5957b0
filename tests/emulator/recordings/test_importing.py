"""Any file, told by its ending.

From a file to a take with canonical joints.

Worker and trial by the name of the file.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.formats import FORMATS
from emulator.recordings.importing import format_of, imported, read_take, read_takes, together
from emulator.recordings.npz import write_recording
from emulator.recordings.take import Recording, named, parts_of_name
from tests.emulator.recordings.body import body, write_c3d


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("a.bhv", "found '.bhv', expected a recording's ending; did you mean '.bvh'?"),
        ("a.fbx", "found '.fbx'.*known: .bvh"),
        ("a", "found 'no ending'"),
        ("a.asf", "without motion, expected the .amc"),
        ("a.csv", "no such file"),
    ],
)
def test_what_cannot_be_read_is_said(tmp_path, name, said):
    with pytest.raises(RecordingError, match=said):
        read_take(tmp_path / name)


def test_a_folder_is_no_file(tmp_path):
    (tmp_path / "a.csv").mkdir()
    with pytest.raises(RecordingError, match="found a folder"):
        read_take(tmp_path / "a.csv")


def test_an_option_that_a_format_cannot_use_is_refused(tmp_path):
    (tmp_path / "a.bvh").write_text("HIERARCHY")
    with pytest.raises(RecordingError, match="found the frame rate and names of the columns given, expected none"):
        read_take(tmp_path / "a.bvh", rate_hz=30.0, columns="names.txt", unit_m=None)
    with pytest.raises(TypeError, match="no option 'colour'"):
        read_take(tmp_path / "a.bvh", colour=1)


def test_every_format_has_a_reader_that_takes_its_options():
    import inspect
    from importlib import import_module

    for form in FORMATS.values():
        reader = getattr(import_module(f"emulator.recordings.{form.module}"), form.reader)
        assert set(form.options) <= set(inspect.signature(reader).parameters), form


def test_the_ending_counts_and_not_its_case(tmp_path):
    assert format_of(tmp_path / "A.BVH") == "BVH" and format_of(tmp_path / "a.C3D") == "C3D"


def test_an_npz_gives_all_its_takes(tmp_path):
    from dataclasses import replace

    take = body()
    write_recording(Recording((take, replace(take, trial="2"))), tmp_path / "a.npz")
    takes = read_takes(tmp_path / "a.npz")
    assert [each.trial for each in takes] == ["1", "2"] and np.array_equal(takes[0].positions_m, take.positions_m)
    with pytest.raises(RecordingError, match="found 2 takes, expected one"):
        read_take(tmp_path / "a.npz")


@pytest.mark.parametrize("ending", ["bvh", "trc", "json", "csv"])
def test_a_take_of_one_frame_is_refused_by_its_file(tmp_path, ending):
    from dataclasses import replace

    from emulator.recordings.bvh_write import write_bvh
    from tests.emulator.recordings.body import json_text, table_text, trc_text

    one = replace(body(), positions_m=body().positions_m[:1])
    path = tmp_path / f"one.{ending}"
    names = list(one.names)
    header = "time," + ",".join(f"{name}_{axis}" for name in names for axis in "xyz")
    if ending == "bvh":
        write_bvh(one, path)
    elif ending == "json":
        path.write_text(json_text({"names": names, "fps": 50, "frames": one.positions_m}))
    else:
        table = table_text([header], one.positions_m, first=np.zeros(1))
        path.write_text(table if ending == "csv" else trc_text(names, one.positions_m))
    with pytest.raises(RecordingError, match=r"one\.\w+: found 1 frame, expected 2 or more"):
        read_take(path)


def test_a_file_that_is_not_there_is_said_before_its_options(tmp_path):
    with pytest.raises(RecordingError, match="no such file"):
        read_take(tmp_path / "nosuch.bvh", rate_hz=50.0)


def test_a_folder_of_no_keypoints_is_told_what_would_be_read(tmp_path):
    with pytest.raises(RecordingError, match=r"found a folder, expected a file, or a folder of \*_keypoints.json"):
        read_take(tmp_path)


TAKE = body(40, 50.0)


@pytest.fixture
def npz(tmp_path):
    write_recording(Recording((TAKE, replace(TAKE, trial="2")), "ours", "MIT"), tmp_path / "a.npz")
    return tmp_path / "a.npz"


def test_a_bvh_comes_back_as_it_was_written(tmp_path):
    write_bvh(TAKE, tmp_path / "s01_e01.bvh")
    (found,) = imported(tmp_path / "s01_e01.bvh")
    assert found.take.names == TAKE.names and found.take.parents == TAKE.parents
    assert np.allclose(found.take.positions_m, TAKE.positions_m, atol=1e-5)
    assert found.take.name == "s01/e01" and found.sides.verdict == "as named" and found.format == "BVH"
    assert not found.gap_share.any() and found.spread_m.max() < 1e-4


def test_the_same_body_in_four_formats_is_the_same_take(tmp_path):
    pytest.importorskip("ezc3d")
    from tests.emulator.recordings.body import json_text, table_text, trc_text

    y_up = TAKE.positions_m @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    header = ",".join(f"{name}_{axis}" for name in TAKE.names for axis in "xyz")
    (tmp_path / "a.csv").write_text(table_text(["time," + header], 1000 * y_up, first=np.arange(40) / 50))
    (tmp_path / "a.trc").write_text(trc_text(TAKE.names, 100 * y_up, 50.0, "cm"))
    (tmp_path / "a.json").write_text(json_text({"names": list(TAKE.names), "fps": 50, "frames": TAKE.positions_m}))
    write_c3d(tmp_path / "a.c3d", TAKE.names, 1000 * TAKE.positions_m, 50.0)
    for ending in ("csv", "trc", "json", "c3d"):
        (found,) = imported(tmp_path / f"a.{ending}")
        assert np.allclose(found.take.positions_m, TAKE.positions_m, atol=1e-6), ending
        assert found.take.rate_hz == pytest.approx(50.0) and found.take.parents == TAKE.parents, ending


def test_a_body_pinned_at_its_pelvis_is_told(tmp_path):
    from tests.emulator.recordings.body import joint

    squat = replace(TAKE, positions_m=TAKE.positions_m + np.linspace(0, 0.3, 40)[:, None, None] * [0, 0, 1])
    pinned = replace(squat, positions_m=squat.positions_m - joint(squat, "pelvis")[:, None])
    feet = pinned.positions_m.copy()
    feet[:, -1, 2] -= np.linspace(0, 0.2, 40)
    for take, told in ((squat, False), (replace(pinned, positions_m=feet), True)):
        write_recording(Recording((take,)), tmp_path / "a.npz")
        notes = imported(tmp_path / "a.npz")[0].notes
        assert any("way and height above the floor are not known" in note for note in notes) == told


def test_takes_of_an_npz_keep_their_names_and_their_licence(npz):
    found = imported(npz)
    assert [each.take.name for each in found] == ["unknown/1", "unknown/2"]
    assert (together(found).source, together(found).licence) == ("ours", "MIT")
    assert (together(found, "x", "y").source, together(found, "x", "y").licence) == ("x", "y")


def test_exchanged_sides_are_kept_swapped_or_mirrored_as_asked(tmp_path):
    wrong = replace(TAKE, positions_m=TAKE.positions_m * [1, -1, 1])
    write_recording(Recording((wrong,)), tmp_path / "a.npz")
    with pytest.raises(RecordingError, match=r"a\.npz: left and right are exchanged"):
        imported(tmp_path / "a.npz")
    assert np.array_equal(imported(tmp_path / "a.npz", sides="keep")[0].take.positions_m, wrong.positions_m)
    assert np.array_equal(imported(tmp_path / "a.npz", sides="mirror")[0].take.positions_m, TAKE.positions_m)
    (swapped,) = imported(tmp_path / "a.npz", sides="swap")
    hand, twin = TAKE.names.index("left_hand"), TAKE.names.index("right_hand")
    assert np.array_equal(swapped.take.positions_m[:, hand], wrong.positions_m[:, twin])
    assert "names exchanged as asked" in swapped.notes[-1]


def test_what_does_not_go_together_is_said_of_every_take(npz, tmp_path):
    slow = replace(TAKE, rate_hz=25.0, trial="3")
    write_recording(Recording((slow,)), tmp_path / "b.npz")
    copy = tmp_path / "c.npz"
    copy.write_bytes(npz.read_bytes())
    with pytest.raises(RecordingError) as error:
        together([*imported(npz), *imported(tmp_path / "b.npz"), *imported(copy)])
    said = str(error.value)
    assert "b.npz: found 25 frames a second, expected 50" in said and "both are called unknown/1" in said


def test_marks_that_not_all_takes_have_are_left_out(npz):
    first, second = imported(npz)
    marked = replace(first, take=replace(first.take, mark_frame={"touch": 3.0}))
    assert together([marked, second]).takes[0].mark_frame == {}
    assert together([marked]).takes[0].mark_frame == {"touch": 3.0}


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("uiprmd_vicon_m05_s01_e02_positions.csv", "s01/e02"),
        ("subject-7_take3.bvh", "subject-7/take3"),
        ("P12 rep_04.c3d", "P12/rep_04"),
        ("s03.trc", "s03/s03"),
        ("reach_001.bvh", "unknown/reach_001"),
        ("steps10.csv", "unknown/steps10"),
    ],
)
def test_parts_of_a_name_are_worker_and_trial(file, name):
    assert named(body(), Path(file), None, None, None, 1).name == name


def test_what_is_given_goes_before_what_the_name_says():
    assert named(body(), Path("s01_e02.csv"), "ana", None, None, 1).name == "ana/e02"
    assert named(body(), Path("s01_e02.csv"), None, "9", None, 1).name == "s01/9"
    assert named(body(), Path("s01_e02.csv"), None, None, "{trial}_{worker}", 1).name == "e02/s01"


def test_several_takes_of_a_file_keep_their_trials_apart():
    assert named(body(), Path("s01_e02.npz"), "ana", None, None, 3).name == "ana/unknown 1"


@pytest.mark.parametrize(
    ("pattern", "parts"),
    [
        ("HDM_{worker}_*_{trial}_*", {"worker": "bd", "trial": "001"}),
        ("HDM_{worker}_*.amc", {"worker": "bd"}),
        ("*_{trial}_120", {"trial": "001"}),
    ],
)
def test_a_pattern_finds_its_parts(pattern, parts):
    assert parts_of_name(Path("HDM_bd_depositFloorR_001_120.amc"), pattern) == parts


@pytest.mark.parametrize(
    ("pattern", "said"),
    [
        ("*", "expected {worker} or {trial}"),
        ("{foo}_{worker", "found '{foo}', '{worker' in"),
        ("{worker}_{trail}", "found '{trail}' in"),
        ("{worker}{worker}", "each once at most"),
        ("X{worker}", "a.bvh: the name does not fit"),
        ("(.+.+)+{worker}!", "a.bvh: the name does not fit"),
    ],
)
def test_a_wrong_pattern_is_refused(pattern, said):
    with pytest.raises(RecordingError, match=said):
        parts_of_name(Path("a.bvh"), pattern)
