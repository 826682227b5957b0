"""One thing that theory says, and how the simulation is asked for it."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from recordings import reference

HERE = Path(__file__).parent


@dataclass(frozen=True)
class Case:
    """A figure ``kpi`` (or one of ``from_log.py``) of a variant of a file.

    expected : theory's number, or the name of the model and the path to it
    scale : figure = scale x number + shift (a rate per second is asked as a rate per hour; a wait as a stay)
    most_half_width : of the 95 % interval, relative, at the replications the file asks for
    few   : replications that give 5 %, for ``make test``
    """

    file: str
    variant: str
    kpi: str
    expected: tuple[str, ...] | float
    scale: float = 1.0
    shift: float = 0.0
    most_half_width: float = 0.01
    few: int = 12

    @property
    def name(self) -> str:
        return f"{self.file}/{self.variant} {self.kpi}"

    def answer(self) -> float:
        """The number that theory gives."""
        found = _looked_up(self.expected) if isinstance(self.expected, tuple) else self.expected
        return self.scale * found + self.shift


def _looked_up(path: tuple[str, ...]) -> float:
    found = _reference()
    for part in path:
        found = sum(found) if part == "sum" else found[part]
    return found


@cache
def _reference() -> dict:
    return {entry["name"]: entry["expected"] for entry in json.loads(reference("known_answers.json").read_text())}
