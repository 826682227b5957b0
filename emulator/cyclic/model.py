"""CyclicEmulator: motion that goes on and on (walking, hammering, cranking), of any length, on planted feet.

Source: Remillard & Kry (2010): latents by principal components, switching Gaussian process dynamics with a classifier
of the contact state. Beyond the paper: the length of a step is a known input of the dynamics, so that postures follow;
beats are set before postures (how many, how long, how far), so that times cost nothing and ways end where they shall;
the drawn latents are laid on those beats, and feet are planted on the footprints by inverse kinematics.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.cyclic.law import CyclicLaw
from emulator.cyclic.pace import Asked, itinerary, scatter
from emulator.cyclic.performances import CONDITIONS, CyclicPerformances, asked_of
from emulator.cyclic.units import CyclicWorker

if TYPE_CHECKING:
    from emulator.recordings.take import Recording

_CROWN_AND_SOLE_M = 0.20
_CHAIN = ("left_ankle", "left_knee", "spine", "chest", "neck", "head")


@dataclass(frozen=True, eq=False)
class CyclicEmulator(CyclicLaw):
    """A task's model, see ``CyclicLaw``: fitted to takes, sampled, saved."""

    mark_names = ()
    body_keys = ("height_m", "pace", "person")
    conditions = CONDITIONS

    @classmethod
    def fit(cls, recording: Recording, *, task: str = "walk", **settings: Any) -> CyclicEmulator:
        """Learn from takes: see ``emulator.cyclic.fitting.fit`` for the settings. Raises ValueError in plain words."""
        from emulator.cyclic.fitting import fit

        return fit(recording, task=task, **settings)

    def sample(
        self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None
    ) -> CyclicPerformances:
        """n performances: beats and durations at once, postures on demand.

        worker    : an effect of ``draw_worker``, a recorded worker's name, or None: each by another new worker
        condition : one of {"distance_m": 3.0}, {"cycles": 4}, {"length_s": 5.0}, numbers or (n,); None: as long as a
                    recorded one. Of a walk besides "speed_m_per_s" (0.3 to 2.5), the mean over the whole way; distance
                    and length_s together say it, too. "pace" and "log_duration_shift" make it faster or slower, as a
                    worker's own pace does, but nobody walks slower than 0.3 m/s or faster than 2.5 m/s thereby.
        The mean duration is distance over speed, as long as no step would take less than ``SHORTEST_STEP_S``; length_s
        is met exactly. A cycle of walking is two steps.
        Raises ValueError for an unknown worker or condition, and for a "speed_m_per_s" at which nobody walks.
        """
        if n < 0:
            raise ValueError(f"{self.task}: found n = {n}, expected a number of performances from 0")
        who = self._who(worker, n, rng)
        leg_m = self.channel.leg_m(who.bone_length_m)
        asked = asked_of(self, condition, n, leg_m, who)
        first_foot, seed = rng.integers(0, 2, n), rng.integers(1, 2**62, n)
        return self._drawn(who, asked, leg_m, first_foot, seed)

    def mean_performance(self, worker: Any = None, condition: Any = None) -> CyclicPerformances:
        """One performance (a block of one) without any scatter, by a worker or the typical one: what the means say."""
        one = self._typical(worker)
        who = CyclicWorker(one.z[None], np.atleast_1d(one.log_step), one.bone_length_m[None], one.name, one.pace)
        leg_m = self.channel.leg_m(who.bone_length_m)
        asked = asked_of(self, condition, 1, leg_m, who)
        return self._drawn(who, asked, leg_m, np.zeros(1, int), np.zeros(1, int))

    def typical(self) -> CyclicPerformances:
        """The mean performance of the typical worker."""
        return self.mean_performance()

    def dwell_s(self, scores: np.ndarray) -> np.ndarray:
        """(n, 0): no pauses are told apart."""
        return np.empty((len(scores), 0))

    def mean_duration_s(self, worker: Any = None, condition: Any = None) -> float:
        """Mean seconds of the condition (None: as long as a recorded one) for a worker, or for the typical one."""
        one = self._typical(worker)
        who = CyclicWorker(one.z[None], np.atleast_1d(one.log_step), one.bone_length_m[None], one.name, one.pace)
        leg_m = self.channel.leg_m(who.bone_length_m)
        asked = asked_of(self, condition, 1, leg_m, who)
        return float(itinerary(self.pace, asked, leg_m, who.log_step).duration_s[0])

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **_others: Any) -> CyclicWorker:
        """A new worker, or, if ``person`` names one, the recorded one; ``height_m`` scales bones, ``pace`` speed.

        body : None, or something with any of ``body_keys``, as attributes or keys
        """
        known = {name: _said(body, name) for name in self.body_keys}
        if known["person"] in self.crew.names:
            one = self.crew.known(self.task, str(known["person"]))
        else:
            drawn = self.crew.drawn(1, rng)
            one = CyclicWorker(drawn.z[0], drawn.log_step[0], drawn.bone_length_m[0])
        scale = 1.0 if known["height_m"] is None else self._scale(one.bone_length_m, float(known["height_m"]))
        pace = 1.0 if known["pace"] is None else float(known["pace"])
        return CyclicWorker(one.z, one.log_step, one.bone_length_m * scale, one.name, pace)

    def known_worker(self, name: str) -> CyclicWorker:
        """The effect of a recorded worker. Raises ValueError for an unknown name."""
        return self.crew.known(self.task, name)

    def given(self, _targets: Any) -> CyclicEmulator:
        """Raises ValueError: cycles have no marks, so there is no moment at which a joint could be somewhere."""
        raise ValueError(
            f"{self.task}: motion of cycles has no marks at which a joint could be at a target; ask it for distance_m, "
            "cycles or length_s, or fit repetitions with a mark without --cyclic and ask that emulator"
        )

    @property
    def workers(self) -> tuple[str, ...]:
        return self.crew.names

    def _repr_html_(self) -> str:
        from emulator.notebook import emulator_html

        return emulator_html(self)

    def save(self, path: str | Path) -> None:
        """Write a library of this one task."""
        from emulator.model.library import MotionLibrary

        MotionLibrary.of(self).save(path)

    def _who(self, worker: Any, n: int, rng: np.random.Generator) -> CyclicWorker:
        """The worker of each of n performances, every array with n rows."""
        if worker is None:
            return self.crew.drawn(n, rng)
        one = self._typical(worker)
        return CyclicWorker(
            np.broadcast_to(one.z, (n, len(one.z))),
            np.full(n, float(one.log_step)),
            np.broadcast_to(one.bone_length_m, (n, self.skeleton.n_bones)),
            one.name,
            one.pace,
        )

    def _typical(self, worker: Any) -> CyclicWorker:
        one = self.crew.typical if worker is None else worker
        one = self.known_worker(one) if isinstance(one, str) else one
        if not isinstance(one, CyclicWorker) or np.shape(one.z) != (self.latent.n_components,):
            raise ValueError(f"{self.task}: this worker's effect was not drawn from this emulator")
        return one

    def _scale(self, bone_length_m: np.ndarray, height_m: float) -> float:
        length = dict(zip(self.skeleton.bone_names, bone_length_m.tolist()))
        if not set(_CHAIN) <= set(length):
            return 1.0
        return (height_m - _CROWN_AND_SOLE_M) / sum(length[name] for name in _CHAIN)

    def _drawn(
        self, who: CyclicWorker, asked: Asked, leg_m: np.ndarray, first_foot: np.ndarray, seed: np.ndarray
    ) -> CyclicPerformances:
        """Beats of every performance: each from its own seed, so a row alone is the row of the block; 0: no scatter."""
        n, plan = len(leg_m), itinerary(self.pace, asked, leg_m, who.log_step)
        most = int(plan.n_beats.max()) if n else 0
        beat_s, place_m, duration_s = np.full((n, most), np.nan), np.full((n, most), np.nan), plan.duration_s.copy()
        for i in range(n):
            count = int(plan.n_beats[i])
            own = np.random.default_rng(int(seed[i])) if seed[i] else None
            beat_s[i, :count], place_m[i, :count], duration_s[i] = self._beats(plan, i, own)
        wide = np.log(np.maximum(plan.step_m, 1e-9) / leg_m)
        control = (np.clip(wide, self.pace.low, self.pace.high) - self.control_at) / self.control_by
        control = control if self.pace.steps else np.zeros(n)
        scores = np.column_stack([who.z, who.log_step, first_foot, control])
        if not self.pace.steps:
            place_m[:] = np.nan
        return CyclicPerformances(
            self, duration_s, scores, beat_s, place_m, control, who.z, who.bone_length_m, first_foot, seed
        )

    def _beats(self, plan: Any, i: int, rng: np.random.Generator | None) -> tuple[np.ndarray, np.ndarray, float]:
        """Times (B,) of the beats, places (B,) along the way, and the duration of performance i."""
        pace, count, mean_s = self.pace, int(plan.n_beats[i]), float(plan.beat_s[i])
        start, stop = (pace.start_beats, pace.stop_beats)
        weight = np.concatenate([[start], np.ones(count - 1), [stop]])
        step = np.ones(count)
        step[0] = pace.first
        if rng is not None:
            weight = weight * scatter(count + 1, pace.time_cv, pace.follows, rng)
            step = step * scatter(count, pace.length_cv, 0.0, rng)
        if plan.exact[i]:
            weight = weight * (start + count - 1 + stop) / weight.sum()
        ends = np.cumsum(mean_s * weight)
        if pace.before_first:
            step[0] = 0.5
        place, gone = np.cumsum(step), count - pace.before_first + pace.halves
        place = place * (plan.step_m[i] * gone / max(float(pace.gone_m(place[None])[0]), 1e-12))
        return ends[:-1], place, float(ends[-1])


def _said(body: Any, name: str) -> Any:
    return body.get(name) if isinstance(body, Mapping) else getattr(body, name, None)


Progress = Callable[[int, int, str], None] | None
