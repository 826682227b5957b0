"""Emulators fitted to made tasks whose truth is known, and fresh truth to judge their draws by."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from emulator.geometry import sphere
from emulator.model.emulator import SCHEME, SCHEMES, MotionEmulator
from emulator.model.joint_coordinates import BLOCKS, within_worker
from emulator.synthetic import tasks as synthetic
from emulator.synthetic.choreography import TASKS


@dataclass(frozen=True)
class Crew:
    """How the training repetitions were made; ``share`` of the variance between workers, correlations with duration."""

    task: str
    seed: int
    n_workers: int = 20
    n_each: int = 3
    share: float = 0.5
    correlation: float = 0.6
    pace: float = 0.0

    @property
    def told(self):
        """How many performances by as many different people would tell the mean as well as these do."""
        return 1 / (self.share / self.n_workers + (1 - self.share) / (self.n_workers * self.n_each))


@cache
def trained(crew):
    """(motions, truth, emulator) of a crew."""
    motions, truth = synthetic.make(
        crew.task,
        crew.n_workers,
        crew.n_each,
        seed=crew.seed,
        between_share=crew.share,
        correlation=crew.correlation,
        pace_correlation=crew.pace,
    )
    return motions, truth, MotionEmulator.fit(motions)


def emulator_of(crew, scheme):
    """The emulator of a crew; with one Gaussian it is the same but for the density."""
    emulator = trained(crew)[2]
    return emulator if scheme == SCHEME else replace(emulator, workforce=replace(emulator.workforce, smoothed=None))


BOTH = (SCHEME, SCHEMES[-1])


@cache
def fresh(crew, n=2000):
    """The truth of n performances, each by somebody never seen, without their postures."""
    rng, dance = np.random.default_rng([crew.seed, 1]), TASKS[crew.task]
    z = synthetic._two_level(rng, np.arange(n), synthetic.N_LATENTS + 4, crew.share)
    clock = np.array(dance.mark_clock) + synthetic.MARK_SPREAD * rng.standard_normal((n, len(dance.mark_clock)))
    return synthetic._truth(dance, z, clock, np.arange(n), crew.share, crew.correlation, crew.pace)


def drawn(emulator, n=2000, seed=0):
    return emulator.sample(n, np.random.default_rng(seed))


def apart(performances, seed=0):
    """The same draws with posture, root, pace, duration, marks and bones each taken from another of them."""
    rng, model, z = np.random.default_rng(seed), performances.model, performances.scores.copy()
    for name in BLOCKS:
        at = model.scale.block(name)
        z[:, at] = z[rng.permutation(len(z)), at]
    return model.performances(z)


def times_s(some):
    """(n, 1 + E) durations and mark times of motions, performances or a truth."""
    duration_s = np.exp(some.log_duration) if hasattr(some, "log_duration") else some.duration_s
    return np.column_stack([duration_s, some.mark_s])


def sub_tasks_s(some):
    """(n, E + 1) seconds from mark to mark, from the start to the end."""
    times = times_s(some)
    return np.diff(np.column_stack([np.zeros(len(times)), times[:, 1:], times[:, 0]]), axis=1)


def first_and_rest(some):
    """Correlation of the logs of the time up to the first mark and of the time after it."""
    first, whole = sub_tasks_s(some)[:, 0], times_s(some)[:, 0]
    return np.corrcoef(np.log(first), np.log(whole - first))[0, 1]


def distances(one, other):
    """Kolmogorov-Smirnov distances (C,) of the columns of (n, C) and (m, C)."""
    from scipy.stats import ks_2samp

    return np.array([ks_2samp(a, b).statistic for a, b in zip(one.T, other.T)])


def p_of_n(distance, n):
    """How often n true numbers lie this far from the truth.

    An emulator that learned from n repetitions cannot know more than they tell, however many draws it gives: with
    2,000 draws against 2,000 true ones the test would refuse the n recordings themselves.
    """
    from scipy.stats import kstwo

    return kstwo.sf(distance, round(n))


def latent_of(crew):
    """Posture scores (n, K) -> the first posture latent (n,), by regression on the training repetitions' truth."""
    _, truth, emulator = trained(crew)
    at = emulator.scale.block("posture")
    z = emulator.workforce.smoothed.scores[:, at][:, :8]
    slope = np.linalg.lstsq(np.column_stack([np.ones(len(z)), z]), truth.latents[:, 0], rcond=None)[0]
    return lambda scores: slope[0] + scores[:, at][:, :8] @ slope[1:]


def people(emulator, n_workers=300, n_each=60, seed=0):
    """(performances, worker (n,)) of drawn workers."""
    rng = np.random.default_rng(seed)
    scores = [emulator.sample(n_each, rng, worker=emulator.draw_worker(rng)).scores for _ in range(n_workers)]
    return emulator.performances(np.concatenate(scores)), np.repeat(np.arange(n_workers), n_each)


def within_correlation(a, b, worker):
    return np.corrcoef(within_worker(a, worker), within_worker(b, worker))[0, 1]


def mean_posture(directions):
    """(T, B, 3) mean direction at each moment of directions (n, T, B, 3)."""
    return sphere.normalise(directions.mean(axis=0))
