"""Rest by need: who is too tired rests until he is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from opsim.human.parameter import Checked, parameter


@dataclass(frozen=True, slots=True)
class RestByNeed(Checked):
    """Who is free, and whose fatigue is above ``above``, takes a rest until it is down to ``until``.

    A rest by need is what people do where nobody plans their breaks; both levels are assumptions.
    """

    does: ClassVar[str] = "who is too tired rests until he is not"
    source: ClassVar[str] = (
        "the rule of rest of Jaber, M. Y. & Neumann, W. P. (2010). Modelling worker fatigue and recovery in "
        "dual-resource constrained systems. Comput. Ind. Eng. 59, 75-84, asked as fatigue passes a level"
    )
    above: float = parameter(
        0.5, "fatigue above which a rest begins", unit="share", neutral=1.0, above=0.0, at_most=1.0
    )
    until: float = parameter(0.2, "fatigue at which it ends", unit="share", above=0.0, below=1.0)

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.until >= self.above:
            raise ValueError(f"until: found {self.until:g}, expected less than above, {self.above:g}")
