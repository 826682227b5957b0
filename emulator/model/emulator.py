"""MotionEmulator: one joint model of posture, pace and duration of a task, fitted to recordings, sampled backwards."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.model.conditioning import CONDITIONS, given
from emulator.model.joint_law import JointLaw
from emulator.model.performances import MotionPerformances
from emulator.motion import MotionSet
from emulator.people.bone_turns import LazyArray
from emulator.people.workers import WorkerEffect

if TYPE_CHECKING:
    from emulator.model.recorded_reach import Reach
    from emulator.model.targets import Target

SCHEME = "Extrinsic/JointPCA/Smoothed"
SCHEMES = (SCHEME, "SIEM/JointPCA/Smoothed", "SIEM/JointPCA/MVG")


@dataclass(frozen=True, eq=False)
class MotionEmulator(JointLaw):
    """A task's model, see ``JointLaw``: fitted to recordings, sampled, saved."""

    @classmethod
    def fit(
        cls,
        motions: MotionSet,
        *,
        scheme: str = SCHEME,
        n_components: int | float | None = None,
        n_times: int | None = None,
        n_knots: int = 20,
        landmarks: float = 0.0,
        penalty: float | None = None,
        covariates: Sequence[str] = (),
        progress: Callable[[int, int, str], None] | None = None,
        seed: int = 0,
        command: str = "",
    ) -> MotionEmulator:
        """Align, flatten, reduce and model the repetitions of one task.

        scheme       : one of SCHEMES, or "auto": see ``fitting.scheme_choice``
        n_components : posture components: a number, a share of variance, or None: all above 0.1 degrees a bone
        landmarks    : strength that brings marks together in the registration (``geometry.elastic``; 0.01 is strong)
        n_times      : points of the common clock, or None: as many as such recordings have frames at up to 60 Hz,
                       101 to 301; n_knots : cells of the pace, 2 to n_times - 1
        penalty      : weight that holds warps near the identity (see ``geometry``); None: as recordings that are given
                       each other's pace ask for, 0: free, as in the paper
        covariates   : recorded columns (``cov_NAME``) that explain how people differ beside height, mass, age, sex and
                       pace, which always do where the recordings have them; ``new_worker`` then takes them by name
        progress     : called with (done, total, label); seed decides nothing but the figures of the report
        Raises ValueError for an unknown scheme, fewer than three repetitions, settings out of range, or a covariate
        that is not there or can tell nothing.
        """
        from emulator.fitting.fit import fit
        from emulator.fitting.settings import FitSettings

        settings = (scheme, n_components, n_times, n_knots, landmarks, seed, command, penalty, tuple(covariates))
        return fit(motions, FitSettings(*settings), progress)

    def sample(
        self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None
    ) -> MotionPerformances:
        """n performances in one joint draw (see ``law``): within-worker numbers first, then the between-worker ones.

        worker    : an effect of ``draw_worker`` or ``known_worker``, a known worker's name, or None: each performance
                    by another worker of the population
        condition : None, or {"duration_s": x} (number or (n,)): the conditional law of z given the duration;
                    {"log_duration_shift": d}: the same noise, log duration moved by d, posture after it by regression;
                    {"pace": 1.1}: the same as a shift by -log 1.1
        Raises ValueError for an unknown worker or condition.
        """
        if n < 0:
            raise ValueError(f"{self.task}: found n = {n}, expected a number of performances from 0")
        effect = self._effect(worker)
        law = self.law(effect)
        z = given(self, law, n, rng, effect, condition) if condition else law.sample(n, rng)
        if effect is not None:
            return self.performances(z, effect.scale, effect.turns)
        return self.performances(z, turns=self.workforce.turns(n, self.skeleton, rng))

    def performances(
        self, scores: np.ndarray, body_scale: float | np.ndarray = 1.0, turns: np.ndarray | LazyArray | None = None
    ) -> MotionPerformances:
        """The performances with these joint coordinates (n, K): durations at once, marks and postures on demand.

        body_scale : factor on every bone; turns : (B, 3) or (n, B, 3) by which bones are turned, see ``WorkerEffect``
        """
        duration_s = self.whole_s(scores)
        scale = np.empty(duration_s.shape)
        scale[...] = body_scale  # NOTE: np.full takes three times as long, for a block a twentieth of its draw
        if not isinstance(turns, LazyArray):
            turns = np.zeros((0, 3)) if turns is None else turns
            turns = np.broadcast_to(turns, (len(scores), *turns.shape[-2:]))
        return MotionPerformances(self, scores, duration_s, scale, turns)

    def mean_duration_s(self, worker: Any = None) -> float:
        """Mean duration in seconds of the model: of a worker with this effect, or over the population."""
        return self.moments_s(self._effect(worker))[0]

    def duration_cv(self, worker: Any = None) -> float:
        """Coefficient of variation of the model's duration, of one worker or over the population."""
        mean_s, spread_s = self.moments_s(self._effect(worker))
        return spread_s / mean_s

    def given(self, targets: Target | Sequence[Target]) -> MotionEmulator:
        """An emulator of the same task whose joints are at ``targets`` at the marks that these name.

        Each draw keeps its own noise and what the targets do not decide; times and marks follow. Worked out once for a
        worker, when the worker is first asked for. How far a target is from what was recorded: ``reach``.
        Raises ValueError, with all mistakes, for a joint or a mark that is not there, a task without marks, the same
        joint and mark twice, or a height above anybody's reach.
        """
        from emulator.model.reach_emulator import given_targets

        return given_targets(self, targets)

    def reach(self, joint: str, mark: str | int) -> Reach:
        """Where a joint (or "hands") was at a mark in the recordings, and how far targets are from there.

        Raises ValueError for a joint or a mark that is not there, or a task without marks.
        """
        from emulator.model.recorded_reach import Reach

        return Reach.of(self, joint, mark)

    @property
    def between_share(self) -> float:
        """Share of the variance of the duration coordinate (log moving duration) that lies between workers."""
        at = self.scale.block("duration").start
        between, within = self.workforce.between.spread[at] ** 2, self.workforce.within.spread[at] ** 2
        return float(between / (between + within)) if between + within > 0 else 0.0

    @property
    def workers(self) -> tuple[str, ...]:
        """The workers seen in training."""
        return self.workforce.names

    def known_worker(self, name: str) -> WorkerEffect:
        """The effect of a worker seen in training, shrunk by its reliability. Raises ValueError for an unknown name."""
        if name not in self.workers:
            near = get_close_matches(str(name), self.workers, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.workers)}"
            raise ValueError(f"{self.task}: no worker {name!r}; {hint}")
        return WorkerEffect(self.workforce.effects[self.workers.index(name)], name)

    def draw_worker(
        self,
        rng: np.random.Generator,
        body: Any = None,
        people: Callable[[str], float] | None = None,
        slowness: float | None = None,
    ) -> WorkerEffect | None:
        """A worker of the population, or None if the recordings were of one person and nothing is known of a body.

        body   : None, or something with any of ``body_keys`` (attributes or keys). height_m scales the bones, by the
                 chain ankle to head plus 0.20 m; pace 1.1 is a tenth faster than the typical worker's moving time, with
                 the posture that goes with it; height, mass, age and sex move the mean where ``covariates`` explain it;
                 person is a recorded one: that worker, if this task has him, at ``pace`` times his own
        people : a standard normal number for the name of each recorded person: the worker's leaning to him. The same
                 numbers in two tasks of the same people give effects correlated as those people's are
        slowness : how far the worker's log moving time is from the typical one, in standard deviations between workers;
                 the rest follows by regression. None: by luck. A pace that is asked for goes before it
        Raises BodyError for a body that cannot be.
        """
        from emulator.people.new_people import drawn_worker

        return drawn_worker(self, rng, body, people, slowness)

    def new_worker(
        self,
        rng: np.random.Generator | None = None,
        *,
        people: Callable[[str], float] | None = None,
        outside: str = "clamp",
        **body: Any,
    ) -> WorkerEffect:
        """A worker with this body: ``new_worker(height_m=1.62, mass_kg=58, age_years=41, sex="f", pace=1.1)``.

        rng     : draws what the body does not say; None: the typical person with this body
        body    : as for ``draw_worker``; person="s03" is that recorded one, an unknown one is refused
        outside : "clamp" or "refuse" a body outside those of the recordings; what was done is in ``effect.said``
        Raises BodyError (a ValueError) with all mistakes at once.
        """
        from emulator.people.new_people import new_worker

        return new_worker(self, rng, body, people, outside)

    @property
    def knows_people(self) -> bool:
        """``draw_worker`` takes ``people``."""
        return True

    @property
    def knows_slowness(self) -> bool:
        """``draw_worker`` takes ``slowness``."""
        return True

    conditions = CONDITIONS
    """What ``sample`` may be asked for."""

    @property
    def body_keys(self) -> tuple[str, ...]:
        """What ``draw_worker`` reads of a body here: mass, age and sex only where the recordings explain by them."""
        from emulator.people.new_people import body_keys

        return body_keys(self)

    def _repr_html_(self) -> str:
        from emulator.notebook import emulator_html

        return emulator_html(self)

    def save(self, path: str | Path) -> None:
        """Write a library of this one task."""
        from emulator.model.library import MotionLibrary

        MotionLibrary.of(self).save(path)

    @staticmethod
    def load(path: str | Path) -> MotionEmulator:
        """Read the one task of a library. Raises LibraryError for a broken file or one with several tasks."""
        from emulator.model.library import MotionLibrary

        return MotionLibrary.load(path).only()

    def _effect(self, worker: Any) -> WorkerEffect | None:
        effect = self.known_worker(worker) if isinstance(worker, str) else worker
        if effect is not None and np.shape(getattr(effect, "z", 0.0)) != self.scale.centre.shape:
            raise ValueError(f"{self.task}: this worker's effect was not drawn from this emulator")
        return effect
