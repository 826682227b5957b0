"""Shares of strength that leaning asks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.static_holds import hold_share
from opsim.plan.workers import Body

BODIES = [None, Body(), Body(mass_kg=60.0, height_m=1.65, sex="f"), Body(mass_kg=95.0, height_m=1.9, sex="m")]


def test_an_upright_body_holds_nothing_and_a_level_one_most():
    for region in ("trunk", "left_arm", "right_arm"):
        assert hold_share(region, 0.0) == 0.0
        assert 0 < hold_share(region, 45.0) < hold_share(region, 90.0) <= 1.0


def test_a_level_arm_by_hand():
    """75 kg, 1.75 m, man (age 40): shoulder strength -30.8 - 0.24 x 40 + 36 x 1.75 + 0.49 x 75 = 59.35 Nm; arm:
    0.0271 x 0.5772 x 0.186 + (0.0162 + 0.0061) x 0.186 + (0.0162 x 0.4574 + 0.0061) x 0.146 = 0.0090297 of m g h.
    9.80665 x 75 x 1.75 x 0.0090297 = 11.622 Nm, 19.58 %.
    """
    assert hold_share("left_arm", 90.0, Body(mass_kg=75.0, height_m=1.75, sex="m")) == pytest.approx(0.1958, abs=1e-4)


def test_a_level_trunk_by_hand():
    """Same man: 0.30 x (0.3229 x 0.6153 + 2 x 0.0494) + 0.36 x 0.0694 = 0.114228; x 9.80665 x 75 x 1.75 = 147.02 Nm,
    of 234 Nm: 62.8 %.
    """
    assert hold_share("trunk", 90.0, Body(mass_kg=75.0, height_m=1.75, sex="m")) == pytest.approx(0.6283, abs=1e-4)


@given(st.sampled_from(["trunk", "left_arm"]), st.floats(0, 90), st.floats(0, 90), st.sampled_from(BODIES))
def test_leaning_farther_never_asks_for_less(region, one, other, body):
    low, high = sorted((one, other))
    assert 0 <= hold_share(region, low, body) <= hold_share(region, high, body) <= 1
    assert np.isclose(hold_share(region, -low, body), hold_share(region, low, body))
