"""One motion of a composite task, and what it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

CONDITIONS = ("pace", "log_duration_shift")
"""What a composite may be asked for, passed to all its parts."""


@dataclass(frozen=True, eq=False)
class Part:
    """One motion: its name in marks, its model, and which task it is.

    condition : what its performances are asked for, such as ``{"distance_m": 3.0}``, or None
    key       : parts of one key are one task, so a worker has one effect in them; "": the name
    """

    name: str
    model: Any
    condition: Mapping[str, Any] | None = None
    key: str = ""

    @property
    def task(self) -> str:
        return self.key or self.name

    @property
    def marks(self) -> tuple[str, ...]:
        return tuple(getattr(self.model, "mark_names", ()))

    def asked(self, asked: Mapping[str, Any] | None, speed_m_per_s: float | None = None) -> dict[str, Any] | None:
        """The condition of its performances: its own, and what the whole is asked for.

        speed_m_per_s : how fast the worker walks, of a way; None: as the model has it
        """
        own = dict(self.condition or {})
        speed = {"speed_m_per_s": speed_m_per_s} if "distance_m" in own and speed_m_per_s is not None else {}
        return {**own, **speed, **(asked or {})} or None

    def mean_s(self, effect: Any = None, speed_m_per_s: float | None = None) -> float:
        """Mean seconds, of a worker with this effect who walks so fast."""
        condition = self.asked(None, speed_m_per_s)
        if condition is None:
            return float(self.model.mean_duration_s(effect))
        return float(self.model.mean_duration_s(effect, condition))


def checked(task: str, condition: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    """A condition of a whole composite. Raises ValueError for one it does not know, with the nearest."""
    for name in condition or {}:
        if name not in CONDITIONS:
            near = get_close_matches(str(name), CONDITIONS, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CONDITIONS)}"
            raise ValueError(f"{task}: condition: a task of several motions knows no {name!r}; {hint}")
    return condition
