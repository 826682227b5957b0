"""Learning by a power of the repetitions: Wright, the plateau, De Jong, Stanford-B."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from opsim.human.learning import Curve, measured_at_parameter, power_work, rate_parameter, slope
from opsim.human.parameter import parameter


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
