"""Any file, told by its ending."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.raw import FORMATS, format_of, read_take, read_takes
from emulator.recordings.take import Recording
from emulator.recordings.takes_npz import write_recording
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
