"""What holds of every model of learning."""

import math
from functools import partial
from math import exp, inf, log

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.learning import TWINS
from scipy.integrate import solve_ivp

from opsim.subjects.human.catalogue import entry, models_of
from opsim.subjects.human.fatigue import Lffrm, RestByNeed
from opsim.subjects.human.forgetting import LearnForgetCurve, Memory
from opsim.subjects.human.learning import Wright

MODELS = models_of("learning")
RATES, SHARES, COUNTS = st.floats(0.51, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1e4)
DRAWN = {"rate": RATES, "cognitive_rate": RATES, "motor_rate": RATES, "floor": SHARES, "incompressible": SHARES}
DRAWN |= {"cognitive_share": SHARES, "prior": COUNTS, "half_at": COUNTS}
REPETITIONS = st.floats(1.0, 1e6)


@st.composite
def models(draw, name):
    cls = entry("learning", name).cls
    values = {one.name: draw(DRAWN[one.name]) for one in entry("learning", name).parameters if one.name in DRAWN}
    return cls(**values, measured_at=draw(st.floats(1.0, 1e4))), partial(TWINS[name], **values)


def close(a, b):
    return math.isclose(a, b, rel_tol=1e-9)


def test_every_model_has_a_twin():
    assert set(MODELS) == set(TWINS)


@pytest.mark.parametrize("name", MODELS)
@given(data=st.data(), n=REPETITIONS)
@settings(max_examples=60)
def test_a_model_is_its_naive_twin(name, data, n):
    model, twin = data.draw(models(name))
    assert close(model.shape(n), twin(n))
    assert close(model.multiplier(n), twin(n) / twin(model.measured_at))


@pytest.mark.parametrize("name", MODELS)
@given(data=st.data(), n=REPETITIONS, more=st.floats(1.0, 100.0))
@settings(max_examples=40)
def test_practice_never_makes_slower(name, data, n, more):
    model, _ = data.draw(models(name))
    assert model.shape(n * more) <= model.shape(n) * (1 + 1e-12)


@pytest.mark.parametrize("name", MODELS)
@given(n=REPETITIONS, measured_at=st.floats(1.0, 1e4))
@settings(max_examples=40)
def test_neutral_values_give_exactly_one_through_the_same_code(name, n, measured_at):
    found = entry("learning", name)
    neutral = {one.name: one.neutral for one in found.parameters if one.neutral is not None}
    assert found.cls(**neutral, measured_at=measured_at).multiplier(n) == 1.0


@pytest.mark.parametrize("name", MODELS)
def test_work_is_the_integral_of_the_times(name):
    """By Simpson's rule on each doubling of the repetitions; the hyperbola's is from a half to a half more."""
    model = entry("learning", name).cls()
    shift = 0.5 if name == "hyperbolic" else 0.0
    times, cells = model.shape, 400
    low, high = 8.0, 64.0
    width = (high - low) / cells
    at = [low + shift + width * i for i in range(cells + 1)]
    weights = [1, *[4, 2] * (cells // 2 - 1), 4, 1]
    by_hand = width / 3 * sum(weight * times(x) for weight, x in zip(weights, at))
    assert model.work(high) - model.work(low) == pytest.approx(by_hand, rel=1e-6)


@pytest.mark.parametrize("name", MODELS)
def test_nothing_takes_nothing(name):
    assert entry("learning", name).cls().work(0.0) == pytest.approx(0.0, abs=1e-12)


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


HALF = Wright(0.5**0.5)


def memory(forgetting, experience=()):
    return Memory(HALF, forgetting, experience, lambda _task: 1.0)


def test_repetitions_that_came_to_something_are_counted_from_those_behind_him():
    """His 201st; then, as the next is broken off in the instant in which it begins, the 202nd is another one."""
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (0.0, 200.0))
    assert mine.begins(1, 0, 0.0) == 201.0
    mine.works(0.0, 1, 0, 5.0)
    assert mine.begins(1, 1, 5.0) == 202.0
    mine.works(5.0, 1, 1, 10.0)
    mine.stops(5.0)
    assert [mine.begins(1, 2, 5.0), mine.begins(0, 0, 9.0)] == [202.0, 1.0]


def test_to_go_on_with_what_was_begun_is_no_repetition_more():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0))
    assert mine.begins(0, 0, 0.0) == 1.0
    mine.works(0.0, 0, 0, 5.0)
    mine.stops(2.0)
    assert mine.begins(0, 1, 2.0) == 2.0  # it comes to nothing
    mine.works(3.0, 0, 0, 6.0)
    assert mine.begins(0, 2, 6.0) == 2.0


def test_a_pause_takes_what_the_model_says_by_hand():
    """100 behind him, a pause of 180: 10 are left (tests of forgetting), so the next is the eleventh."""
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    assert mine.begins(0, 0, 0.0) == 100.0
    mine.works(0.0, 0, 0, 5.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_a_pause_begins_where_he_was_broken_off():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 500.0)
    mine.stops(5.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_work_at_another_task_does_not_shorten_the_pause():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0, 0.0))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 5.0)
    mine.begins(1, 0, 5.0)
    mine.works(5.0, 1, 0, 180.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_a_short_pause_costs_nothing():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 5.0)
    assert mine.begins(0, 1, 64.0) == 101.0
