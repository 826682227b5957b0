"""A task of several motions, one after the other: reach, grasp, carry 3 m, place, fasten four times.

Times add up, marks follow one another, and the bodies are joined where one motion ends and the next begins (``seams``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from emulator.composite_frames import n_frames
from emulator.composite_part import CONDITIONS, Part, checked
from emulator.composite_performances import CompositePerformances
from emulator.composite_told import CompositeReport, Join, joins_of, report_of
from emulator.composite_worker import CompositeEffect, drawn_worker
from emulator.courses import BLEND_S, difference, widest_gap_rad
from emulator.skeleton import Skeleton

__all__ = ["CompositeEffect", "CompositeEmulator", "CompositeReport", "Join", "Part"]


@dataclass(frozen=True, eq=False)
class CompositeEmulator:
    """A task whose performances are those of its parts, one after the other; satisfies the same seam as they do.

    blend_s : how long before and after a join the postures are brought together; longer where they are far apart
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

    def sample(
        self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Mapping[str, Any] | None = None
    ) -> CompositePerformances:
        """n performances, part after part, each with draws of its own.

        worker    : an effect of ``draw_worker``, the name of somebody whom all parts know, or None: each part by
                    other workers of the population, all with the bones of the first part that goes a way, so that
                    further ways come out a few per cent longer or shorter; a drawn worker walks them as asked
        condition : None, {"pace": 1.1} or {"log_duration_shift": d}: passed to all parts
        Raises ValueError for an unknown worker or condition.
        """
        asked, speed, drawn = checked(self.task, condition), _speed(worker), []
        for part in self.parts:
            effect = self._effect(part, worker)
            wanted = part.asked(asked, speed)
            drawn.append(part.model.sample(n, rng, worker=effect, condition=wanted))
        return CompositePerformances(self, tuple(drawn))

    def mean_duration_s(self, worker: Any = None) -> float:
        """The sum of the parts' means, in seconds."""
        return sum(part.mean_s(self._effect(part, worker), _speed(worker)) for part in self.parts)

    def draw_worker(
        self,
        rng: np.random.Generator,
        body: Any = None,
        people: Callable[[str], float] | None = None,
        slowness: float | None = None,
        own: Callable[[str, Any], Any] | None = None,
    ) -> CompositeEffect | None:
        """A worker of the population: an effect for each task that parts are of; None where nobody differs in any.

        own  : this worker's effect in the task of a key with this model, however it is found; then ``rng``, ``people``
               and ``slowness`` are not used
        body : besides what the parts read, ``walk_m_per_s``: how fast he walks
        """
        return drawn_worker(self.parts, rng, body, people, slowness, own)

    @property
    def conditions(self) -> tuple[str, ...]:
        """What ``sample`` may be asked for: what all parts may."""
        return tuple(name for name in CONDITIONS if all(name in getattr(p.model, "conditions", ()) for p in self.parts))

    knows_people = knows_slowness = knows_parts = True
    """``draw_worker`` takes ``people``, ``slowness`` and ``own``."""

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
        """The part whose bones all have: the first that goes a way, so that its length holds; else the first."""
        return next((k for k, part in enumerate(self.parts) if part.condition), 0)

    @cached_property
    def n_frames(self) -> tuple[int, ...]:
        """Frames of each part on which its path is made."""
        return tuple(n_frames(part.mean_s()) for part in self.parts)

    @property
    def body_keys(self) -> tuple[str, ...]:
        """What ``draw_worker`` reads of a body: what any part does."""
        return tuple(dict.fromkeys(key for m in self.distinct.values() for key in getattr(m, "body_keys", ())))

    @property
    def workers(self) -> tuple[str, ...]:
        """The workers with whom all parts were learned that know any."""
        known = [m.workers for m in self.distinct.values() if "person" in getattr(m, "body_keys", ())]
        return tuple(name for name in known[0] if all(name in some for some in known)) if known else ()

    @property
    def report(self) -> CompositeReport:
        """Source, licence and size of what the parts were learned from."""
        return report_of(list(self.distinct.values()))

    def typical(self, n: int = 64, seed: int = 0) -> CompositePerformances:
        """One performance, a block of one: of ``n`` drawn of each part the one whose time is nearest to the mean.

        There is no mean posture of what people do at different times.
        """
        drawn = self.sample(n, np.random.default_rng(seed))
        nearest = [np.argmin(np.abs(p.duration_s - part.mean_s())) for p, part in zip(drawn.parts, self.parts)]
        return CompositePerformances(self, tuple(p[int(row)] for p, row in zip(drawn.parts, nearest)))

    def joins(self, n: int = 24, seed: int = 0) -> tuple[Join, ...]:
        """How far apart postures typically are at each join: the median over ``n`` drawn performances."""
        angles = np.median(self.sample(n, np.random.default_rng(seed)).gaps_rad(), axis=0)
        return joins_of(angles, self.labels, self.skeleton, widest_gap_rad(self.blend_s))

    def _repr_html_(self) -> str:
        from emulator.shown.models import emulator_html

        return emulator_html(self)

    def _effect(self, part: Part, worker: Any) -> Any:
        """The worker's effect in a part's task."""
        if worker is None or isinstance(worker, str):
            return worker
        if not isinstance(worker, CompositeEffect) or part.task not in worker.effects:
            raise ValueError(f"{self.task}: this worker's effect was not drawn from this emulator")
        return worker.effects[part.task]


def _speed(worker: Any) -> float | None:
    return worker.walk_m_per_s if isinstance(worker, CompositeEffect) else None
