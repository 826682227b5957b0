"""LFFRM: fatigue grows with time at work and fades with time off it."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, log, log1p
from typing import ClassVar

from opsim.human.parameter import Checked, parameter

BY = ("even", "posture")


@dataclass(frozen=True, slots=True)
class Lffrm(Checked):
    """Fatigue F of 0 (fresh) to 1: 1 - (1 - F) exp(-lambda t) after t of work, F exp(-mu t) after t of rest.

    by : ``even``: all work tires alike; ``posture``: lambda times how heavy the task is beside the others, by its mean
         load on the joints (``opsim.human.burden``), an assumption

    Source: Jaber, Givi & Neumann 2013, their fatigue from a residual of the rest before, and their recovery. They give
    lambda of 0.01 to 0.05 as slow to fast; here lambda = ln 2 / tires_half_in_s, mu = ln 2 / recovers_half_in_s.
    That fatigue acts on log time in proportion, by slows at full fatigue, is an assumption.
    """

    does: ClassVar[str] = "fatigue grows with time at work, fades with rest, and slows"
    source: ClassVar[str] = (
        "Jaber, M. Y., Givi, Z. S. & Neumann, W. P. (2013). Incorporating human fatigue and recovery into the "
        "learning-forgetting process. Appl. Math. Model. 37, 7287-7299"
    )
    tires_half_in_s: float = parameter(
        14_400.0, "work after which half of what was fresh is tired", unit="s", neutral=inf, above=0.0, endless=True
    )
    recovers_half_in_s: float = parameter(1_200.0, "rest after which fatigue is half", unit="s", above=0.0)
    slows: float = parameter(
        0.2, "how much longer work takes at full fatigue", unit="share", neutral=0.0, at_least=0.0, at_most=10.0
    )
    by: str = parameter("even", "whether all work tires alike, or as heavy tasks are", words=BY)

    @property
    def needs_burden(self) -> bool:
        """Whether it asks how heavy tasks are."""
        return self.by == "posture"

    def fresh(self) -> float:
        """The fatigue of a rested person."""
        return 0.0

    def passed(
        self, state: float, heaviness: float, _first: float, _last: float, work_s: float, rest_s: float
    ) -> float:
        """Fatigue after some seconds of a task that is so many times as heavy as the mean, and some of rest then."""
        state = 1.0 - (1.0 - state) * exp(-_LN2 / self.tires_half_in_s * heaviness * work_s)
        return self.rested(state, rest_s) if rest_s > 0.0 else state

    def rested(self, state: float, seconds: float) -> float:
        """Fatigue after some seconds of rest."""
        return state * exp(-_LN2 / self.recovers_half_in_s * seconds)

    def level(self, state: float) -> float:
        """0 to 1."""
        return state

    def by_joint(self, _state: float) -> dict[str, float]:
        """It knows no joints."""
        return {}

    def shift(self, level: float) -> float:
        """Of log time: work takes exp(shift) times as long."""
        return log1p(self.slows) * level

    def rest_to_s(self, state: float, level: float) -> float:
        """Seconds of rest after which fatigue is no more than a level, above 0."""
        if state <= level:
            return 0.0
        return log(state / level) * self.recovers_half_in_s / _LN2


_LN2 = log(2.0)
