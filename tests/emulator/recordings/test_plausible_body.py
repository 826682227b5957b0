"""What is said of unit and axis is held against the body."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.importing import imported
from emulator.recordings.npz import write_recording
from emulator.recordings.take import Recording
from tests.emulator.recordings.body import body, trc_text

TAKE = body(40, 50.0)
LAIN = TAKE.positions_m[..., [2, 1, 0]] * [1, 1, -1]
"""On its back or belly: head towards x, what was forward is below."""


@pytest.fixture
def bvh(tmp_path):
    write_bvh(TAKE, tmp_path / "cm_y.bvh")
    return tmp_path / "cm_y.bvh"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"unit_m": 0.001}, r"found a body of 0.152 m from head to feet by --unit mm, expected 1.05 to 2.35 m; in cm"),
        ({"unit_m": 1.0}, r"found a body of 152 m .* give --unit cm"),
        ({"unit_m": 0.0123e-2}, r"by --unit 0.000123, .* give --unit cm"),
        ({"up": "z"}, r"lies all along by --up z, .* along y it stands .* give --up y"),
        ({"up": "-y"}, r"stands on its head all along by --up -y, .* give --up y"),
        ({"unit_m": 0.001, "up": "z"}, r"(?s)give --unit cm.*give --up y"),
    ],
)
def test_a_unit_or_axis_of_no_body_is_refused_with_the_one_that_fits(bvh, options, said):
    with pytest.raises(RecordingError, match=said) as error:
        imported(bvh, **options)
    assert all(line.startswith(f"{bvh}: found") for line in str(error.value).split("\n"))


def test_a_unit_that_the_file_says_wrongly_is_refused_and_may_be_overruled(tmp_path):
    path = tmp_path / "a.trc"
    path.write_text(trc_text(TAKE.names, 1000 * TAKE.positions_m, 50.0, "cm"))
    with pytest.raises(RecordingError, match=r"found a body of 15.2 m .* by its unit cm, .* give --unit mm"):
        imported(path)
    (found,) = imported(path, unit_m=0.001)
    assert found.body_m == pytest.approx(1.52, abs=0.01) and np.allclose(found.take.positions_m, TAKE.positions_m)


def test_what_is_said_rightly_is_taken_and_the_body_is_measured(bvh):
    (found,) = imported(bvh, unit_m=0.01, up="y")
    assert np.allclose(found.take.positions_m, TAKE.positions_m, atol=1e-6)
    assert "body: from head to feet it is 1.52 m" in found.notes


def test_an_npz_of_giants_is_refused(tmp_path):
    write_recording(Recording((replace(TAKE, positions_m=1000 * TAKE.positions_m),)), tmp_path / "a.npz")
    with pytest.raises(RecordingError, match=r"a.npz: found a body of 1.52e\+03 m"):
        imported(tmp_path / "a.npz")


def test_who_lies_on_the_floor_is_warned_about_only(tmp_path):
    places = LAIN - [0, 0, LAIN[..., 2].min()]
    places[..., 2] -= places[..., 2].min(axis=1)[:, None]
    write_bvh(replace(TAKE, positions_m=places), tmp_path / "a.bvh")
    (found,) = imported(tmp_path / "a.bvh", up="y")
    assert any(note.startswith("the body lies all along by --up y") for note in found.notes)


def test_who_lies_away_from_the_middle_of_the_room_is_warned_about_only(tmp_path):
    write_bvh(replace(TAKE, positions_m=LAIN + np.array([2, 0, 1])), tmp_path / "a.bvh")
    (found,) = imported(tmp_path / "a.bvh", up="y")
    assert any(note.startswith("the body lies all along") for note in found.notes)


def test_a_body_in_part_may_be_smaller(tmp_path):
    upper = [i for i, name in enumerate(TAKE.names) if not name.endswith(("knee", "ankle", "toe", "head"))]
    names = [TAKE.names[i] for i in upper]
    path = tmp_path / "a.trc"
    path.write_text(trc_text(names, 1000 * TAKE.positions_m[:, upper], 50.0, "mm"))
    assert len(imported(path, up="z")[0].take.names) == len(names)
