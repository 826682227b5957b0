"""Learning: how long the n-th repetition of a task takes, as a share of the time that was recorded.

``shape(n)`` is the time of the n-th repetition over that of the first, n >= 1 and not only whole; ``multiplier(n)`` is
over that of the repetition ``measured_at``, which the recorded time stands for; ``work(n)`` is what n repetitions take
without a pause, in times of the first: the integral of ``shape`` that the learn-forget curve model asks for.
"""

from __future__ import annotations

from math import log, log2
from typing import Protocol

from opsim.human.parameter import Checked, parameter


class Learning(Protocol):
    """What the engine asks of a model of learning."""

    def shape(self, n: float) -> float: ...
    def multiplier(self, n: float) -> float: ...
    def work(self, n: float) -> float: ...


class Curve(Checked):
    """What all curves share: the repetition that the recorded time stands for."""

    __slots__ = ()
    measured_at: float

    def shape(self, n: float) -> float:
        raise NotImplementedError

    def multiplier(self, n: float) -> float:
        """Time of the n-th repetition over the recorded one; exactly 1.0 where nobody learns."""
        return self.shape(n) / self.shape(self.measured_at)


def slope(rate: float) -> float:
    """The exponent b of a curve on which time falls to ``rate`` with each doubling: 0.8 -> 0.3219."""
    return -log2(rate)


def power_work(n: float, b: float) -> float:
    """The integral of x^-b from 0 to n, b below 1."""
    return n ** (1.0 - b) / (1.0 - b)


def hyperbola_work(n: float, before: float) -> float:
    """The integral of 1 / (x + before) over n repetitions, each from half before it to half after it."""
    return log((n + 0.5 + before) / (0.5 + before))


def rate_parameter(default: float, what: str = "time at each doubling of the repetitions, as a share of before"):
    """A learning rate: 0.8 means a fifth less time at each doubling."""
    return parameter(default, what, unit="share", neutral=1.0, above=0.5, at_most=1.0)


def measured_at_parameter():
    """The repetition that the recorded time stands for."""
    return parameter(
        1.0, "the repetition that the time in the scenario stands for", unit="times", at_least=1.0, at_most=1e6
    )
