"""From a file to a take with canonical joints."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.importing import imported, together
from emulator.recordings.npz import write_recording
from emulator.recordings.take import Recording
from tests.emulator.recordings.body import body, write_c3d

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
