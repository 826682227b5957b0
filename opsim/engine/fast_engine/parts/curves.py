"""Curves of learning: the methods of ``opsim.human``, compiled as they are written."""

from __future__ import annotations

from typing import Any

from numba.extending import overload_method, register_jitable

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.machine.structs import Pointer
from opsim.engine.fast_engine.parts.humans import Model
from opsim.human import learning
from opsim.human.learning import Curve
from opsim.human.other_curves import DualPhase, Hyperbolic
from opsim.human.power_curves import DeJong, Plateau, StanfordB, Wright

CURVES: tuple[Any, ...] = (Wright, Plateau, DeJong, StanfordB, Hyperbolic, DualPhase)
"""By their numbers, ``model.kind``."""
for _helper in (learning.slope, learning.power_work, learning.hyperbola_work):
    register_jitable(_helper)
_shapes: Any = [inlined(curve.shape) for curve in CURVES]
_works: Any = [inlined(curve.work) for curve in CURVES]
_wright, _plateau, _de_jong, _stanford_b, _hyperbolic, _dual_phase = _shapes
_wright_work, _plateau_work, _de_jong_work, _stanford_b_work, _hyperbolic_work, _dual_phase_work = _works
multiplier_of: Any = inlined(Curve.multiplier)


@overload_method(Pointer, "shape")
def _shape_of_a_model(self, n):
    """What ``Curve.multiplier`` calls of itself."""
    return (lambda self, n: _shape(self, n)) if self.of == "Model" else None


@inlined
def _shape(self: Model, n: float) -> float:
    if self.kind == 0:
        return _wright(self, n)
    if self.kind == 1:
        return _plateau(self, n)
    if self.kind == 2:
        return _de_jong(self, n)
    if self.kind == 3:
        return _stanford_b(self, n)
    if self.kind == 4:
        return _hyperbolic(self, n)
    return _dual_phase(self, n)


@inlined
def work_of(model: Model, n: float) -> float:
    """What n repetitions take, in times of the first."""
    if model.kind == 0:
        return _wright_work(model, n)
    if model.kind == 1:
        return _plateau_work(model, n)
    if model.kind == 2:
        return _de_jong_work(model, n)
    if model.kind == 3:
        return _stanford_b_work(model, n)
    if model.kind == 4:
        return _hyperbolic_work(model, n)
    return _dual_phase_work(model, n)
