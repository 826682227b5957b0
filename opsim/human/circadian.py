"""The time of day: people are quickest in the afternoon and slowest before dawn."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi
from typing import ClassVar

from opsim.human.parameter import Checked, parameter

DAY_S = 86_400.0


@dataclass(frozen=True, slots=True)
class Circadian(Checked):
    """The shift of log time is -amplitude cos(2 pi (clock - peak) / 24 h): its mean over a day is 0.

    Source: the circadian process of the three-process model (Akerstedt & Folkard 1997), a cosine with its top at 16.8 h
    (16:48); that log time follows alertness in proportion, and the amplitude, are assumptions.
    """

    does: ClassVar[str] = "pace follows a cosine by the clock, best at its peak, worst twelve hours off"
    source: ClassVar[str] = (
        "Akerstedt, T. & Folkard, S. (1997). The three-process model of alertness and its extension to performance, "
        "sleep latency, and sleep length. Chronobiol. Int. 14, 115-123"
    )
    amplitude: float = parameter(
        0.05, "log of time won at the peak and lost twelve hours off", neutral=0.0, at_least=0.0, at_most=1.0
    )
    peak_s: float = parameter(
        60_480.0, "time of the day at which people are quickest", unit="s", at_least=0.0, below=DAY_S
    )

    def shift(self, clock_s: float) -> float:
        """By how much log time shifts at seconds after any midnight."""
        return -self.amplitude * cos(2.0 * pi * (clock_s - self.peak_s) / DAY_S)
