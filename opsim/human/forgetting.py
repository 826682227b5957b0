"""Forgetting: how many repetitions somebody remembers after a pause."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log1p
from typing import ClassVar

from opsim.human.parameter import Checked, parameter


@dataclass(frozen=True, slots=True)
class LearnForgetCurve(Checked):
    """LFCM: after q repetitions, which took t(q) without a pause, and a pause of d, alpha of them are remembered.

    As published, with T_x = T_1 x^-b, the time D after which all is forgotten, f the slope of forgetting and S what
    would have been done by the end of the pause had it been work:

        f     = b (1 - b) log q / log(1 + D / t(q))
        S     = q (1 + d / t(q))^(1 / (1 - b))
        alpha = q^(1 + f / b) S^(-f / b)

    Put into one another, b goes out: alpha = q^(1 - log(1 + d/t) / log(1 + D/t)), which any model of learning can use
    that knows t(q). At d = D one repetition is left: time is that of the first. From D on nothing is.
    Who has done it once or less forgets nothing before D. Pauses shorter than ``least_pause_s`` are no interruptions.
    Source: Jaber & Bonney (1996; 1997). D of a year and the least pause of a day are assumptions: breaks of
    1 to 82 days are what the model was compared with (Globerson, Levin & Shtub 1989).
    """

    does: ClassVar[str] = "a pause takes repetitions away again, the more the longer it is"
    source: ClassVar[str] = (
        "Jaber, M. Y. & Bonney, M. (1996). Production breaks and the learning curve: the forgetting phenomenon. "
        "Appl. Math. Model. 20, 162-169; (1997) 21, 523-531"
    )
    forgotten_in_s: float = parameter(
        31_536_000.0, "the pause after which all is forgotten (D)", unit="s", neutral=inf, above=0.0, endless=True
    )
    least_pause_s: float = parameter(86_400.0, "pauses shorter than this cost nothing", unit="s", at_least=0.0)

    def remembered(self, repetitions: float, pause_s: float, worked_s: float) -> float:
        """What is left of ``repetitions``, which took ``worked_s`` without a pause, after a pause."""
        if pause_s < self.least_pause_s or repetitions <= 0.0 or pause_s <= 0.0:
            return repetitions
        if pause_s >= self.forgotten_in_s:
            return 0.0
        if repetitions <= 1.0:
            return repetitions
        return repetitions ** (1.0 - log1p(pause_s / worked_s) / log1p(self.forgotten_in_s / worked_s))
