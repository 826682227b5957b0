"""Worker and trial by the name of the file."""

from pathlib import Path

import pytest

from emulator.recordings import RecordingError
from emulator.recordings.take import named, parts_of_name
from tests.emulator.recordings.body import body


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
