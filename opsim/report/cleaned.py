"""What a picture of a cleaned recording is made of: arrays and words, no emulator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

VERDICTS = {
    "left out": ("#7a1f1f", "cannot be used"),
    "bad": ("#D55E00", "a fault that was left"),
    "shortened": ("#CC4678", "part of the movement is gone"),
    "repaired": ("#0072B2", "mended"),
    "told": ("#8a5a00", "odd, but left as it is"),
    "good": ("#009E73", "nothing to mend"),
}
"""Colour and meaning of what is said of a take, the worst first. "repaired, told" is both, in the first's colour."""


def headline(verdict: str) -> str:
    """The verdict that comes first in, say, "repaired, told"."""
    return verdict.partition(", ")[0]


@dataclass(frozen=True)
class Finding:
    """One thing found in a take: which kind, where in seconds, how much, in words; ``share`` from 0 to 1 colours it.

    column : where it stands in the table, such as "glitch left"; its kind unless said
    """

    kind: str
    first_s: float
    last_s: float
    size: str
    share: float
    mended: bool
    words: str
    column: str = ""

    @property
    def of(self) -> str:
        return self.column or self.kind


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
    mended                 : whether anything was changed; else the fault was left
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
    mended: bool = True


@dataclass(frozen=True)
class CleanedView:
    """All of a picture: takes in the order of the recording, kinds in the order of the work, the worst repairs."""

    title: str
    cards: Sequence[TakeCard]
    kinds: Sequence[tuple[str, str]]
    worst: Sequence[Mended]
    notes: Sequence[str]

    @property
    def columns(self) -> list[str]:
        """Of the table: by kind, and of each kind what was mended before what was left."""
        order = [kind for kind, _ in self.kinds]
        found = [finding for card in self.cards for finding in card.findings if finding.kind in order]
        found.sort(key=lambda finding: (order.index(finding.kind), not finding.mended, finding.of))
        return list(dict.fromkeys(finding.of for finding in found))


def cell(findings: Sequence[Finding]) -> str:
    """How many findings of a column, and the size of the largest."""
    if not findings:
        return ""
    largest = max(findings, key=lambda finding: finding.share).size
    return largest if len(findings) == 1 else f"{len(findings)} x {largest}"
