"""Who performs: between-worker and within-worker parts of the joint coordinates, z = u_worker + e.

What the bodies of the recorded people tell of how they move, and what a body leaves open.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from emulator.covariates.body import Body
from emulator.covariates.model import CovariateModel, level_shares, logged
from emulator.model.gaussian import Law, LowRankNormal
from emulator.model.joint_coordinates import within_worker
from emulator.model.smoothed import SmoothedScores
from emulator.people.bone_turns import LazyArray, StreamPosition
from emulator.people.kinds import Kinds
from emulator.people.population import Population
from emulator.people.variance_components import anova
from emulator.skeleton import Skeleton

BETWEEN_METHOD = (
    "variances by ANOVA (a negative one is 0); correlations of people's means, shrunk to 0 by rho = {rho}; "
    "a known worker's mean is shrunk coordinate by coordinate by its reliability"
)


def shrinkages(n_sequences: int, n_workers: int) -> tuple[float, float]:
    """rho of the correlations between workers and within: 1.2 / W and 4 / (N - W), at most 0.2 and 0.1.

    Largest for few people, gone for many: a fixed rho would weaken the bond of posture and duration for ever.
    """
    return min(0.2, 1.2 / n_workers), min(0.1, 4.0 / max(n_sequences - n_workers, 1))


@dataclass(frozen=True)
class WorkerEffect:
    """What makes one worker this worker: z (K,) joint coordinates, and the worker's name (empty if drawn).

    scale : multiplies every bone length; it is 1 unless a body height was asked for
    said  : what was done with a body that was asked for, in words
    like  : the recorded person whose repetitions the worker's vary like; empty: like anybody's
    turns : (B, 3) rotation vectors, radians, by which bones are turned throughout; None: as z has them
    """

    z: np.ndarray
    name: str = ""
    scale: float = 1.0
    said: tuple[str, ...] = ()
    like: str = ""
    turns: np.ndarray | None = None


@dataclass(frozen=True)
class Workforce:
    """Between-worker Gaussian of u, within-worker Gaussian of e, and the people seen in training.

    between, within : LowRankNormal over K coordinates (within has mean 0), between of people of one kind. Every density
        keeps their covariances, by which a pace, a duration or a place that is asked for moves z
    names : W worker names; effects : (W, K) their shrunk means; doubt : (W, K) standard deviations about these
    kinds : on which sides they do it
    smoothed : the repetitions themselves, blurred, in place of the Gaussian ``within``; None for plain Gaussians
    group : whose names these are: two tasks of one group were done by the same people where names agree
    told : what bodies say of z, or None
    population : how new people differ; None: by the Gaussian ``between``
    """

    between: LowRankNormal
    within: LowRankNormal
    names: tuple[str, ...]
    effects: np.ndarray
    doubt: np.ndarray
    kinds: Kinds
    smoothed: SmoothedScores | None = None
    group: str = ""
    told: Told | None = None
    population: Population | None = None

    @classmethod
    def fit(
        cls,
        z: np.ndarray,
        worker_index: np.ndarray,
        names: tuple[str, ...],
        rho_between: float,
        rho_within: float,
        told: Told | None = None,
        kinds: Kinds | None = None,
    ) -> Workforce:
        """Moment (ANOVA) estimates from z (N, K) and worker_index (N,) into ``names`` (each with a repetition).

        told : what bodies say of the workers' means; a known worker is then drawn towards those of such a body
        kinds : of the workers: a known one is then drawn towards the mean of that kind; None: all are of one
        """
        kinds = Kinds.one(len(names), z.shape[1]) if kinds is None else kinds
        z = z - kinds.shift[worker_index]
        if told is not None:
            told = replace(told, fitted=told.fitted - kinds.shifts(told.fitted))
        parts = anova(z, worker_index, kinds.df_lost)
        means = np.stack([z[worker_index == w].mean(axis=0) for w in range(len(names))])
        centre = means.mean(axis=0)
        residual_df = max(len(z) - len(names), 1)
        within = LowRankNormal.of_rows(
            np.zeros(z.shape[1]), within_worker(z, worker_index) / np.sqrt(residual_df), rho_within
        )
        between = LowRankNormal.of_rows(centre, _between_rows(means - centre, parts.between), rho_between)
        foretold, left = (centre, np.ones(z.shape[1])) if told is None else (centre + told.fitted, told.left)
        sure = parts.reliability(np.bincount(worker_index), left**2)
        doubt = np.sqrt(parts.between * left**2 * (1.0 - sure))
        luck = np.sqrt(parts.within_square / np.bincount(worker_index)[:, None])
        doubt = np.where(kinds.alone[:, None] & kinds.differ, luck, doubt)
        effects = foretold + sure * (means - foretold) + kinds.shift
        return cls(between, within, names, effects, doubt, kinds, told=told)

    @property
    def has_worker_effect(self) -> bool:
        return len(self.names) > 1

    def law(self, effect: WorkerEffect | None) -> Law:
        """The law of z of the worker with this effect, or (None) of a new worker each time."""
        if effect is None and self._anybody is not None:
            return self._anybody
        people = self.between if effect is None else None
        mean = np.zeros_like(self.between.mean) if effect is None else effect.z
        if self.smoothed is None:
            return Law(np.ones(1), np.zeros((1, len(mean))), np.ones(1), self.within, mean, people)
        if effect is None or effect.name not in self.names:
            like = self.names.index(effect.like) if effect is not None and effect.like in self.names else None
            law = self.smoothed.anyone(mean, like)
            return law if people is None else replace(law, people=people)
        number = self.names.index(effect.name)
        known = self._known_laws[number]
        moved = effect.z - self.effects[number]
        return known if not moved.any() else replace(known, centre=known.centre + moved)

    @cached_property
    def _anybody(self) -> Law | None:
        """The law of a new person each time, where it is more than the Gaussian between."""
        if self.population is None or self.smoothed is None:
            return None
        rows, sizes = self.population.rows, self.population.sizes
        people = LowRankNormal(self.between.mean, rows, np.linalg.norm(rows, axis=0), 0.0)
        own = self.population.deviations(self.apart()) + self.kinds.shift
        return self.smoothed.population(people, own, sizes)

    @cached_property
    def from_kind(self) -> np.ndarray:
        """(W, K) how the known workers differ from the means of their kinds."""
        return self.effects - self.effects.mean(axis=0) - self.kinds.shift

    def apart(self, body: Body | None = None) -> np.ndarray:
        """(W, K) how recorded people deviate from the means of their kinds, with the variance between people.

        Less what a body tells, if it is heard of. Their means deviate by more, with repetitions' luck in them, and
        their shrunk means by less; who is alone of a kind does not deviate.
        """
        own, spread = self.from_kind, self.between.spread
        if body is not None and self.told is not None and self.told.hears(body):
            own, spread = own - self.told.fitted, spread * self.told.left
        return np.sqrt(self.kinds.n_not_alone) * _between_rows(own, spread**2)

    def somebody(
        self, law: LowRankNormal, body: Body, rng: np.random.Generator, numbers: np.ndarray | None
    ) -> tuple[np.ndarray, str]:
        """A new person's mean z (K,), and the recorded person he is like.

        law     : of people with this body, see ``about``
        numbers : (W,) standard normal, how he leans to each recorded person; None: by luck
        """
        if self.population is None or self.smoothed is None:
            return self._by_gaussian(law, rng, numbers), ""
        heard = law is not self.between
        rows, left = self.population.rows, np.ones(1)
        if heard:
            assert self.told is not None
            left = self.told.left
            rows = np.concatenate([rows * left, self.told.unsure_rows(body)])
        at = int(rng.integers(self.population.sizes.size))
        like = int(rng.integers(len(self.names)))
        xi = rng.standard_normal(len(rows))
        if numbers is not None:
            like = int(np.abs(numbers).argmax())
            xi[: len(numbers)] = numbers
        own = self.population.deviations(self.apart(body), left)[at, like]
        own = own + self.kinds.shift[like]
        return law.mean + own + self.population.sizes[at] * (xi @ rows), self.names[like]

    def turns(
        self, n: int, skeleton: Skeleton, rng: np.random.Generator, numbers: np.ndarray | None = None
    ) -> LazyArray | None:
        """(n, B, 3) by how much bones of new people are turned, see ``BoneTurns``; None where none is.

        rng     : is not moved on: the seed is what it draws next
        numbers : (W,) leanings of one person, who is then turned alike wherever these are the same
        """
        law = self.population
        if law is None or not law.turns.spread_rad > 0:
            return None
        seed = StreamPosition.of(rng) if numbers is None else np.ascontiguousarray(numbers).view(np.uint64)
        return LazyArray(partial(law.turns.drawn, n, law.sizes, skeleton, seed))

    def _by_gaussian(self, law: LowRankNormal, rng: np.random.Generator, numbers: np.ndarray | None) -> np.ndarray:
        if numbers is None:
            return law.sample(1, rng)[0]
        more = len(law.factor) - len(numbers)
        xi = numbers @ self.by_person if law is self.between else np.append(numbers, rng.standard_normal(more))
        return law.of(xi, rng)

    @cached_property
    def by_person(self) -> np.ndarray:
        """(W, R) orthonormal columns: rows of ``by_person @ between.factor`` are the people, as far as they differ.

        So numbers (W,) of a new worker, one for each recorded person, draw the same law as numbers (R,) do. It is the
        polar factor that comes nearest to the people's own deviations (Schoenemann 1966).
        """
        u, _, vt = np.linalg.svd(self.from_kind @ self.between.factor.T, full_matrices=False)
        return np.asarray(u @ vt)

    @property
    def telling(self) -> tuple[str, ...]:
        """What of a body tells how somebody moves here: the names of covariates, and of the category."""
        return () if self.told is None else self.told.model.telling

    def about(self, body: Body, outside: str = "clamp") -> LowRankNormal:
        """How new workers with this body differ: the mean that it tells, and what it leaves, known in part as it is.

        Rows of the factor: first the W recorded people, as far as their bodies do not tell them apart; then what the
        unknown of the body leaves open. ``between`` itself for a body that tells nothing.
        """
        if self.told is None or not self.told.hears(body):
            return self.between
        own = self.from_kind - self.told.fitted
        people = _between_rows(own, (self.between.spread * self.told.left) ** 2)
        rows = np.concatenate([people, self.told.unsure_rows(body)])
        mean = self.between.mean + self.told.model.predict(body, outside)
        return LowRankNormal(mean, rows, np.linalg.norm(rows, axis=0), self.between.rho)

    @cached_property
    def _known_laws(self) -> tuple[Law, ...]:
        assert self.smoothed is not None
        return tuple(self.smoothed.known(w, effect) for w, effect in enumerate(self.effects))


def _between_rows(deviations: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Rows (W, K) whose product has the given variances (K,) and the correlations of the people's means."""
    if len(deviations) < 2:
        return np.zeros_like(deviations)
    spread = np.sqrt(np.sum(deviations**2, axis=0))
    return deviations * np.where(spread > 0, np.sqrt(variance) / np.where(spread > 0, spread, 1.0), 0.0)


