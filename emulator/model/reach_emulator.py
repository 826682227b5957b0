"""A MotionEmulator whose joints are at targets: the same task, people and random numbers, another law of z."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from emulator.model.emulator import MotionEmulator
from emulator.model.gaussian import Law
from emulator.model.performances import Ground, MotionPerformances
from emulator.model.reach import LocalRegression, ReachedLaw, errors_scale, reached_law, recorded
from emulator.model.targets import HandPlaces, Target, checked
from emulator.people.workers import WorkerEffect

HIT_M = 0.003
"""A decoded body whose joint is nearer than this to its target at the mark is left as it is."""
ROUNDS = 6
KEPT_LAWS = 256
"""Laws of workers that are kept at a time."""


def given_targets(model: MotionEmulator, targets: Target | Sequence[Target]) -> MotionEmulator:
    """See ``MotionEmulator.given``; targets of an emulator that has some already are added to them."""
    asked = (targets,) if isinstance(targets, Target) else tuple(targets)
    own = {one.name: getattr(model, one.name) for one in fields(MotionEmulator)}
    return ReachEmulator(**own, targets=checked(model, (*getattr(model, "targets", ()), *asked)))


@dataclass(frozen=True, eq=False)
class ReachEmulator(MotionEmulator):
    """A MotionEmulator given where joints are at marks, see ``MotionEmulator.given``."""

    targets: tuple[Target, ...] = ()

    def law(self, effect: WorkerEffect | None) -> Law:
        """The law of z of the worker with this effect, or (None) of a new worker each time, given the targets."""
        return self._reached(effect).law

    def performances(self, scores: np.ndarray, body_scale: float | np.ndarray = 1.0) -> MotionPerformances:
        """See ``MotionEmulator.performances``; decoded they are at the targets, within 5 mm."""
        drawn = super().performances(scores, body_scale)
        return ReachPerformances(self, drawn.scores, drawn.duration_s, drawn.body_scale)

    def covariance_with(self, at: int, effect: WorkerEffect | None) -> np.ndarray:
        """(K,) covariance of z with its coordinate ``at``, given the targets: hands stay where they are."""
        law = self.law(effect)
        apart = law.mean - law.weight @ law.mean
        return np.asarray(law.weight @ (apart[:, at, None] * apart + law.covariance_with(at)))

    @cached_property
    def middle(self) -> np.ndarray:  # type: ignore[override]
        """(K,) the most likely z of anybody at the targets."""
        return self._reached(None).middle

    @cached_property
    def target_m(self) -> np.ndarray:
        """(R,) what is asked for, target by target, in the order of ``AXES``."""
        return np.array([value for target in self.targets for value in target.place if value is not None], float)

    def places(self, z: np.ndarray, scale: float | np.ndarray = 1.0) -> np.ndarray:
        """z (n, K) -> (n, R) where the joints are along the axes asked for."""
        return self.asked(self.hands(z, scale))

    def asked(self, places_m: np.ndarray) -> np.ndarray:
        """Places (n, G, 3) -> (n, R) of the axes that are asked for."""
        return places_m.reshape(len(places_m), -1)[:, self._rows]

    @cached_property
    def hands(self) -> HandPlaces:
        """Where the targets' joints are at the targets' marks."""
        return HandPlaces.of(self, self.targets)

    @cached_property
    def posture_moving(self) -> np.ndarray:
        """(P, R) how posture coefficients alone follow the hands, so that the hands come as far as they are to."""
        block = self.scale.block("posture")
        way = np.zeros_like(self._reached(None).moving)
        way[block] = self._reached(None).moving[block]
        middle, step = self.middle, 0.01
        moved = self.places(np.concatenate([middle[None], middle + step * way.T]))
        turned = np.linalg.lstsq(((moved[1:] - moved[0]) / step).T, np.eye(len(self.target_m)), rcond=1e-3)[0]
        return np.asarray(self.scale.spread[block][:, None] * way[block] @ turned)

    @cached_property
    def _rows(self) -> list[int]:
        asked = [value for target in self.targets for value in target.place]
        return [i for i, value in enumerate(asked) if value is not None]

    @cached_property
    def _span(self) -> float:
        """Share of the recordings that lines through them look at, the same for all workers."""
        z = recorded(self, None)
        return LocalRegression(z, self.places(z)).best(errors_scale(self)).span

    @cached_property
    def _laws(self) -> dict[Any, ReachedLaw]:
        return {}

    def _reached(self, effect: WorkerEffect | None) -> ReachedLaw:
        """Worked out once for a worker."""
        key = None if effect is None else (effect.z.tobytes(), effect.name, effect.scale, effect.like)
        if key not in self._laws:
            if len(self._laws) >= KEPT_LAWS:
                self._laws.pop(next(iter(self._laws)))
            scale = 1.0 if effect is None else effect.scale
            self._laws[key] = reached_law(self, effect, lambda z: self.places(z, scale), self.target_m, self._span)
        return self._laws[key]


@dataclass(frozen=True, eq=False)
class ReachPerformances(MotionPerformances):
    """n performances of a ``ReachEmulator``: posture coefficients are moved until the decoded joints are there.

    Durations and marks are those of the draw.
    """

    model: ReachEmulator

    def _grounded(self, kept: np.ndarray) -> Ground:
        """As ``MotionPerformances``, with postures moved until the joints are at their targets within ``HIT_M``."""
        model = self.model
        moved = np.zeros((len(self), model.scale.sizes[0]))
        ground = self._stood(kept, moved)
        miss = model.target_m - self._places(ground)
        turned = np.broadcast_to(np.eye(len(model.target_m)), (len(self), *[len(model.target_m)] * 2)).copy()
        rows = np.flatnonzero(np.abs(miss).max(axis=1, initial=0.0) > HIT_M)
        for _ in range(ROUNDS):
            if rows.size == 0:
                break
            step = np.einsum("nij,nj->ni", turned[rows], miss[rows])
            moved[rows] += step @ model.posture_moving.T
            some = self[rows]
            again = some._stood(kept[rows], moved[rows])
            missed = model.target_m - some._places(again)
            turned[rows] = _broyden(turned[rows], step, miss[rows] - missed)
            miss[rows] = missed
            for name, values in vars(again).items():
                getattr(ground, name)[rows] = values
            rows = rows[np.abs(missed).max(axis=1) > HIT_M]
        return ground

    def _places(self, ground: Ground) -> np.ndarray:
        """(n, R) where the joints are of bodies that stand like this."""
        standing = replace(self)
        standing.__dict__["_ground"] = ground
        return self.model.asked(self.model.hands.decoded(standing))


def _broyden(inverse: np.ndarray, step: np.ndarray, came: np.ndarray) -> np.ndarray:
    """Inverse derivatives (n, R, R) after steps (n, R) by which the hands came so far (n, R).

    Source: Broyden (1965), his good update by Sherman & Morrison.
    """
    foretold = np.einsum("nij,nj->ni", inverse, came)
    size = np.einsum("ni,ni->n", step, foretold)
    safe = np.where(np.abs(size) > 1e-12, size, np.inf)
    row = np.einsum("ni,nij->nj", step, inverse)
    return np.asarray(inverse + (step - foretold)[:, :, None] * row[:, None] / safe[:, None, None])
