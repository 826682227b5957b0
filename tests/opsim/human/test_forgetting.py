import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from naive_learning import exponent, remembered

from opsim.human.forgetting import LearnForgetCurve
from opsim.human.learning import Wright

ALWAYS = {"least_pause_s": 0.0}


def test_a_tenth_root_of_the_way_by_hand():
    """b = 0.5, T_1 = 1: t(100) = 20. D = 1980: f = 0.25 ln 100 / ln 100 = 0.25. d = 180: S = 100 (1 + 9)^2 = 10,000.

    alpha = 100^(1 + 0.5) * 10,000^-0.5 = 1000 / 100 = 10.
    """
    learned = Wright(0.5**0.5)
    model = LearnForgetCurve(forgotten_in_s=1980.0, **ALWAYS)
    assert model.remembered(100.0, 180.0, 1.0 * learned.work(100.0)) == pytest.approx(10.0)


@given(
    rate=st.floats(0.55, 0.99),
    q=st.floats(1.0, 1e5),
    first=st.floats(1.0, 1e4),
    times=st.floats(1.0, 1e5),
    share=st.floats(0.01, 0.999),
)
def test_what_is_remembered_is_the_papers_own_formula(rate, q, first, times, share):
    worked = first * Wright(rate).work(q)
    total = times * worked
    found = LearnForgetCurve(forgotten_in_s=total, **ALWAYS).remembered(q, share * total, worked)
    assert math.isclose(found, remembered(q, share * total, total, first, exponent(rate)), rel_tol=1e-9)


@given(q=st.floats(0.0, 1e6), pause=st.floats(0.0, 1e9), worked=st.floats(1e-3, 1e9))
def test_never_forgotten_is_remembered_to_the_bit(q, pause, worked):
    assert LearnForgetCurve(forgotten_in_s=math.inf, **ALWAYS).remembered(q, pause, worked) == q


@given(q=st.floats(0.0, 1e6), pause=st.floats(0.0, 1e7), more=st.floats(1.0, 10.0), worked=st.floats(1e-3, 1e9))
def test_a_longer_pause_leaves_no_more(q, pause, more, worked):
    model = LearnForgetCurve(forgotten_in_s=1e7, **ALWAYS)
    kept = model.remembered(q, pause, worked)
    assert 0 <= model.remembered(q, pause * more, worked) <= kept * (1 + 1e-12) <= q * (1 + 1e-9)


def test_at_the_end_one_repetition_is_left_and_then_none():
    model = LearnForgetCurve(forgotten_in_s=1000.0, **ALWAYS)
    assert model.remembered(50.0, 1000.0 * (1 - 1e-12), 10.0) == pytest.approx(1.0)
    assert model.remembered(50.0, 1000.0, 10.0) == 0.0


def test_a_night_is_no_interruption_where_the_least_pause_is_a_day():
    model = LearnForgetCurve(forgotten_in_s=1e7)
    assert model.remembered(50.0, 57_600.0, 100.0) == 50.0
    assert model.remembered(50.0, 86_400.0, 100.0) < 50.0
