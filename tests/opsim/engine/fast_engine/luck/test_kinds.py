"""Streams that are drawn together against each alone, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams.blocks import (
    NoLuck,
    OfAKind,
    drawn_ranks,
    durations,
    exponentials,
    numpys_generators,
    of_model,
    uniforms,
)
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.streams import BLOCK, _key
from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, Recorded, Uniform
from opsim.tasks.switched import switched
from tests.opsim.tasks.models import MODELS, SHARED

SECONDS = st.floats(0.01, 1e5)
EFFECTS = st.none() | st.floats(-3.0, 3.0)
FAMILIES = {
    "exponential": st.builds(Exponential, SECONDS),
    "uniform": st.builds(Uniform, st.floats(0, 5), st.floats(5, 1e4)),
    "lognormal": st.builds(Lognormal, SECONDS, st.floats(0, 3), st.floats(0, 1)),
}
WORDS = np.frombuffer(_key(5, 1, ("duration", "lift", "ana")), np.uint32)


def together(alike, sizes):
    """What streams of one kind give in one call, each its own blocks."""
    states = [ManyBlocks(WORDS, 3 * i, n).states for i, n in enumerate(sizes)]
    numbers = [np.repeat(column, np.array(sizes) * BLOCK) for column in zip(*(one.numbers for one in alike))]
    return alike[0].draw(sum(sizes) * BLOCK, ManyBlocks.in_states(np.concatenate(states)), *numbers)


def alone(alike, sizes):
    return np.concatenate([one(WORDS, 3 * i, n) for i, (one, n) in enumerate(zip(alike, sizes))])


@pytest.mark.parametrize("family", FAMILIES)
@settings(max_examples=40)
@given(st.data())
def test_streams_of_a_family_together_are_each_alone(family, data):
    models = data.draw(st.lists(FAMILIES[family], min_size=1, max_size=6))
    alike = [of_model(model, data.draw(EFFECTS)) for model in models]
    sizes = [data.draw(st.integers(1, 3)) for _ in alike]
    assert len({one.kind for one in alike}) == 1
    assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


@pytest.mark.parametrize("model", [model for model in SHARED if not isinstance(model, Lognormal)], ids=repr)
@settings(max_examples=15)
@given(st.lists(st.tuples(st.floats(-3.0, 3.0), st.integers(1, 3)), min_size=1, max_size=5))
def test_workers_who_differ_in_a_model_together_are_each_alone(model, drawn):
    alike, sizes = [of_model(model, effect) for effect, _ in drawn], [n for _, n in drawn]
    assert len({one.kind for one in alike}) == 1
    assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_stations_of_a_model_together_are_each_alone_and_as_numpy_draws_them(model):
    alike, sizes = [of_model(model, None)] * 3, [2, 1, 3]
    numpys = [rng for i, n in enumerate(sizes) for rng in numpys_generators(WORDS, 3 * i, n)]
    wanted = np.concatenate([model.sample(BLOCK, rng).duration_s for rng in numpys]).astype(float)
    assert alone(alike, sizes).tobytes() == wanted.tobytes()
    if isinstance(alike[0], OfAKind):
        assert together(alike, sizes).astype(float).tobytes() == wanted.tobytes()


def test_gaps_of_many_sources_and_chances_together_are_each_alone():
    sizes = [1, 3, 2]
    for alike in (
        [exponentials(mean_s) for mean_s in (2.0, 7.5, 0.1)],
        [uniforms] * 3,
        [drawn_ranks((4, 9), (0.3,))] * 3,
    ):
        assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


def test_what_is_not_drawn_alike_is_not_of_a_kind():
    one, other = Gamma(20.0, 0.3, 0.5), Gamma(20.0, 0.4, 0.5)
    kinds = [of_model(one, 0.1), of_model(other, 0.1), of_model(one, None), of_model(Lognormal(20.0, 0.3), None)]
    kinds += [of_model(Exponential(20.0), None), exponentials(20.0), uniforms]
    kinds += [drawn_ranks(*said) for said in (((1, 2), (0.5,)), ((1, 2), (0.25,)), ((1, 3), (0.5,)))]
    kinds += [of_model(switched(one, "within_only"), effect) for effect in (None, object())]
    assert len({kind.kind for kind in kinds}) == len(kinds)


def test_fixed_times_and_traces_ask_no_luck():
    trace = Recorded(tuple(np.linspace(1.0, 9.0, 37)), by_index=True)
    assert all(isinstance(durations(model, None), NoLuck) for model in (Fixed(3.0), trace))
