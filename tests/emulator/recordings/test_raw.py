"""Any file, told by its ending."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.importing import FORMATS, format_of, read_take, read_takes
from emulator.recordings.npz import write_recording
from emulator.recordings.take import Recording
from tests.emulator.recordings.body import body


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