@dataclass(frozen=True, eq=False)
class Told:
    """model : of people's mean joint coordinates by their bodies, its r2 (K,) with the choice of scores left out, too

    fitted : (W, K) what it says of the recorded people: shifts of their means from the mean of all
    """

    model: CovariateModel
    fitted: np.ndarray

    @property
    def left(self) -> np.ndarray:
        """(K,) share of the between-worker standard deviation that a fully known body leaves."""
        return np.asarray(np.sqrt(1.0 - np.clip(self.model.r2, 0.0, 1.0)))

    def hears(self, body: Body) -> bool:
        """Whether anything is known of a body that tells something."""
        known = set(body.known) | ({self.model.category} if body.sex in self.model.levels else set())
        return bool(known & set(self.model.telling))

    def unsure_rows(self, body: Body) -> np.ndarray:
        """(V, K) rows whose product is the covariance that the unknown covariates of a body leave in its shift."""
        known = body.known
        asked = np.array([[known.get(name, np.nan) for name in self.model.names]])
        sex = body.sex if body.sex in self.model.levels else None
        values = np.concatenate([logged(self.model.names, asked), level_shares([sex], self.model.levels)], axis=1)[0]
        size, axes = np.linalg.eigh(self.model.gaussian.unsure(np.isnan(values)))
        effect = self.model.level_effect
        steps = np.concatenate([self.model.slope, effect[1:] - effect[:1]]) if len(effect) else self.model.slope
        return np.asarray(np.sqrt(np.maximum(size, 0.0))[:, None] * axes.T @ steps)
