"""Learning otherwise than by one power: the hyperbola, and two phases."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from opsim.human.learning import Curve, hyperbola_work, measured_at_parameter, power_work, rate_parameter, slope
from opsim.human.parameter import parameter


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
