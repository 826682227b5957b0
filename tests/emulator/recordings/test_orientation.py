"""Unit and upward axis, found from the body or asked for.

What is said of unit and axis is held against the body.
"""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.importing import imported
from emulator.recordings.npz import read_recording, write_recording
from emulator.recordings.orientation import AXES, UNITS_M, NotTold, found_unit_m, found_up, placed, turned_up
from emulator.recordings.take import Recording
from tests.emulator.recordings.body import body, trc_text
from tests.recordings import recording

RECORDINGS = [
    "bandai2_walk", "hdm05_deposit_floor", "hdm05_jog_circle", "hdm05_squat_once", "uiprmd_deep_squat",
    "uiprmd_inline_lunge", "uiprmd_sit_to_stand",
]  # fmt: skip


def lain(positions, up):
    """The positions as a file has them whose axis ``up`` points up: the other way round of ``turned_up``."""
    turn = turned_up(np.eye(3), up)
    return positions @ np.linalg.inv(turn)


@pytest.mark.parametrize("up", AXES)
def test_turning_up_is_a_turn_and_no_mirror(up):
    turn = turned_up(np.eye(3), up)
    assert np.linalg.det(turn) == pytest.approx(1)
    vector = np.zeros(3)
    vector["xyz".index(up[-1])] = -1.0 if up[0] == "-" else 1.0
    assert np.array_equal(turned_up(vector, up), [0, 0, 1])


@pytest.mark.parametrize("up", AXES)
@pytest.mark.parametrize("unit", UNITS_M)
def test_unit_and_axis_are_found(unit, up):
    take = body()
    there = lain(take.positions_m, up) / UNITS_M[unit]
    places, notes = placed(there, take.names)
    assert np.allclose(places, take.positions_m, atol=1e-9)
    assert len(notes) == 2 and unit in notes[0] and f": {up} " in notes[1]


@pytest.mark.parametrize("name", RECORDINGS)
def test_unit_and_axis_of_real_takes_are_found_in_every_unit(name):
    for take in read_recording(recording(name)).takes[::4]:
        there = lain(take.positions_m, "-y")
        assert found_up(there, take.names)[0] == "-y", take.name
        for unit_m in (*UNITS_M.values(), 0.0254 / 0.45):
            assert found_unit_m(there / unit_m, take.names)[0] == unit_m, take.name


def test_a_body_without_names_is_measured():
    take = body()
    names = [f"point{i}" for i in range(len(take.names))]
    places, _ = placed(lain(take.positions_m, "y") * 1000, names)
    assert np.allclose(places, take.positions_m, atol=1e-9)


def test_gaps_do_not_hide_the_body():
    take = body()
    holes = take.positions_m.copy()
    holes[np.random.default_rng(0).random(holes.shape[:2]) < 0.2] = np.nan
    places, _ = placed(lain(holes, "y") * 100, take.names)
    assert np.allclose(places, holes, atol=1e-9, equal_nan=True)


def test_what_the_body_does_not_tell_is_asked_for_both_at_once():
    take = body()
    cloud = np.random.default_rng(0).normal(size=take.positions_m.shape) * 5e7
    with pytest.raises(RecordingError) as error:
        placed(cloud, [f"p{i}" for i in range(len(take.names))], where="a.csv")
    said = str(error.value)
    assert "a.csv: the unit cannot be told" in said and "--unit" in said and "--up" in said


def test_lying_people_have_no_upward_axis():
    take = body()
    with pytest.raises(NotTold, match="from feet to head"):
        found_up(lain(take.positions_m, "y") @ np.array([[0.7, 0.7, 0], [-0.7, 0.7, 0], [0, 0, 1]]), take.names)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"unit_m": -1.0}, "expected metres of one unit"),
        ({"unit_m": float("nan")}, "expected metres of one unit"),
        ({"up": "w"}, "expected one of x, y, z"),
    ],
)
def test_what_is_given_is_checked(change, said):
    take = body()
    with pytest.raises(RecordingError, match=said):
        placed(take.positions_m, take.names, where="a.bvh", **change)


@pytest.mark.parametrize("value", [np.nan, 1e30])
def test_positions_that_are_none_are_refused(value):
    take = body()
    with pytest.raises(RecordingError, match=r"a\.bvh: found"):
        placed(np.full_like(take.positions_m, value), take.names, where="a.bvh")


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
