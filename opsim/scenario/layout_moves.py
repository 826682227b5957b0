"""Changes of a layout as an engineer writes them: ``swap saw,drill``, ``place drill=spare_2``, and so on."""

from __future__ import annotations

import re
from dataclasses import dataclass

from opsim import units
from opsim.problems import did_you_mean, shown

EXAMPLES = {
    "move": "bench=6 m, 1 m",
    "swap": "saw,drill",
    "place": "drill=spare_2",
    "add": "second_drill=like drill at spare_1",
}
_NAME = r"[\w][\w \-]*?"
_FORMS = {
    "move": re.compile(rf"\s*({_NAME})\s*=\s*\[?\s*([^,\[\]]+?)\s*,\s*([^,\[\]]+?)\s*\]?\s*"),
    "swap": re.compile(rf"\s*({_NAME})\s*,\s*({_NAME})\s*"),
    "place": re.compile(rf"\s*({_NAME})\s*=\s*({_NAME})\s*"),
    "add": re.compile(rf"\s*({_NAME})\s*=\s*like\s+({_NAME})\s+at\s+({_NAME})\s*"),
}


@dataclass(frozen=True, slots=True)
class Moved:
    """A change of a layout. kind : one of ``EXAMPLES``; what : the names and lengths it was said with, in that order.

    move : a place, x and y as text; swap : two stations; place : a station and a place; add : a new station, the one
    it is like, and a place
    """

    kind: str
    what: tuple[str, ...]

    def __str__(self) -> str:
        first, *rest = self.what
        said = {
            "move": f"{first}={', '.join(rest)}",
            "swap": ",".join(self.what),
            "place": "=".join(self.what),
            "add": f"{first}=like {' at '.join(rest)}",
        }
        return f"{self.kind} {said[self.kind]}"


def read_moved(kind: str, text: object) -> Moved:
    """``read_moved("swap", "saw,drill")``. Raises ValueError in our words, with an example."""
    example = f"such as {kind} {shown(EXAMPLES[kind])}"
    match = _FORMS[kind].fullmatch(text) if isinstance(text, str) else None
    if match is None:
        raise ValueError(f"{kind} {shown(text)} cannot be read; {example}")
    moved = Moved(kind, tuple(match.groups()))
    if kind == "move":
        for length in moved.what[1:]:
            _check_length(kind, text, length)
    if kind == "swap" and moved.what[0] == moved.what[1]:
        raise ValueError(f"swap {shown(text)}: a station cannot change places with itself; name two")
    return moved


def read_any_moved(text: object) -> Moved:
    """With the kind in front: ``swap saw,drill``. Raises ValueError in our words."""
    kind, _, rest = text.strip().partition(" ") if isinstance(text, str) else ("", "", "")
    if kind not in EXAMPLES:
        hint = did_you_mean(kind, EXAMPLES) if kind else "such as 'swap saw,drill'"
        raise ValueError(f"expected a change of the layout (move, swap, place or add), found {shown(text)}; {hint}")
    return read_moved(kind, rest)


def split_names(text: str) -> list[str]:
    """``a, b`` as two names."""
    return [name.strip() for name in text.split(",") if name.strip()]


def _check_length(kind: str, text: object, length: str) -> None:
    try:
        units.parse(length, "length")
    except units.UnitError as error:
        hint = f"; {error.hint}" if error.hint else ""
        raise ValueError(f"{kind} {shown(text)}: {error.message}{hint}") from None
