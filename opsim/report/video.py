"""What a video shows: the mean performance beside simulated ones, on one clock."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from opsim.report.animated import Caption
from opsim.report.staged import Card

Report = Callable[..., None]
"""``report(done, total, label="")``."""


@dataclass(frozen=True, eq=False)
class Video:
    """``mean`` first, then ``drawn``, bodies on one ``skeleton``.

    lead  : a sentence on what this is and from whom it was emulated
    notes : (topic, words) on where it comes from
    A card's ``who`` is said below its label.
    """

    task: str
    lead: str
    mean: Card
    drawn: tuple[Card, ...]
    skeleton: Any
    notes: tuple[tuple[str, str], ...] = ()

    @property
    def cards(self) -> tuple[Card, ...]:
        """In the order to show them."""
        return (self.mean, *self.drawn)

    @property
    def captions(self) -> tuple[Caption, ...]:
        """Of the cards."""
        drawn = [Caption(f"{k}", f"simulated {k}", card.who) for k, card in enumerate(self.drawn, start=1)]
        return (Caption("mean", "mean performance", self.mean.who), *drawn)
