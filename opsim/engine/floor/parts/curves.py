"""Curves of learning: those of ``opsim.human``, or anybody's."""

from typing import Any


def multiplier_of(model: Any, n: float) -> Any:
    """How long the n-th repetition takes, in times of the first."""
    return model.multiplier(n)


def work_of(model: Any, n: float) -> Any:
    """What n repetitions take, in times of the first."""
    return model.work(n)
