"""Quantization: a few canonical postures, and sequences told as which of them comes when.

Mode-based clustering: a posture with many others about it is dense; each goes to the nearest denser one, and one that
has none within reach is a mode. How many modes there are is found by the data, at a scale that is theirs, too: a share
of the mean distance of two postures, or more where postures lie scattered. The text of the clustering that the paper
cites (Deng et al. 2022) was not at hand; this is density peaks (Rodriguez & Laio 2014) with a radius in place of a look
at the decision graph.
Of the seven pairs (width 0.16-0.22 of the mean distance, reach 2-2.5 widths) tried on four recorded classes these were
the steadiest: two samples of 5,000 agree with a mean adjusted Rand index of 0.94-0.97 on postures (least 0.89).

Transition matrices between canonical postures in windows of normalised time.

How far sequences of canonical postures stray from a reference sequence of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.geometry import sphere
from emulator.judge.sequence_distances import distances

REACH = 0.4
"""A mode has no denser posture within this share of the mean distance of two postures."""
WIDTH = 0.4
"""Width of the Gaussian kernel by which density is counted, as a share of the reach."""
CROWD = 1.25
"""The reach is at least this many times the median radius that holds ``LEAST_SHARE`` of the sample: a single cloud of
many dimensions, in which all are about equally far apart, has one mode and not as many as items."""
LEAST_SHARE = 0.01
"""Modes with fewer of the sample are left out: their postures go to the nearest canonical one."""
_ROWS = 256


@dataclass(frozen=True, eq=False)
class Quantization:
    """Canonical postures (K, B, 3), the largest cluster first, and what they were found from.

    sample        : (S, B, 3) the postures given; sample_labels : (S,) the nearest canonical posture of each
    mean_distance : radians, of two postures of the sample (summed over bones)
    """

    canonical: np.ndarray
    sample: np.ndarray
    sample_labels: np.ndarray
    mean_distance: float

    @property
    def n_postures(self) -> int:
        return len(self.canonical)

    @classmethod
    def fit(cls, sample: np.ndarray, reach: float = REACH) -> Quantization:
        """Cluster postures (S, B, 3). The order of the sample changes nothing; no random numbers are used.

        A sample of one posture, or of copies of one, has one cluster. Raises ValueError for what is no set of postures.
        Source: Chen, Park & Srivastava sec. 4.4 (3).
        """
        sample = np.asarray(sample, float)
        if sample.ndim != 3 or sample.shape[-1] != 3 or not len(sample):
            raise ValueError(f"quantization: found {sample.shape}, expected postures (S, B, 3)")
        ordered = sample[np.lexsort(sample.reshape(len(sample), -1).T[::-1])]
        apart = distances(ordered[:, None])
        mean_distance = float(apart.sum() / max(len(apart) * (len(apart) - 1), 1))
        apart = apart.astype(np.float32)
        owner = _modes(apart, max(reach * mean_distance, CROWD * _crowd_radius(apart)))
        modes, size = np.unique(owner, return_counts=True)
        kept = modes[size >= min(LEAST_SHARE * len(sample), size.max())]
        kept = kept[np.argsort([-np.sum(owner == mode) for mode in kept], kind="stable")]
        canonical = np.stack([sphere.mean(ordered[owner == mode]) for mode in kept])
        return cls(canonical, sample, nearest(sample, canonical), mean_distance)

    def labels(self, directions: np.ndarray) -> np.ndarray:
        """Number of the nearest canonical posture of each posture of directions (..., B, 3): (...) whole numbers."""
        return nearest(directions, self.canonical)

    @property
    def sorted_distances(self) -> np.ndarray:
        """Distances (S, S) of the sample in the order of its clusters: blocks on the diagonal (figure 12a)."""
        in_order = self.sample[np.argsort(self.sample_labels, kind="stable")]
        return distances(in_order[:, None])


def sampled_postures(sequences: np.ndarray, n: int, rng: np.random.Generator) -> np.ndarray:
    """n of the postures of sequences (N, T, B, 3), drawn without replacement; all of them where they are fewer."""
    postures = sequences.reshape(-1, *sequences.shape[-2:])
    return postures[rng.choice(len(postures), n, replace=False)] if n < len(postures) else postures


def nearest(directions: np.ndarray, canonical: np.ndarray) -> np.ndarray:
    """Number of the nearest of canonical (K, B, 3) to each posture (..., B, 3); the first of equally near ones."""
    flat = directions.reshape(-1, 1, *directions.shape[-2:])
    return distances(flat, canonical[:, None]).argmin(axis=1).reshape(directions.shape[:-2])


def _crowd_radius(apart: np.ndarray) -> float:
    """Median over the items of the distance within which ``LEAST_SHARE`` of the others lie, from distances (n, n)."""
    rank = min(int(np.ceil(LEAST_SHARE * len(apart))), len(apart) - 1)
    starts = range(0, len(apart), _ROWS)
    return float(np.median(np.concatenate([np.partition(apart[s : s + _ROWS], rank, axis=1)[:, rank] for s in starts])))


def _modes(apart: np.ndarray, reach: float) -> np.ndarray:
    """Number of the mode (n,) to which each item leads, from distances (n, n)."""
    from emulator.kernels.sphere import uphill

    if reach == 0:
        return np.zeros(len(apart), int)
    owner = uphill(apart, _density(apart, WIDTH * reach), np.float32(reach))
    while not np.array_equal(owner, owner[owner]):
        owner = owner[owner]
    return owner


def _density(apart: np.ndarray, width: float) -> np.ndarray:
    """Gaussian kernel sums (n,) over distances (n, n)."""
    starts = range(0, len(apart), _ROWS)
    weights = (np.exp(-0.5 * (apart[s : s + _ROWS] / np.float32(width)) ** 2).sum(axis=1, dtype=float) for s in starts)
    return np.concatenate(list(weights))


WINDOW, STEP = 1 / 15, 1 / 30
"""Shares of the sequence: 20 and 10 of 301 points in the paper, 29 windows."""


def transition_matrices(
    labels: np.ndarray, n_postures: int, window: int | None = None, step: int | None = None
) -> np.ndarray:
    """Shares (W, K, K) of the changes from canonical posture i to j, in each window, over labels (M, T) from 0.

    window : changes in a window (points less one); step : points between the starts of two windows
    A row sums to 1; where no sequence is in posture i before the window's last point it is 0, as is the sum of the
    paper's formula. (Its own table cannot say: its baseline of 340-362 fits about 3.6 visited postures a window.)
    Raises ValueError for labels outside 0 to K - 1 and for windows that do not fit.
    Source: Chen, Park & Srivastava sec. 4.4 (3).
    """
    labels = np.atleast_2d(labels)
    last = labels.shape[1] - 1
    window = max(round(last * WINDOW), 1) if window is None else window
    step = max(round(last * STEP), 1) if step is None else step
    if not (1 <= window <= last and step >= 1):
        raise ValueError(f"transition_matrices: window {window}, step {step}, expected 1 to {last} and 1 or more")
    if labels.size and not (labels.min() >= 0 and labels.max() < n_postures):
        raise ValueError(
            f"transition_matrices: labels {labels.min()} to {labels.max()}, expected 0 to {n_postures - 1}"
        )
    counts = _counts(labels, n_postures)
    sums = np.concatenate([np.zeros_like(counts[:1]), np.cumsum(counts, axis=0)])
    starts = np.arange(0, last - window + 1, step)
    within = sums[starts + window] - sums[starts]
    return within / np.maximum(within.sum(axis=-1, keepdims=True), 1)


def transition_distance(a: np.ndarray, b: np.ndarray) -> float:
    """Summed absolute differences of two families of matrices (W, K, K); at most 2 W K.

    Raises ValueError for unequal shapes. Source: Chen, Park & Srivastava sec. 5.4, table 5 (L1 norm).
    """
    if a.shape != b.shape:
        raise ValueError(f"transition_distance: {a.shape} and {b.shape}, expected one shape")
    return float(np.abs(a - b).sum())


def uniform_transitions(n_windows: int, n_postures: int) -> np.ndarray:
    """The baseline (W, K, K): every change equally frequent, 1 / K. Source: Chen, Park & Srivastava table 5."""
    return np.full((n_windows, n_postures, n_postures), 1.0 / n_postures)


def _counts(labels: np.ndarray, n_postures: int) -> np.ndarray:
    """Changes (T - 1, K, K) from each point to the next, over all sequences."""
    n_changes = labels.shape[1] - 1
    cell = (np.arange(n_changes) * n_postures + labels[:, :-1]) * n_postures + labels[:, 1:]
    return np.bincount(cell.ravel(), minlength=n_changes * n_postures**2).reshape(n_changes, n_postures, n_postures)


@dataclass(frozen=True, eq=False)
class Variability:
    """E, the mean share of time that is spent in another canonical posture than the reference; Var E over sequences.

    mean, variance : of ``each`` (M,), in [0, 1]; the variance is NaN for one sequence
    """

    mean: float
    variance: float
    each: np.ndarray


def variability(labels: np.ndarray, reference: np.ndarray) -> Variability:
    """E(m) = share of times at which labels (M, T) differ from reference (T,), its mean and variance.

    The reference is the quantized mean sequence of the training. Small is not good in itself: compare with what
    the recorded sequences have. Raises ValueError for unequal lengths.
    Source: Chen, Park & Srivastava sec. 4.4 (3), E and Var(E), table 4.
    """
    labels, reference = np.atleast_2d(labels), np.asarray(reference)
    if labels.shape[1:] != reference.shape:
        raise ValueError(f"variability: labels {labels.shape} and reference {reference.shape}, expected equal lengths")
    each = (labels != reference).mean(axis=1)
    return Variability(float(each.mean()), float(each.var(ddof=1)) if len(each) > 1 else float("nan"), each)
