"""How many blocks of a task model are drawn: in one call where every number is made of those of its own place alone,
else block by block."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from opsim.engine.fast_engine.luck.kinds import Drawn, HeldAtShares, NoLuck, of_model
from opsim.engine.fast_engine.luck.trust import blocks_of, is_trusted, numpys_generators
from opsim.plan.tools import HoldPlan, Moment
from opsim.streams import BLOCK

Held = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Seconds of each performance, and the shares of it from which to which a tool is held."""
DrawnHeld = Callable[[np.ndarray, int, int], Held]


def durations(model: Any, effect: Any) -> Drawn:
    """How blocks of durations are drawn from a task model, for a worker of this effect."""
    at = getattr(model, "at", None) if getattr(model, "by_index", False) else None
    if at is not None:
        return _trace(_seconds(model.times_s)) if type(model) in _singly() else _by_index(at)
    if in_one_call(model):
        return of_model(model, effect)
    return lambda words, first, n: np.concatenate(
        [_seconds(drawn.duration_s) for drawn in _each(model, effect, words, first, n)]
    )


def held(hold: HoldPlan, model: Any, effect: Any) -> DrawnHeld:
    """How blocks of durations with two moments of each are drawn: from the same numbers."""
    if getattr(model, "by_index", False) or in_one_call(model):
        return _held_at_shares(hold, durations(model, effect), by_index=getattr(model, "by_index", False))

    def draw(words: np.ndarray, first: int, n: int) -> Held:
        columns = zip(*(_of_block(drawn, hold) for drawn in _each(model, effect, words, first, n)))
        duration_s, start, end = (np.concatenate(column) for column in columns)
        return duration_s, start, end

    return draw


def in_one_call(model: Any) -> bool:
    """Whether a model's ``sample`` treats each number alone, so that blocks can be drawn together.

    NOTE: exact types only: a child may do anything. A switch is looked through: what it adds is a product.
    """
    return type(_within(model)) in _singly() and is_trusted()


def is_ours(model: Any) -> bool:
    """Whether a model is of this package: it draws from its generator and nothing else, and changes no effect."""
    return type(_within(model)).__module__.startswith(("opsim.tasks.", "emulator."))


def _within(model: Any) -> Any:
    """The model inside a switch of variability."""
    return model.__dict__["_model"] if type(model) in _switches() else model


def _trace(times_s: np.ndarray) -> Drawn:
    """As ``opsim.tasks.Recorded.at``, of an array that is made once."""
    return NoLuck(lambda _words, first, n: times_s[np.arange(first * BLOCK, (first + n) * BLOCK) % len(times_s)])


def _by_index(at: Callable[[np.ndarray], Any]) -> Drawn:
    """A model's own trace, asked block by block."""
    return lambda _words, first, n: np.concatenate([_seconds(at(_items(block))) for block in range(first, first + n)])


def _held_at_shares(hold: HoldPlan, drawn: Drawn, *, by_index: bool) -> DrawnHeld:
    """A time without a body has no marks: both moments are shares."""
    start, end = hold.start.share, hold.end.share
    return HeldAtShares(drawn, start, end if by_index else max(start, end))


def _of_block(drawn: Any, hold: HoldPlan) -> Held:
    start = _shares(drawn, hold.start)
    return _seconds(drawn.duration_s), start, np.maximum(start, _shares(drawn, hold.end))


def _shares(drawn: Any, moment: Moment) -> np.ndarray:
    """(BLOCK,) where a moment lies in each performance, as a share of its duration."""
    if moment.mark < 0:
        return np.full(BLOCK, moment.share)
    return np.clip(np.asarray(drawn.mark_s)[:, moment.mark] / drawn.duration_s, 0.0, 1.0)


def _each(model: Any, effect: Any, words: np.ndarray, first: int, n: int) -> list[Any]:
    """The performances of each block. A plug-in is given what it is given elsewhere, with all that hangs on it."""
    generators = blocks_of(words, first, n).generators if is_ours(model) else numpys_generators(words, first, n)
    return [model.sample(BLOCK, rng, worker=effect) for rng in generators]


def _items(block: int) -> np.ndarray:
    return np.arange(block * BLOCK, (block + 1) * BLOCK)


def _seconds(duration_s: Any) -> np.ndarray:
    return np.asarray(duration_s, dtype=float)


@cache
def _singly() -> frozenset[type]:
    from opsim import tasks
    from opsim.tasks.counts import UniformCount

    simple = (tasks.Fixed, tasks.Exponential, tasks.Geometric, tasks.Erlang, tasks.Uniform, tasks.Triangular)
    shared = (tasks.Lognormal, tasks.Gamma, tasks.Weibull, tasks.Hyperexponential, tasks.Normal, tasks.Beta)
    return frozenset((*simple, *shared, tasks.Empirical, tasks.Recorded, UniformCount))


@cache
def _switches() -> frozenset[type]:
    from opsim.tasks.switched import BetweenOnly, NoSpread, Shuffled, WithinOnly

    return frozenset((WithinOnly, BetweenOnly, NoSpread, Shuffled))
