"""What a picture of a cleaned recording is made of: arrays and words, no emulator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

VERDICTS = {
    "left out": ("#7a1f1f", "cannot be used"),
    "bad": ("#D55E00", "a fault that was left"),
    "repaired": ("#0072B2", "mended"),
    "told": ("#8a5a00", "odd, but left as it is"),
    "good": ("#009E73", "nothing to mend"),
}
"""Colour and meaning of what is said of a take, the worst first."""


@dataclass(frozen=True)
class Finding:
    """One thing found in a take: which kind, where in seconds, how much, in words; ``share`` from 0 to 1 colours it."""

    kind: str
    first_s: float
    last_s: float
    size: str
    share: float
    mended: bool
    words: str


@dataclass(frozen=True)
class TakeCard:
    """A take, how long it is, what is said of it, and what was found in it."""

    name: str
    duration_s: float
    verdict: str
    findings: tuple[Finding, ...]


@dataclass(frozen=True)
class Mended:
    """One joint of one take before and after.

    time_s                 : (T,) of the take that was read
    before_m, after_m      : (T, J, 3), nan where not seen or cut off
    first_s, last_s, at_s  : the frames that it is about, and the worst of them
    """

    take: str
    verdict: str
    joint: str
    words: str
    time_s: np.ndarray
    before_m: np.ndarray
    after_m: np.ndarray
    first_s: float
    last_s: float
    at_s: float
    skeleton: Any


@dataclass(frozen=True)
class CleanedView:
    """All of a picture: takes in the order of the recording, kinds in the order of the work, the worst repairs."""

    title: str
    cards: Sequence[TakeCard]
    kinds: Sequence[tuple[str, str]]
    worst: Sequence[Mended]
    notes: Sequence[str]
