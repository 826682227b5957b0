"""A worker in a task of several motions: his own effect in each of them, and how fast he walks.

What a task of several motions tells of itself: what stands behind it, and how far its motions are apart.

A task of several motions, one after the other: reach, grasp, carry 3 m, place, fasten four times.

Times add up, marks follow one another, and the bodies are joined where one motion ends and the next begins (``seams``).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

import numpy as np

from emulator.composite.parts import Part, PartSequence
from emulator.composite.performances import CompositePerformances
from emulator.composite.transitions import widest_gap_rad
from emulator.model.targets import Target, mark_number
from emulator.skeleton import Skeleton

__all__ = ["CompositeEffect", "CompositeEmulator", "CompositeReport", "Join", "Part"]


CONDITIONS = ("pace", "log_duration_shift")
"""What a composite may be asked for, passed to all its parts."""


def checked(task: str, condition: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    """A condition of a whole composite. Raises ValueError for one it does not know, with the nearest."""
    for name in condition or {}:
        if name not in CONDITIONS:
            near = get_close_matches(str(name), CONDITIONS, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CONDITIONS)}"
            raise ValueError(f"{task}: condition: a task of several motions knows no {name!r}; {hint}")
    return condition


@dataclass(frozen=True, eq=False)
class CompositeEffect:
    """A worker in a composite: his effect in each of its tasks, by key, and how fast he walks where it is known."""

    effects: Mapping[str, Any]
    walk_m_per_s: float | None = None
    said: tuple[str, ...] = ()


def drawn_worker(
    parts: Sequence[Part],
    rng: np.random.Generator,
    body: Any,
    people: Callable[[str], float] | None,
    slowness: float | None,
    own: Callable[[str, Any], Any] | None,
) -> CompositeEffect | None:
    """See ``CompositeEmulator.draw_worker``."""
    walk, body = _walk_of(body)
    effects = {}
    for key, model in {part.task: part.model for part in parts}.items():
        if own is not None:
            effects[key] = own(key, model)
            continue
        more: dict[str, Any] = {}
        if people is not None and getattr(model, "knows_people", False):
            more["people"] = people
        if slowness is not None and getattr(model, "knows_slowness", False):
            more["slowness"] = slowness
        effects[key] = model.draw_worker(rng, body, **more)
    walk = walk if any(part.condition for part in parts) else None
    if walk is None and all(effect is None for effect in effects.values()):
        return None
    said = [line for effect in effects.values() for line in getattr(effect, "said", ())]
    return CompositeEffect(effects, walk, tuple(dict.fromkeys(said)))


def _walk_of(body: Any) -> tuple[float | None, Any]:
    """How fast the worker walks, and his body without that, where it is a mapping."""
    if not isinstance(body, Mapping):
        return getattr(body, "walk_m_per_s", None), body
    return body.get("walk_m_per_s"), {key: value for key, value in body.items() if key != "walk_m_per_s"}


@dataclass(frozen=True)
class Join:
    """Where one part ends and the next begins: by how much the bone to ``joint``, which differs most, differs.

    most_rad : a gap beyond it makes the join last longer than elsewhere, for nobody to move as no one can
    """

    before: str
    after: str
    gap_rad: float
    joint: str
    most_rad: float


@dataclass(frozen=True)
class CompositeReport:
    """What stands behind all parts together; people are those of the part with most."""

    source: str
    licence: str
    n_sequences: int
    n_workers: int


def report_of(models: Sequence[Any]) -> CompositeReport:
    """What stands behind these models together."""
    reports = [model.report for model in models]
    source, licence = (
        "; ".join(dict.fromkeys(getattr(one, name) for one in reports)) for name in ("source", "licence")
    )
    return CompositeReport(source, licence, sum(r.n_sequences for r in reports), max(r.n_workers for r in reports))


def joins_of(gaps_rad: np.ndarray, labels: Sequence[str], skeleton: Skeleton, most_rad: float) -> tuple[Join, ...]:
    """Each join by its gaps (P - 1, B) and the labels of the P parts."""
    bones = skeleton.bone_names
    return tuple(
        Join(labels[k], labels[k + 1], float(gap.max()), bones[int(gap.argmax())], most_rad)
        for k, gap in enumerate(gaps_rad)
    )


@dataclass(frozen=True, eq=False)
class CompositeEmulator(PartSequence):
    """A task whose performances are those of its parts, one after the other; satisfies the same seam as they do."""

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

    def given(self, targets: Target | Sequence[Target]) -> CompositeEmulator:
        """The same task whose parts are given the targets at their marks, named as in ``mark_names``.

        Places are in the person's own frame at the beginning of the part. A joint is there within 5 mm in the part
        whose bones all have (``body_part``); with other bones it is some centimetres beside.
        Raises ValueError, with all mistakes, for a mark that no part has, a part that cannot be given a place, and what
        ``MotionEmulator.given`` refuses.
        """
        asked = (targets,) if isinstance(targets, Target) else tuple(targets)
        wrong, of_part = [], defaultdict[int, list[Target]](list)
        places = [(part, mark) for part in range(len(self.parts)) for mark in range(len(self.parts[part].marks))]
        for target in asked:
            if not isinstance(target, Target):
                wrong.append(f"{self.task}: found {target!r}, expected a Target")
                continue
            try:
                part, mark = places[mark_number(self.task, self.mark_names, target.mark)]
            except ValueError as why:
                wrong.append(str(why))
                continue
            of_part[part].append(replace(target, mark=mark))
        if not asked:
            wrong.append(f"{self.task}: found no target, expected one or more")
        parts = list(self.parts)
        for number, own in of_part.items():
            try:
                parts[number] = _given(self.task, self.parts[number], own)
            except ValueError as why:
                wrong.append(str(why))
        if wrong:
            raise ValueError("\n".join(wrong))
        return replace(self, parts=tuple(parts))

    @property
    def conditions(self) -> tuple[str, ...]:
        """What ``sample`` may be asked for: what all parts may."""
        return tuple(name for name in CONDITIONS if all(name in getattr(p.model, "conditions", ()) for p in self.parts))

    knows_people = knows_slowness = knows_parts = True
    """``draw_worker`` takes ``people``, ``slowness`` and ``own``."""

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
        from emulator.notebook import emulator_html

        return emulator_html(self)

    def _effect(self, part: Part, worker: Any) -> Any:
        """The worker's effect in a part's task."""
        if worker is None or isinstance(worker, str):
            return worker
        if not isinstance(worker, CompositeEffect) or part.task not in worker.effects:
            raise ValueError(f"{self.task}: this worker's effect was not drawn from this emulator")
        return worker.effects[part.task]


def _given(task: str, part: Part, targets: Sequence[Target]) -> Part:
    """The part with a model that is given the targets, in its own marks. Raises ValueError for one that takes none."""
    if not hasattr(part.model, "given"):
        raise ValueError(f"{task}: {part.name} cannot be given a place; take a MotionEmulator for it")
    return replace(part, model=part.model.given(targets))


def _speed(worker: Any) -> float | None:
    return worker.walk_m_per_s if isinstance(worker, CompositeEffect) else None
