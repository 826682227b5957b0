"""Learning: how long the n-th repetition of a task takes, as a share of the time that was recorded.

``shape(n)`` is the time of the n-th repetition over that of the first, n >= 1 and not only whole; ``multiplier(n)`` is
over that of the repetition ``measured_at``, which the recorded time stands for; ``work(n)`` is what n repetitions take
without a pause, in times of the first: the integral of ``shape`` that the learn-forget curve model asks for.

Learning by a power of the repetitions: Wright, the plateau, De Jong, Stanford-B.

Learning otherwise than by one power: the hyperbola, and two phases.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, log2
from typing import ClassVar, Protocol

from opsim.subjects.human.catalogue import Checked, parameter


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


@dataclass(frozen=True, slots=True)
class Wright(Curve):
    """T_n = T_1 n^-b, b = -log2(rate).

    Source: Wright (1936), who wrote it for the mean of the first n; as the time of the n-th: Crawford (1944).
    The default of 0.8 is Wright's for airframes; Dutton & Thomas (1984) found 0.81 to 0.82 most often in 108 studies.
    """

    does: ClassVar[str] = "each doubling of the repetitions takes the time to the same share"
    source: ClassVar[str] = (
        "Wright, T. P. (1936). Factors affecting the cost of airplanes. J. Aeronaut. Sci. 3, 122-128"
    )
    rate: float = rate_parameter(0.8)
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        return n ** -slope(self.rate)

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        return power_work(n, slope(self.rate))


@dataclass(frozen=True, slots=True)
class Plateau(Curve):
    """T_n = T_1 max(n^-b, floor): learning stops where the plateau is reached.

    Source: Baloff (1966, 1971). The floor's default is an assumption.
    """

    does: ClassVar[str] = "as wright, until a floor that nobody gets below"
    source: ClassVar[str] = (
        "Baloff, N. (1971). Extension of the learning curve: some empirical results. Oper. Res. Q. 22, 329-340"
    )
    rate: float = rate_parameter(0.8)
    floor: float = parameter(0.5, "the least time, as a share of the first", unit="share", at_least=0.0, at_most=1.0)
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        return max(n ** -slope(self.rate), self.floor)

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        b = slope(self.rate)
        if n <= 1.0 or n**-b >= self.floor:
            return power_work(n, b)
        bend = self.floor ** (-1.0 / b)
        return power_work(bend, b) + self.floor * (n - bend)


@dataclass(frozen=True, slots=True)
class DeJong(Curve):
    """T_n = T_1 (M + (1 - M) n^-b), M the factor of incompressibility: the share that no practice shortens.

    Source: De Jong (1957), who gives M = 0.25 for assembly by hand and 0.5 where half of the cycle is a machine's.
    """

    does: ClassVar[str] = "as wright, but a share of the time that no practice shortens"
    source: ClassVar[str] = (
        "De Jong, J. R. (1957). The effects of increasing skill on cycle time and its consequences for time standards. "
        "Ergonomics 1, 51-60"
    )
    rate: float = rate_parameter(0.8)
    incompressible: float = parameter(
        0.25, "share of the first time that no practice shortens", unit="share", at_least=0.0, at_most=1.0
    )
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        return self.incompressible + (1.0 - self.incompressible) * n ** -slope(self.rate)

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        return self.incompressible * n + (1.0 - self.incompressible) * power_work(n, slope(self.rate))


@dataclass(frozen=True, slots=True)
class StanfordB(Curve):
    """T_n = T_1 ((n + B) / (1 + B))^-b: B repetitions were behind everybody before the first.

    Source: Asher (1956), ch. 4, of Stanford Research Institute (1949); B is between 0 and 10, and 4 is usual.
    """

    does: ClassVar[str] = "as wright, by people who bring repetitions of something alike with them"
    source: ClassVar[str] = (
        "Asher, H. (1956). Cost-quantity relationships in the airframe industry. RAND R-291, Santa Monica"
    )
    rate: float = rate_parameter(0.8)
    prior: float = parameter(4.0, "repetitions that everybody brings with him", unit="times", at_least=0.0)
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        return ((n + self.prior) / (1.0 + self.prior)) ** -slope(self.rate)

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        b, prior = slope(self.rate), self.prior
        return (power_work(n + prior, b) - power_work(prior, b)) * (1.0 + prior) ** b


@dataclass(frozen=True, slots=True)
class Hyperbolic(Curve):
    """Output k (n + p) / (n + p + r), hence T_n / T_1 = (1 + r / (n + p)) / (1 + r / (1 + p)).

    p : practice before the first repetition; r : repetitions (p included) until output is half of what it comes to.
    Source: Mazur & Hastie (1978), with x = n. The defaults are assumptions: the last time is 0.52 of the first.
    """

    does: ClassVar[str] = "output rises on a hyperbola to a limit"
    source: ClassVar[str] = (
        "Mazur, J. E. & Hastie, R. (1978). Learning as accumulation: a reexamination of the learning curve. "
        "Psychol. Bull. 85, 1256-1274"
    )
    prior: float = parameter(10.0, "practice before the first repetition (p)", unit="times", at_least=0.0)
    half_at: float = parameter(
        10.0, "practice at which output is half of its limit (r)", unit="times", neutral=0.0, at_least=0.0
    )
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        return (1.0 + self.half_at / (n + self.prior)) / (1.0 + self.half_at / (1.0 + self.prior))

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        return (n + self.half_at * hyperbola_work(n, self.prior)) / (1.0 + self.half_at / (1.0 + self.prior))


@dataclass(frozen=True, slots=True)
class DualPhase(Curve):
    """T_n = T_1 (c n^-bc + (1 - c) n^-bm): thinking is learned quickly, moving slowly.

    Source: Dar-El, Ayas & Gilad (1995), with rates of 0.70 and 0.90; the share c is of the task, its default assumed.
    """

    does: ClassVar[str] = "what is thought is learned quickly, what is moved slowly"
    source: ClassVar[str] = (
        "Dar-El, E. M., Ayas, K. & Gilad, I. (1995). A dual-phase model for the individual learning process in "
        "industrial tasks. IIE Trans. 27, 265-271"
    )
    cognitive_rate: float = rate_parameter(0.70, "rate of the cognitive part at each doubling")
    motor_rate: float = rate_parameter(0.90, "rate of the motor part at each doubling")
    cognitive_share: float = parameter(
        0.5, "share of the first time that is cognitive", unit="share", at_least=0.0, at_most=1.0
    )
    measured_at: float = measured_at_parameter()

    def shape(self, n: float) -> float:
        """Time of the n-th repetition over that of the first."""
        c = self.cognitive_share
        return c * n ** -slope(self.cognitive_rate) + (1.0 - c) * n ** -slope(self.motor_rate)

    def work(self, n: float) -> float:
        """What n repetitions take, in times of the first."""
        c = self.cognitive_share
        return c * power_work(n, slope(self.cognitive_rate)) + (1.0 - c) * power_work(n, slope(self.motor_rate))
