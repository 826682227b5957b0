"""A MotionEmulator whose joints are at targets: the same task, people and random numbers, another law of z."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.model.arms import Arms
from emulator.model.decoding import along
from emulator.model.emulator import MotionEmulator
from emulator.model.feet import fastest_of
from emulator.model.gaussian import Law
from emulator.model.performances import Ground, MotionPerformances, put, rows_of, turned
from emulator.model.reach import ReachedLaw, Trend, on_target, reached_law, recorded
from emulator.model.targets import HandPlaces, Target, checked
from emulator.people.bone_turns import LazyArray
from emulator.people.workers import WorkerEffect
from emulator.performances import Floats

HIT_M = 0.003
"""A decoded body whose joint is nearer than this to its target at the mark is left as it is."""
FAR_M = 0.10
"""Beyond it the whole body is moved, feet and all; nearer, trunk and arms are."""
ROUNDS = 4
MISSED_M, MISSED_PER_S = 0.005, 1000.0
"""One that is farther away is drawn in as one is whose joints are too fast: each metre counts as so many m/s."""
LONGEST = 1.5
"""A step is at most so many times as long as the way that is left, or it would lead far aside."""
STEP_M = 0.005
KEPT_LAWS = 256
"""Laws of workers that are kept at a time."""


def given_targets(model: MotionEmulator, targets: Target | Sequence[Target]) -> MotionEmulator:
    """See ``MotionEmulator.given``; targets of an emulator that has some already are added to them."""
    asked = (targets,) if isinstance(targets, Target) else tuple(targets)
    base, before = (model.base, model.targets) if isinstance(model, ReachEmulator) else (model, ())
    own = {one.name: getattr(model, one.name) for one in fields(MotionEmulator)}
    return ReachEmulator(**own, base=base, targets=checked(model, (*before, *asked)))


@dataclass(frozen=True, eq=False, kw_only=True)
class ReachEmulator(MotionEmulator):
    """A MotionEmulator given where joints are at marks, see ``MotionEmulator.given``; base : the free one."""

    base: MotionEmulator
    targets: tuple[Target, ...]

    def law(self, effect: WorkerEffect | None) -> Law:
        """The law of z of the worker with this effect, or (None) of a new worker each time, given the targets."""
        return self._reached(effect).law

    def performances(
        self, scores: np.ndarray, body_scale: float | np.ndarray = 1.0, turns: np.ndarray | LazyArray | None = None
    ) -> ReachPerformances:
        """See ``MotionEmulator.performances``; decoded they are at the targets, within 5 mm where a body can."""
        drawn = super().performances(scores, body_scale, turns)
        return ReachPerformances(self, drawn.scores, drawn.duration_s, drawn.body_scale, drawn.lazy_turns)

    def covariance_with(self, at: int, effect: WorkerEffect | None) -> np.ndarray:
        """(K,) covariance of z with its coordinate ``at``, given the targets: hands stay where they are."""
        law = self.law(effect)
        apart = law.mean - law.weight @ law.mean
        return np.asarray(law.weight @ (apart[:, at, None] * apart + law.covariance_with(at)))

    @cached_property
    def middle(self) -> np.ndarray:  # type: ignore[override]
        """(K,) the most likely z of anybody at the targets."""
        return self._reached(None).middle

    @property
    def moving(self) -> np.ndarray:
        """(K, R) how z follows joints near the most likely z."""
        return self._reached(None).moving

    @cached_property
    def target_m(self) -> np.ndarray:
        """(R,) what is asked for, target by target, in the order of ``AXES``."""
        return np.array([value for target in self.targets for value in target.place if value is not None], float)

    def places(self, z: np.ndarray, scale: float | np.ndarray = 1.0, turns: np.ndarray | None = None) -> np.ndarray:
        """z (n, K) -> (n, R) where the joints are along the axes asked for, of bodies as in ``performances``."""
        return self.asked(self.hands(z, scale, turns))

    def asked(self, places_m: np.ndarray) -> np.ndarray:
        """Places (n, G, 3) -> (n, R) of the axes that are asked for."""
        return places_m.reshape(len(places_m), -1)[:, self._rows]

    @cached_property
    def hands(self) -> HandPlaces:
        """Where the targets' joints are at the targets' marks."""
        return HandPlaces.of(self, self.targets)

    @cached_property
    def arms(self) -> Arms:
        """What brings decoded hands the last way."""
        block = self.scale.block("posture")
        near = self._trend.covariance(self.target_m)[block, block] + self.workforce.within.covariance[block, block]
        spread = self.scale.spread[block]
        return Arms(self.hands, tuple(self._rows), spread[:, None] * near * spread)

    @cached_property
    def whole_body(self) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
        """How coefficients of posture (P, R) and root (R0, R) follow hands, and how decoded hands go then (R, R)."""
        blocks = [self.scale.block(name) for name in ("posture", "root")]
        posture, root = (self.scale.spread[at, None] * self.moving[at] for at in blocks)
        n = len(self.target_m)
        tried = self.performances(np.broadcast_to(self.middle, (n + 1, len(self.middle))))
        moved = tuple(np.concatenate([np.zeros((1, len(way))), STEP_M * way.T]) for way in (posture, root))
        places_m = tried.places(tried.stood(moved))
        return (posture, root), (places_m[1:] - places_m[0]).T / STEP_M

    @cached_property
    def ways(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Coefficients (N, P + R0) of each recording's posture and root, and the squares that are least of the nearest.

        None where there are no recordings, or no feet. A metre that the root or a joint is away counts as if all bones
        were so far away throughout.
        """
        footing, known = self.footing, self.workforce.smoothed
        if footing is None or known is None or len(footing.postures) != len(known.scores):
            return None
        ways = np.concatenate([footing.postures, self.root_weight * self.scale.raw(known.scores, "root")], axis=1)
        away = self.root_weight**2 * self.n_times * np.sum((self._trend.place - self.target_m) ** 2, axis=1)
        return ways, away + np.sum(ways**2, axis=1)

    @property
    def root_weight(self) -> float:
        """What a coefficient of the root counts beside one of posture: it moves all bones."""
        return float(np.sqrt(self.skeleton.n_bones))

    @cached_property
    def _rows(self) -> list[int]:
        asked = [value for target in self.targets for value in target.place]
        return [i for i, value in enumerate(asked) if value is not None]

    @cached_property
    def _trend(self) -> Trend:
        """What the recordings tell of z by places: the same for all heights, so the free emulator keeps it."""
        known: dict[Any, Trend] = self.base.__dict__.setdefault("_trends", {})
        key = self.hands.joints, self.hands.marks, tuple(self._rows)
        if key not in known:
            z = recorded(self, None)
            known[key] = Trend.fit(self, z, self.places(z))
        return known[key]

    @cached_property
    def _laws(self) -> dict[Any, ReachedLaw]:
        return {}

    def _reached(self, effect: WorkerEffect | None) -> ReachedLaw:
        """Worked out once for a worker."""
        scale, turns = (1.0, None) if effect is None else (effect.scale, effect.turns)
        turned = None if turns is None else turns.tobytes()
        key = None if effect is None else (effect.z.tobytes(), effect.name, scale, effect.like, turned)
        if key not in self._laws:
            if len(self._laws) >= KEPT_LAWS:
                self._laws.pop(next(iter(self._laws)))
            with threadpool_limits(1, user_api="blas"):  # the last bits of a law depend on how many threads there are
                places = partial(self.places, scale=scale, turns=turns)
                self._laws[key] = reached_law(self, effect, places, self.target_m, self._trend)
        return self._laws[key]


