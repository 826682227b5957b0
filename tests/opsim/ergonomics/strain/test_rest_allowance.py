"""Rest allowances of Rohmert, Murrell and Price."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.energy import (
    holding_time_min,
    murrell_rest_share,
    of_whole,
    price_relaxation,
    rohmert_rest_share,
)


def test_rohmerts_holding_times_by_hand():
    """f = 0.5: -1.5 + 4.2 - 2.4 + 0.8 = 1.1 min; f = 1: -1.5 + 2.1 - 0.6 + 0.1 = 0.1 min;
    f = 0.2: -1.5 + 10.5 - 15 + 12.5 = 6.5 min; up to 0.15 for ever.
    """
    assert holding_time_min([0.5, 1.0, 0.2]) == pytest.approx([1.1, 0.1, 6.5])
    assert np.isinf(holding_time_min([0.15, 0.0])).all()


def test_rohmerts_rest_by_hand():
    """Half a strength for 0.55 of its 1.1 min: 18 x 0.5^1.4 x 0.35^0.5 = 18 x 0.378929 x 0.591608 = 4.0352."""
    assert rohmert_rest_share(0.55, 0.5) == pytest.approx(4.0352, abs=1e-4)
    assert rohmert_rest_share(60.0, 0.15) == 0.0
    assert rohmert_rest_share(99.0, 0.5) == pytest.approx(rohmert_rest_share(1.1, 0.5))


def test_murrells_rest_by_hand():
    """6 kcal/min against a standard of 4: 60 min x (6 - 4) / (6 - 1.5) = 26.7 min of an hour."""
    assert 60 * murrell_rest_share(6.0, 4.0) == pytest.approx(26.667, abs=1e-3)
    assert murrell_rest_share(6.0) == pytest.approx(1 / 4.5)
    assert murrell_rest_share(5.0) == 0.0 and murrell_rest_share(1.0) == 0.0


def test_prices_rest_by_hand():
    """7 kcal/min = 488.5 W: (488.46 - 300) / 195 = 0.96646 of the time worked, 49 % of all."""
    assert price_relaxation(7.0) == pytest.approx((7 * 69.78 - 300) / 195)
    assert of_whole(price_relaxation(7.0)) == pytest.approx(0.4915, abs=1e-4)
    assert price_relaxation(4.2) == 0.0


@given(st.floats(0, 1), st.floats(0, 1), st.floats(0, 30), st.floats(0, 30))
def test_more_force_and_longer_holds_never_ask_for_less_rest(one, other, brief, long):
    (weak, strong), (brief, long) = sorted((one, other)), sorted((brief, long))
    assert holding_time_min(strong) <= holding_time_min(weak)
    assert rohmert_rest_share(brief, weak) <= rohmert_rest_share(long, strong) + 1e-12


@given(st.floats(0, 20), st.floats(0, 20))
def test_more_energy_never_asks_for_less_rest(one, other):
    low, high = sorted((one, other))
    assert 0 <= murrell_rest_share(low) <= murrell_rest_share(high) < 1
    assert 0 <= of_whole(price_relaxation(low)) <= of_whole(price_relaxation(high)) < 1
