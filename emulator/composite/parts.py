"""The motions of a composite task, one after the other: each with its model and what it is asked for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from emulator.composite.transitions import BLEND_S, difference
from emulator.skeleton import Skeleton

FRAMES_HZ = 50.0
_FEWEST, _MOST = 24, 4000


def n_frames(mean_s: float) -> int:
    """Frames on which the path of a part is made: the same for every performance, so that each is what it is alone."""
    return int(np.clip(np.ceil(mean_s * FRAMES_HZ), _FEWEST, _MOST)) + 1


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


@dataclass(frozen=True, eq=False)
class PartSequence:
    """blend_s : how long before and after a join the postures are brought together; longer where they are far apart

    Raises ValueError for no parts, or parts of different skeletons.
    """

    task: str
    parts: tuple[Part, ...]
    blend_s: float = BLEND_S

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", tuple(self.parts))
        if not self.parts:
            raise ValueError(f"{self.task}: found no motions, expected one or more")
        wrong = [
            f"{self.task}: {part.name} has {difference(self.skeleton, part.model.skeleton)}, unlike "
            f"{self.parts[0].name}; expected one skeleton in all"
            for part in self.parts[1:]
            if part.model.skeleton != self.skeleton
        ]
        if wrong:
            raise ValueError("\n".join(dict.fromkeys(wrong)))

    @property
    def skeleton(self) -> Skeleton:
        skeleton: Skeleton = self.parts[0].model.skeleton
        return skeleton

    @cached_property
    def mark_names(self) -> tuple[str, ...]:
        """``reach.touch``, ``fasten.2.start``."""
        return tuple(f"{label}.{mark}" for label, part in zip(self.labels, self.parts) for mark in part.marks)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """A name for each part: its own, with its number where it comes more than once."""
        times, seen, labels = Counter(part.name for part in self.parts), Counter[str](), []
        for part in self.parts:
            seen[part.name] += 1
            labels.append(part.name if times[part.name] == 1 else f"{part.name}.{seen[part.name]}")
        return tuple(labels)

    @cached_property
    def distinct(self) -> dict[str, Any]:
        """The model of each task that parts are of, by key, in the order of the parts."""
        return {part.task: part.model for part in self.parts}

    @cached_property
    def body_part(self) -> int:
        """The part whose bones all have: the first that goes a way, so that its length holds; else one with targets."""
        led = [k for k, part in enumerate(self.parts) if getattr(part.model, "targets", ())]
        return next((k for k, part in enumerate(self.parts) if part.condition), led[0] if led else 0)

    @cached_property
    def n_frames(self) -> tuple[int, ...]:
        """Frames of each part on which its path is made."""
        return tuple(n_frames(part.mean_s()) for part in self.parts)
