"""Models of human effects where compiled code finds them: their parameters, and methods they call of themselves."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from numba.extending import overload_method

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.machine.layouts import LAYOUTS
from opsim.engine.fast_engine.machine.structs import Pointer
from opsim.engine.fast_engine.parts.curves import CURVES
from opsim.human.catalogue import catalogue
from opsim.human.lffrm import Lffrm
from opsim.plan.human import EFFECTS

_rested: Any = inlined(Lffrm.rested)


@overload_method(Pointer, "rested")
def _rested_of_a_model(self, state, seconds):
    """What ``Lffrm.passed`` calls of itself."""
    return (lambda self, state, seconds: _rested(self, state, seconds)) if self.of == "Model" else None


def refuse_strangers(plan: Any) -> None:
    """NotImplementedError names models of which no formula is compiled here."""
    known = {one.cls for one in catalogue()}
    classes = [type(model) for model in (getattr(plan, effect) for effect in EFFECTS) if model is not None]
    names = [f"the human effect {cls.__module__}.{cls.__qualname__}" for cls in classes if cls not in known]
    if names:
        raise NotImplementedError(", ".join(names))


def model_of(build: Any, model: Any) -> Any:
    """Its parameters where compiled methods find them."""
    made = build.arena.new("Model")
    made.kind = CURVES.index(type(model)) if type(model) in CURVES else 0
    for one in fields(model):
        if one.name in LAYOUTS["Model"].fields:
            setattr(made, one.name, getattr(model, one.name))
    return made
