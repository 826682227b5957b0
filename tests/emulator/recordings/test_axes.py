"""Unit and upward axis, found from the body or asked for."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.npz import read_recording
from emulator.recordings.orientation import AXES, UNITS_M, NotTold, found_unit_m, found_up, placed, turned_up
from tests.emulator.recordings.body import body
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
