"""ISO 11226 and EN 1005-4."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.posture_limits import (
    ACCEPTABLE,
    CONDITIONAL,
    EN_1005_4,
    ISO_11226,
    NOT_RECOMMENDED,
    OFTEN,
    RARELY,
    STATIC,
    holding_time_s,
    judged_moving,
    judged_static,
    zone,
)

REGIONS = ("trunk", "left_arm", "right_arm", "head", "neck")


@pytest.mark.parametrize(
    ("region", "angle_deg", "seconds"),
    [
        ("trunk", 20.0, np.inf),
        ("trunk", 40.0, 150.0),  # half-way from 4 min to 1 min: 240 - 0.5 x 180
        ("trunk", 60.0, 60.0),
        ("trunk", 60.1, 0.0),
        ("trunk", -6.0, 0.0),
        ("left_arm", 30.0, 150.0),  # a quarter of the way from 3 min to 1 min: 180 - 0.25 x 120
        ("right_arm", 60.0, 60.0),
        ("head", 55.0, 270.0),  # half-way from 8 min to 1 min: 480 - 0.5 x 420
        ("head", 86.0, 0.0),
        ("neck", 25.0, np.inf),
        ("neck", 25.1, 0.0),
    ],
)
def test_holding_times_by_hand(region, angle_deg, seconds):
    assert holding_time_s(angle_deg, getattr(ISO_11226, region)) == pytest.approx(seconds)


def test_a_posture_is_conditional_while_its_time_is_kept():
    trunk = ISO_11226.trunk
    assert judged_static([10.0, 40.0, 40.0, 70.0], [3600.0, 150.0, 151.0, 5.0], trunk).tolist() == [
        ACCEPTABLE,
        CONDITIONAL,
        NOT_RECOMMENDED,
        NOT_RECOMMENDED,
    ]


@given(st.sampled_from(REGIONS), st.floats(0, 180), st.floats(0, 180), st.floats(0, 3600), st.floats(0, 3600))
def test_more_bent_or_longer_is_never_better(region, one, other, shorter, longer):
    held = getattr(ISO_11226, region)
    (low, high), (brief, long) = sorted((one, other)), sorted((shorter, longer))
    assert holding_time_s(low, held) >= holding_time_s(high, held)
    assert judged_static(low, brief, held) <= judged_static(high, long, held)


def test_zones_belong_to_their_edges():
    assert zone([-5.1, -5.0, 20.0, 20.1, 60.0, 60.1, np.nan], EN_1005_4.trunk).tolist() == [0, 1, 1, 2, 2, 3, -1]


@pytest.mark.parametrize("region", ["trunk", "arm", "neck"])
def test_both_standards_leave_an_upright_body_the_same_leeway(region):
    zones, held = (
        getattr(EN_1005_4, region),
        getattr(ISO_11226, {"arm": "left_arm", "neck": "head"}.get(region, region)),
    )
    assert zones.low == 0.0 and zones.backward_from == held.least == -5.0
    assert zone([-1.0, -5.0, -5.1], zones).tolist() == [1, 1, 0]


@pytest.mark.parametrize(
    ("angle_deg", "region", "static", "rarely", "often"),
    [
        (10.0, "trunk", ACCEPTABLE, ACCEPTABLE, ACCEPTABLE),
        (40.0, "trunk", CONDITIONAL, ACCEPTABLE, NOT_RECOMMENDED),
        (70.0, "trunk", NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED),
        (40.0, "arm", CONDITIONAL, ACCEPTABLE, CONDITIONAL),
        (70.0, "arm", NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED),
        (41.0, "neck", NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED),
        (11.0, "sideways", NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED),
        (10.0, "sideways", ACCEPTABLE, ACCEPTABLE, ACCEPTABLE),
    ],
)
def test_zones_of_the_standard(angle_deg, region, static, rarely, often):
    zones = getattr(EN_1005_4, region)
    assert [int(judged_moving(angle_deg, way, zones)) for way in (STATIC, RARELY, OFTEN)] == [static, rarely, often]


@given(st.sampled_from(["trunk", "arm", "neck", "sideways"]), st.floats(0, 180), st.floats(0, 180))
def test_a_farther_zone_is_never_better(region, one, other):
    zones, (low, high) = getattr(EN_1005_4, region), sorted((one, other))
    for way in (STATIC, RARELY, OFTEN):
        assert judged_moving(low, way, zones) <= judged_moving(high, way, zones)


def test_what_nobody_knows_is_not_judged():
    assert judged_moving(np.nan, OFTEN, EN_1005_4.trunk) == -1
    assert np.isnan(holding_time_s(np.nan, ISO_11226.trunk))
