"""Errors: who is tired leaves more defects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from opsim.human.parameter import Checked, parameter


@dataclass(frozen=True, slots=True)
class ErrorsByFatigue(Checked):
    """Fatigue leaves a defect in an operation by chance at_full_fatigue * level, level 0 (fresh) to 1 (exhausted).

    It comes on top of the station's yield and the worker's quality, which are those of fresh people: their shares of
    good work are multiplied. Source: that fatigue costs quality is well reported (Kolus, Wells & Neumann 2018); that it
    does so in proportion is an assumption, so the parameter has no source of its own.
    """

    does: ClassVar[str] = "the chance of a defect grows with fatigue"
    source: ClassVar[str] = (
        "Kolus, A., Wells, R. & Neumann, P. (2018). Production quality and human factors engineering: a systematic "
        "review and theoretical framework. Appl. Ergon. 73, 55-89"
    )
    at_full_fatigue: float = parameter(
        0.1,
        "chance of a defect, an operation, by somebody exhausted",
        unit="share",
        neutral=0.0,
        at_least=0.0,
        at_most=1.0,
    )

    def share_of_good(self, level: float) -> float:
        """The share of operations that fatigue leaves good."""
        return 1.0 - self.at_full_fatigue * min(1.0, max(0.0, level))
