"""What one replication says, small enough to be sent from one machine to another."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

from opsim.kpi.figure import Figure
from opsim.results import Key


@dataclass(frozen=True, slots=True)
class Answer:
    """``figures`` is the JSON text of the figures' keys, ``values`` the numbers in their order."""

    figures: str
    values: tuple[float, ...]

    @classmethod
    def of(cls, figures: Sequence[Figure]) -> Answer:
        """An answer from figures, in one order whatever theirs is."""
        figures = sorted(figures, key=lambda figure: figure[:4])
        keys = json.dumps([list(figure[:4]) for figure in figures], ensure_ascii=False)
        return cls(keys, tuple(float(figure.value) for figure in figures))


def keys_in(figures: str) -> list[Key]:
    """(kpi, subject, part, unit) of each value of an answer."""
    return [(kpi, subject, part, unit) for kpi, subject, part, unit in json.loads(figures)]