@dataclass(frozen=True, eq=False)
class ReachPerformances(MotionPerformances):
    """n performances of a ``ReachEmulator``: posture coefficients are moved until the decoded joints are there.

    Durations and marks are those of the draw.
    """

    model: ReachEmulator

    def _grounded(self, kept: np.ndarray) -> Ground:
        """As ``MotionPerformances``, with bodies moved until the joints are at their targets within ``HIT_M``.

        Whole bodies, feet and all, where the way is long; then what the legs do not carry.
        """
        ground = self._near(kept)
        miss = self.model.target_m - self.places(ground)
        rows = np.flatnonzero(np.abs(miss).max(axis=1, initial=0.0) > HIT_M)
        if rows.size:
            some = self._some(rows)
            ground.upper[rows] += some._lifted(ground.control[rows], ground.upper[rows], miss[rows])
            ground.fastest_m_per_s[rows] = some._fastest_m_per_s(rows_of(ground, rows))
        return ground

    @cached_property
    def _centre(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The most likely movement brought to the targets in each draw's own bones and at its own marks, (n, ...)."""
        model, z = self.model, self.scores.copy()
        moving = np.zeros_like(model.moving)
        for name in ("posture", "root"):
            at = model.scale.block(name)
            z[:, at], moving[at] = model.middle[at], model.moving[at]

        def places(z: np.ndarray, rows: np.ndarray) -> np.ndarray:
            return model.places(z, self.body_scale[rows], self.turns[rows])

        z = on_target(places, z, moving, model.target_m)
        posture = model.scale.raw(z, "posture")
        return posture, model.scale.raw(z, "root"), model.decoder.control(posture)

    def _excess(self, ground: Ground) -> np.ndarray:
        """As ``MotionPerformances``; a body that misses its target by more than ``MISSED_M`` counts as much faster."""
        miss_m = np.linalg.norm(self.model.target_m - self.places(ground), axis=1)
        missed_m = np.maximum(miss_m - MISSED_M, 0.0)
        return np.asarray(np.maximum(super()._excess(ground), 0.0) + MISSED_PER_S * missed_m)

    def _lifted(self, control: np.ndarray, upper: np.ndarray, miss: np.ndarray) -> np.ndarray:
        """(n, P) by how much coefficients of upper bones change where hands are to come by ``miss`` (n, R)."""
        place = self.model.hands.clock(self.scores)
        yaw_rad = along(control, np.concatenate([np.zeros((len(self), 1)), place], axis=1))[..., 3]
        yaw_rad = yaw_rad[:, 1:] - yaw_rad[:, :1]
        return self.model.arms.lifted(upper, place, yaw_rad, self.bone_length_m, self.turns, miss)

    def _fastest_m_per_s(self, ground: Ground) -> np.ndarray:
        """(n,) the greatest speed of any joint of bodies that stand like this, between frames of 1/30 s."""
        if self.model.footing is None:  # as where nothing stands: no bound
            return np.zeros(len(self))
        time_s = self.model.warps(self.scores) * self.duration_s[:, None]
        bodies = self._standing(ground).positions_m(time_s)
        return np.array([fastest_of(body, own) for body, own in zip(bodies, time_s)])

    def _near(self, kept: np.ndarray) -> Ground:
        """As ``MotionPerformances``, with coefficients of posture and root moved until joints are within ``FAR_M``."""
        (posture, root), came = self.model.whole_body
        inverse = np.broadcast_to(_bounded_inverse(came), (len(self), *came.shape)).copy()
        at, share = np.zeros((len(self), len(came))), np.ones(len(self))
        ground = self._stood(kept)
        miss = self.model.target_m - self.places(ground)
        for _ in range(ROUNDS):
            rows = np.flatnonzero(np.linalg.norm(miss, axis=1) > FAR_M)
            if rows.size == 0:
                break
            step = share[rows, None] * _shortened(np.einsum("nij,nj->ni", inverse[rows], miss[rows]), miss[rows])
            tried = at[rows] + step
            some = self._some(rows)
            again = some._stood(kept[rows], (tried @ posture.T, tried @ root.T))
            missed = self.model.target_m - some.places(again)
            inverse[rows] = _broyden(inverse[rows], step, miss[rows] - missed)
            better = np.linalg.norm(missed, axis=1) < np.linalg.norm(miss[rows], axis=1)
            share[rows] = np.where(better, 1.0, 0.5 * share[rows])
            won = rows[better]
            at[won], miss[won] = tried[better], missed[better]
            put(ground, won, rows_of(again, better))
        return ground

    def _decoded(self, ground: Ground, place: np.ndarray, dtype: Floats) -> np.ndarray:
        directions = super()._decoded(ground, place, dtype)
        rows = np.flatnonzero(np.any(ground.posture != ground.upper, axis=1))
        if rows.size:
            lifted = self.model.decoder.directions(ground.upper[rows], place[rows], np.dtype(dtype))
            lifted = turned(lifted, self.turns[rows])
            bones = self.model.arms.bones
            directions[np.ix_(rows, np.arange(place.shape[1]), bones)] = lifted[:, :, bones]
        return directions

    def _stands_as(self, posture: np.ndarray, channel: np.ndarray) -> np.ndarray:
        """As recordings nearest in posture, in the way of the root and in where the joints are asked for.

        Else a body that steps would stand as somebody who did not, and its step would be taken back.
        """
        if self.model.ways is None:
            return super()._stands_as(posture, channel)
        known, square = self.model.ways
        own = np.concatenate([posture, self.model.root_weight * channel], axis=1)
        return np.asarray((square - 2.0 * own @ known.T).argmin(axis=1))

    def stood(self, moved: tuple[np.ndarray, ...]) -> Ground:
        """Bodies on the ground with coefficients of posture (n, P) and root (n, R0) moved."""
        return self._stood(np.ones(len(self)), moved)

    def places(self, ground: Ground) -> np.ndarray:
        """(n, R) where the joints are of bodies that stand like this."""
        return self.model.asked(self.model.hands.decoded(self._standing(ground)))

    def _standing(self, ground: Ground) -> ReachPerformances:
        """The same performances, standing like this."""
        standing = replace(self)
        standing.__dict__.update(_ground=ground, _drawn=self._drawn)
        return standing


def _bounded_inverse(came: np.ndarray) -> np.ndarray:
    """The inverse of (R, R), along no direction more than ``LONGEST``."""
    left, size, right = np.linalg.svd(came)
    return np.asarray(right.T @ np.diag(1.0 / np.maximum(size, 1.0 / LONGEST)) @ left.T)


def _shortened(step: np.ndarray, miss: np.ndarray) -> np.ndarray:
    """Steps (n, R) no longer than ``LONGEST`` times what is missed (n, R)."""
    far = np.linalg.norm(step, axis=1) / np.maximum(LONGEST * np.linalg.norm(miss, axis=1), 1e-12)
    return np.asarray(step / np.maximum(far, 1.0)[:, None])


def _broyden(inverse: np.ndarray, step: np.ndarray, came: np.ndarray) -> np.ndarray:
    """Inverse derivatives (n, R, R) after steps (n, R) by which the hands came so far (n, R).

    Source: Broyden (1965), his good update by Sherman & Morrison.
    """
    foretold = np.einsum("nij,nj->ni", inverse, came)
    size = np.einsum("ni,ni->n", step, foretold)
    safe = np.where(np.abs(size) > 1e-12, size, np.inf)
    row = np.einsum("ni,nij->nj", step, inverse)
    return np.asarray(inverse + (step - foretold)[:, :, None] * row[:, None] / safe[:, None, None])
