from math import exp, inf, log

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from opsim.human.fatigue import Lffrm, RestByNeed

levels = st.floats(0.0, 1.0)
seconds = st.floats(0.0, 1e5)


def naive(model, stretches):
    """F' = lambda (1 - F) at work, F' = -mu F at rest, integrated."""
    level = 0.0
    for works, stretch_s in stretches:
        rate = log(2) / (model.tires_half_in_s if works else model.recovers_half_in_s)
        flow = (lambda _t, f, rate=rate: rate * (1 - f)) if works else (lambda _t, f, rate=rate: -rate * f)
        level = solve_ivp(flow, (0, stretch_s), [level], method="DOP853", rtol=1e-12, atol=1e-14).y[0, -1]
    return level


def test_it_is_the_integrated_equations():
    model, stretches = Lffrm(), [(True, 7200.0), (False, 900.0), (True, 5000.0), (False, 60.0), (True, 10.0)]
    level = 0.0
    for works, stretch_s in stretches:
        level = model.passed(level, 1.0, 0.0, 1.0, stretch_s, 0.0) if works else model.rested(level, stretch_s)
    assert level == pytest.approx(naive(model, stretches), abs=1e-9)


def test_a_hand_worked_shift_of_work_rest_and_work():
    # half tired in 4 h: after 2 h 1 - 2^-0.5 = 0.292893; half rested in 20 min: after 10 min 0.292893 / 2^0.5 =
    # 0.207107; after 2 h more 1 - (1 - 0.207107) / 2^0.5 = 0.439340
    model = Lffrm(tires_half_in_s=14_400.0, recovers_half_in_s=1_200.0)
    level = model.passed(model.fresh(), 1.0, 0.0, 1.0, 7_200.0, 0.0)
    assert level == pytest.approx(0.292893, abs=1e-6)
    level = model.rested(level, 600.0)
    assert level == pytest.approx(0.207107, abs=1e-6)
    assert model.passed(level, 1.0, 0.0, 1.0, 7_200.0, 0.0) == pytest.approx(0.439340, abs=1e-6)


def test_fatigue_is_the_exponential_of_the_paper():
    assert Lffrm(tires_half_in_s=log(2) / 0.03).passed(0.0, 1.0, 0.0, 1.0, 24.0, 0.0) == pytest.approx(
        1 - exp(-0.03 * 24)
    )


@given(levels, seconds, seconds)
def test_more_work_is_never_less_fatigue_and_more_rest_never_more(level, first_s, more_s):
    model = Lffrm()
    assert model.passed(level, 1.0, 0, 1, first_s + more_s, 0.0) >= model.passed(level, 1.0, 0, 1, first_s, 0.0) - 1e-15
    assert model.rested(level, first_s + more_s) <= model.rested(level, first_s)


def test_a_heavier_task_tires_faster():
    model = Lffrm()
    assert model.passed(0.1, 2.0, 0, 1, 600.0, 0.0) == pytest.approx(model.passed(0.1, 1.0, 0, 1, 1200.0, 0.0))


def test_neutral_values_are_a_shift_of_exactly_nothing():
    assert Lffrm(slows=0.0).shift(0.7) == 0.0
    never = Lffrm(tires_half_in_s=inf)
    assert never.shift(never.passed(0.0, 1.0, 0, 1, 1e6, 0.0)) == 0.0
    assert Lffrm(slows=0.2).shift(1.0) == pytest.approx(np.log(1.2))


def test_a_rest_ends_where_it_was_said():
    model = Lffrm()
    assert model.rested(0.6, model.rest_to_s(0.6, 0.2)) == pytest.approx(0.2)
    assert model.rest_to_s(0.1, 0.2) == 0.0


def test_all_that_is_wrong_is_said():
    with pytest.raises(ValueError, match=r"tires_half_in_s.*slows"):
        Lffrm(tires_half_in_s=-1.0, slows=-0.1)
    with pytest.raises(ValueError, match="by: found 'load'"):
        Lffrm(by="load")
    with pytest.raises(ValueError, match=r"until: found 0\.5, expected less than above, 0\.3"):
        RestByNeed(above=0.3, until=0.5)


def test_who_is_fresher_than_a_level_needs_no_rest_also_who_is_not_tired_at_all():
    assert Lffrm().rest_to_s(0.0, 0.2) == Lffrm().rest_to_s(0.2, 0.2) == 0.0
    assert Lffrm(recovers_half_in_s=60.0).rest_to_s(0.4, 0.2) == pytest.approx(60.0)
