"""Curves of learning: compiled, each is what Python makes of it, to the last bit."""

from random import Random
from types import SimpleNamespace

import numba
import pytest
from opsim.engine.fast_engine.human_effects import model_of
from opsim.engine.fast_engine.human_state import Model

from opsim.engine.fast_engine.human_models import CURVES, multiplier_of, work_of
from opsim.engine.fast_engine.machine import Arena, cast
from opsim.human.catalogue import entry, models_of

_as_model = cast(Model)


@numba.njit
def _multiplier(address, n):
    return multiplier_of(_as_model(address), n)


@numba.njit
def _work(address, n):
    return work_of(_as_model(address), n)


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
            assert _multiplier(made.address, n) == curve.multiplier(n), (curve, n)
            assert _work(made.address, n) == curve.work(n), (curve, n)


def test_there_is_a_number_for_every_curve():
    assert set(CURVES) == {entry("learning", model).cls for model in models_of("learning")}
