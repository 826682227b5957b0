"""Arms before and behind the trunk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT, CANONICAL
from opsim.ergonomics.measures import measures_of_positions
from opsim.ergonomics.strain.static_holds import arm_angle_deg
from tests.opsim.ergonomics.bodies import arm, bent, standing, turn
from tests.opsim.ergonomics.made_frames import made_frames


@pytest.mark.parametrize(
    ("flexion", "abduction", "elevation", "angle"),
    [
        (30.0, 0.0, 30.0, 30.0),
        (-30.0, 0.0, 30.0, -30.0),
        (-4.9, 0.0, 4.9, 4.9),
        (-5.1, 0.0, 5.1, -5.1),
        (-20.0, 80.0, 80.6, 80.6),  # asin(cos 80 x sin 20) = 3.4 degrees out of the plane of the trunk: to the side
        (-20.0, 30.0, 35.5, -35.5),  # asin(cos 30 x sin 20) = 17.2
        (-170.0, 0.0, 170.0, 170.0),  # straight up and a little back: above the head, not behind the trunk
        (np.nan, np.nan, 40.0, 40.0),
        (-30.0, 0.0, np.nan, np.nan),
    ],
)
def test_arms_by_hand(flexion, abduction, elevation, angle):
    names = {"flexion": flexion, "abduction": abduction, "elevation": elevation}
    frames = made_frames(1, **{f"right_arm_{name}": value for name, value in names.items()})
    assert arm_angle_deg(frames.measures, "right") == pytest.approx([angle], nan_ok=True)
    assert arm_angle_deg(frames.measures, "left").tolist() == [0.0]


@pytest.mark.parametrize("trunk", [0.0, 40.0])
@pytest.mark.parametrize(("back", "angle"), [(30.0, -1), (-30.0, 1), (-2.0, 1)])
def test_arms_of_bodies_are_behind_their_own_trunk(back, angle, trunk):
    """An arm turned 30 degrees back from the trunk is behind it, upright and bent alike; it keeps its elevation."""
    body = bent(flexion=trunk, body=arm(standing(), "left", turn([0, 1, 0], back)))
    measures = measures_of_positions(body[None], CANONICAL)
    elevation = measures[:, AT["left_arm_elevation"]]
    assert elevation == pytest.approx(abs(trunk + back))
    assert arm_angle_deg(measures, "left") == pytest.approx(angle * elevation)


@given(st.floats(-180, 180), st.floats(-90, 90), st.floats(0, 180))
def test_only_the_sign_of_elevation_changes(flexion, abduction, elevation):
    names = {"flexion": flexion, "abduction": abduction, "elevation": elevation}
    frames = made_frames(1, **{f"left_arm_{name}": value for name, value in names.items()})
    assert np.abs(arm_angle_deg(frames.measures, "left")) == elevation
