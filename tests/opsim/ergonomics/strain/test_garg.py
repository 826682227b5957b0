"""Metabolic energy by Garg, Chaffin & Herrin."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain import energy as garg


@pytest.mark.parametrize(
    ("found", "by_hand"),
    [
        # man of 70 kg, 10 kg from 0.31 m to 0.81 m
        (garg.stoop_lift_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (11.375 + 10.85)),  # .325x70x.5; (1.41+.76)x10x.5
        (garg.squat_lift_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (17.99 + 14.05)),  # .514x70x.5; (2.19+.62)x10x.5
        (garg.stoop_lower_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (9.38 + 3.375 + 2.61)),  # .268x70x.5; .675x5; 5.22x.5
        (garg.squat_lower_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (17.885 + 3.505)),  # .511x70x.5; .701x5
        # woman of 60 kg, 5 kg from 0.81 m to 1.31 m
        (garg.arm_lift_kcal(60, 5, 0.81, 1.31, 0), 0.01 * (1.86 + 7.975)),  # .062x60x.5; 3.19x5x.5
        (garg.arm_lower_kcal(60, 5, 0.81, 1.31, 0), 0.01 * (2.79 + 2.55)),  # .093x60x.5; 1.02x5x.5
        (garg.posture_kcal_per_min("standing", 70), 1.68),
        (garg.posture_kcal_per_min("bent", 70), 1.96),
        (garg.posture_kcal_per_min("sitting", 70), 1.61),
        (garg.walking_kcal_per_min(70, 1.0), 0.01 * (51 + 177.8)),
        (garg.walking_kcal_per_min(70, 1.0, 10), 0.01 * (68 + 177.8 + 40.8 + 114)),
        (garg.holding_kcal_per_min(10), 0.62),
    ],
)
def test_equations_by_hand(found, by_hand):
    assert found == pytest.approx(by_hand)


def test_a_lift_past_the_bench_is_cut_there():
    """60 kg woman, 5 kg from 0.31 to 1.31 m: with the back to 0.81, with the arms from there."""
    back, arms = garg.stoop_lift_kcal(60, 5, 0.31, 0.81, 0), garg.arm_lift_kcal(60, 5, 0.81, 1.31, 0)
    assert garg.moved_kcal(60, 5, 0.31, 1.31, 0) == pytest.approx(back + arms)
    down = garg.squat_lower_kcal(60, 5, 0.31, 0.81, 0) + garg.arm_lower_kcal(60, 5, 0.81, 1.31, 0)
    assert garg.moved_kcal(60, 5, 1.31, 0.31, 0, squat=True) == pytest.approx(down)


def test_what_stays_at_its_height_costs_nothing_to_move():
    assert garg.moved_kcal(70, 10, 0.5, 0.5, 1) == 0.0


heights, sexes = st.floats(0.05, 1.9), st.sampled_from([0.0, 0.5, 1.0])


@given(heights, heights, st.floats(0, 30), st.floats(0, 10), st.floats(40, 120), sexes, st.booleans())
def test_heavier_loads_and_bodies_never_cost_less(one, other, load, more, body, sex, squat):
    kcal = garg.moved_kcal(body, load, one, other, sex, squat)
    assert kcal >= 0
    assert garg.moved_kcal(body, load + more, one, other, sex, squat) >= kcal
    assert garg.moved_kcal(body + more, load, one, other, sex, squat) >= kcal


@given(st.floats(0.1, 0.8), st.floats(0, 0.6), st.floats(0, 30), sexes, st.booleans())
def test_going_deeper_never_costs_less(high, deeper, load, sex, squat):
    low = max(high - deeper, 0.05)
    for begin, end in ((low, 0.81), (0.81, low)):
        higher = (high, 0.81) if begin == low else (0.81, high)
        assert (
            garg.moved_kcal(70, load, begin, end, sex, squat) >= garg.moved_kcal(70, load, *higher, sex, squat) - 1e-12
        )


def test_many_at_once_are_each_alone():
    rng = np.random.default_rng(0)
    begin, end, load, squat = (
        rng.uniform(0, 1.8, 40),
        rng.uniform(0, 1.8, 40),
        rng.uniform(0, 20, 40),
        rng.random(40) < 0.5,
    )
    found = garg.moved_kcal(70.0, load, begin, end, 0.5, squat)
    alone = [float(garg.moved_kcal(70.0, *one[:1], *one[1:3], 0.5, one[3])) for one in zip(load, begin, end, squat)]
    assert found == pytest.approx(alone)
