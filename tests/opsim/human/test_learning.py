"""What holds of every model of learning."""

import math
from functools import partial

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive_learning import TWINS

from opsim.human.catalogue import entry, models_of

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
