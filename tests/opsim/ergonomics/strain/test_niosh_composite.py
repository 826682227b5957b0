"""The composite lifting index."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.niosh import CM, US, Lift, composite, composite_index, lifting_index


def test_a_composite_by_hand():
    """Three lifts over 8 h, hands at knuckle height (all of VM, DM, AM, CM 1):

    a: 10 kg at H 25 (FIRWL 23.0: FILI 0.43478), 1/min: FM 0.75, STLI 0.57971
    b: 15 kg at H 50 (FIRWL 11.5: FILI 1.30435), 1/min: FM 0.75, STLI 1.73913
    c: 10 kg at H 50 (FIRWL 11.5: FILI 0.86957), 2/min: FM 0.65, STLI 1.33779
    order b, c, a; FM(1) 0.75, FM(1 + 2) 0.55, FM(1 + 2 + 1) 0.45
    CLI = 1.73913 + 0.86957 (1/0.55 - 1/0.75) + 0.43478 (1/0.45 - 1/0.55)
        = 1.73913 + 0.86957 x 0.484848 + 0.43478 x 0.404040 = 1.73913 + 0.42161 + 0.17567 = 2.33641
    """
    a = Lift(10.0, 25.0, 75.0, 25.0, per_min=1.0, hours=8)
    b, c = replace(a, load=15.0, horizontal=50.0), replace(a, horizontal=50.0, per_min=2.0)
    found = composite([a, b, c])
    assert found.order == (1, 2, 0)
    assert found.fili == pytest.approx((0.43478, 1.30435, 0.86957), abs=5e-6)
    assert found.stli == pytest.approx((0.57971, 1.73913, 1.33779), abs=5e-6)
    assert found.index == pytest.approx(2.33641, abs=5e-6)


def test_the_multi_task_example_of_the_manual():
    """Its three tasks have FIRWL 20, 20, 15 lb, loads 30, 20, 10 lb (FILI 1.5, 1.0, 0.67), 1, 2 and 4 lifts a minute
    for up to an hour; FM 0.94 at 1, 0.88 at 1 + 2 and 0.70 at 1 + 2 + 4 a minute. CLI = 1.60 + .07 + .20, about 1.9.
    Source: DHHS (NIOSH) 94-110, section 2.4, its numbers from memory and to be checked; FM are those of its table 5.
    """
    found = composite_index([30 / 20, 20 / 20, 10 / 15], [1.0, 2.0, 4.0], [40.0] * 3, 1, US)
    by_hand = 1.5 / 0.94 + 1.0 * (1 / 0.88 - 1 / 0.94) + 10 / 15 * (1 / 0.70 - 1 / 0.88)
    assert found == pytest.approx(by_hand)
    assert found == pytest.approx(1.60 + 0.07 + 0.20, abs=0.01)


def test_a_composite_of_one_lift_is_that_lift_and_of_none_is_nothing():
    lift = Lift(12.0, 50.0, 30.0, 90.0, 45.0, 3.0, 2, "fair")
    assert composite([lift]).index == pytest.approx(lifting_index(lift))
    assert composite([]).index == 0.0


def test_too_many_lifts_together_have_no_bound():
    lift = Lift(5.0, 30.0, 75.0, 25.0, per_min=8.0, hours=8)
    assert composite([lift, lift]).index == math.inf


lifts = st.builds(
    Lift,
    st.floats(1, 30),
    st.floats(10, 63),
    st.floats(0, 175),
    st.floats(0, 175),
    st.floats(0, 135),
    st.floats(0, 15),
    st.sampled_from((1, 2, 8)),
    st.sampled_from(list(CM)),
)


@given(st.lists(lifts, min_size=1, max_size=4))
def test_a_job_is_at_least_its_worst_lift(job):
    job = [replace(lift, hours=8, per_min=lift.per_min / 5) for lift in job]
    found = composite(job).index
    assert found >= max(map(lifting_index, job)) * (1 - 1e-12)
