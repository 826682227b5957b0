"""Curves of learning: compiled, each is what Python makes of it, to the last bit.

Where a stream is looked for is the same place for Python, which makes the table, as for compiled code.
"""

from random import Random
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made.machine import Floor, Given, entered
from opsim.engine.fast_engine.human_effects import model_of
from opsim.engine.fast_engine.human_state import Model

from opsim.engine.fast_engine.human_models import CURVES, multiplier_of, work_of
from opsim.engine.fast_engine.machine import Arena, cast, inlined
from opsim.engine.fast_engine.random_numbers import place_of
from opsim.subjects.human.catalogue import entry, models_of

_as_model = cast(Model)


@entered
def _numbers(floor: Floor, given: Given) -> None:
    """Multiplier and work of so many repetitions."""
    model, n = _as_model(given.any), given.floats[0]
    given.floats[0], given.floats[1] = multiplier_of(model, n), work_of(model, n)


def numbers(model, n):
    found = np.array([n, 0.0])
    _numbers(0, any=model, floats=found)
    return tuple(found)


def drawn(model, luck):
    """A curve whose parameters are anywhere in their bounds; now and then of nobody who learns."""
    found = entry("learning", model)
    values = {}
    for one in found.parameters:
        low = max(one.at_least, one.above + 1e-6 if one.above > -1 else one.at_least)
        values[one.name] = one.neutral if luck.random() < 0.1 and one.neutral is not None else luck.uniform(
            max(low, 0.0), min(one.at_most, 40.0)
        )  # fmt: skip
    return found.cls(**values)


@pytest.mark.parametrize("model", models_of("learning"))
def test_every_curve_is_compiled_as_it_is_written(model):
    luck, arena = Random(model), Arena()
    for _ in range(60):
        curve = drawn(model, luck)
        made = model_of(SimpleNamespace(arena=arena), curve)
        made.kind = CURVES.index(type(curve))
        for n in (1.0, 2.0, float(luck.randrange(1, 5000)), luck.uniform(1, 300), luck.uniform(1, 1e5)):
            assert numbers(made, n) == (curve.multiplier(n), curve.work(n)), (curve, n)


def test_there_is_a_number_for_every_curve():
    assert set(CURVES) == {entry("learning", model).cls for model in models_of("learning")}


_place_of = inlined(place_of)


@entered
def compiled(floor: Floor, given: Given) -> int:
    return _place_of(given.n, given.m)


@given(st.integers(1, 2**63 - 1), st.integers(1, 20))
def test_python_and_compiled_code_look_at_one_place(stream, bits):
    mask = (1 << bits) - 1
    assert compiled(0, n=stream, m=mask) == place_of(stream, mask) <= mask
