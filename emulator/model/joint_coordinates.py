"""The joint vector: posture, way, pace, duration, marks, bones and dwells side by side, each at unit spread.

Margins of log duration and of marks: a straight line where they are normal, normal scores where they are not.

Long arrays on a binary grid, so that a saved model is the fitted one to the last bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

BLOCKS = ("posture", "root", "pace", "duration", "marks", "bones", "dwells")
CURVES = ("posture", "root", "pace")
"""The blocks that say curves over time."""


@dataclass(frozen=True)
class JointScale:
    """z = (raw - centre) / spread, and where each block of ``BLOCKS`` lies in it.

    sizes : number of coordinates of each block; centre, spread : (K,)
    A coordinate that never varies keeps spread 1.
    """

    sizes: tuple[int, ...]
    centre: np.ndarray
    spread: np.ndarray

    @classmethod
    def fit(cls, parts: dict[str, np.ndarray]) -> tuple[JointScale, np.ndarray]:
        """From raw parts {block: (N, k)} to the scale and z (N, K); a task without pauses gives no "dwells"."""
        parts = {"dwells": np.zeros((len(parts["duration"]), 0))} | parts
        raw = np.concatenate([parts[name] for name in BLOCKS], axis=1)
        spread = raw.std(axis=0, ddof=1)
        scale = cls(
            tuple(parts[name].shape[1] for name in BLOCKS), raw.mean(axis=0), np.where(spread > 1e-9, spread, 1.0)
        )
        return scale, (raw - scale.centre) / scale.spread

    def block(self, name: str) -> slice:
        """Where a block lies."""
        return self._blocks[name]

    @cached_property
    def _blocks(self) -> dict[str, slice]:
        ends = list(accumulate(self.sizes))
        return {name: slice(end - size, end) for name, end, size in zip(BLOCKS, ends, self.sizes)}

    def raw(self, z: np.ndarray, name: str) -> np.ndarray:
        """The raw coordinates (n, k) of one block of z (n, K)."""
        at = self.block(name)
        return self.centre[at] + self.spread[at] * z[..., at]


_GRID = np.linspace(-8.5, 8.5, 4001)
_WEIGHTS = np.exp(-0.5 * _GRID**2) / np.exp(-0.5 * _GRID**2).sum()
AT_ONCE = 16
"""Normals whose moments are made at a time: their grids should stay in the cache."""


FLAT, FAR = 0.05, 8.0
"""Below the least value a margin is so much flatter, as far as draws go (standard deviations)."""


@dataclass(frozen=True)
class Margin:
    """Increasing piecewise linear map between a value (log seconds, a mark's log ratio) and a normal coordinate z.

    z     : (Q,) knots of the coordinate, increasing
    value : (Q,) values at the knots, increasing; beyond the outer knots the map goes on with ``slope``
    A normal margin is the case of one knot: value = mean + slope * z.
    """

    z: np.ndarray
    value: np.ndarray
    slope: float

    @property
    def name(self) -> str:
        return ("normal", "normal, held above a least value", "normal scores")[min(len(self.z), 3) - 1]

    def held_above(self, least: float) -> Margin:
        """The same above ``least``, which lies below all knots but those of a line; below it nearly flat."""
        at = float(self.forward(np.array(least)))
        z, value = (self.z, self.value) if len(self.z) > 1 else (self.z[:0], self.value[:0])
        low = np.array([least - FLAT * self.slope * FAR, least])
        return Margin(np.r_[at - FAR, at, z], np.r_[low, value], self.slope)

    def forward(self, value: np.ndarray) -> np.ndarray:
        """Values (...,) -> z (...,)."""
        return _line(value, self.value, self.z, 1.0 / self.slope)

    def inverse(self, z: np.ndarray) -> np.ndarray:
        """z (...,) -> values (...,)."""
        return _line(z, self.z, self.value, self.slope)

    def moments_s(self, mean: np.ndarray, spread: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First and second moment (M,) of exp(inverse(Z)), seconds, for Z normal with ``mean``, ``spread`` (M,).

        In closed form where the margin is normal, else on a grid.
        """
        if len(self.z) == 1:
            log_s, square = self.inverse(mean), (self.slope * spread) ** 2
            return np.exp(log_s + square / 2), np.exp(2 * (log_s + square))
        first, second = np.empty((2, len(mean)))
        for start in range(0, len(mean), AT_ONCE):
            rows = slice(start, start + AT_ONCE)
            duration_s = self.inverse(mean[rows, None] + spread[rows, None] * _GRID)
            np.exp(duration_s, out=duration_s)
            first[rows], second[rows] = duration_s @ _WEIGHTS, np.square(duration_s, out=duration_s) @ _WEIGHTS
        return first, second

    def mean_duration_s(self, mean: float, spread: float) -> float:
        """Mean of exp(inverse(Z)), seconds, for Z normal with this mean and standard deviation."""
        return float(self.moments_s(np.array([mean]), np.array([spread]))[0][0])

    def cv(self, mean: float, spread: float) -> float:
        """Coefficient of variation of exp(inverse(Z)), Z as in ``mean_duration_s``."""
        first, second = self.moments_s(np.array([mean]), np.array([spread]))
        return float(np.sqrt(max(second[0] - first[0] ** 2, 0.0)) / first[0])


def fit_margin(values: np.ndarray, tested: np.ndarray, n_knots: int, level: float = 0.01) -> Margin:
    """Normal unless Shapiro-Wilk refuses ``tested`` (N,) at ``level``; then normal scores (Blom) of values (N,).

    For durations the tested numbers are within-worker residuals, since six people's means alone make any pooled margin
    look lumpy; for marks on the common clock, which hardly differ by worker, the values themselves.
    Values without spread get a slope of 1e-9.
    """
    spread = max(float(values.std(ddof=1)) if len(values) > 1 else 0.0, 1e-9)
    line = Margin(np.zeros(1), np.array([values.mean()]), spread)
    if len(tested) < 12 or np.ptp(tested) < 1e-9 or _shapiro(tested) > level:
        return line
    return _normal_scores(values, n_knots, spread)


def inverse_all(margins: tuple[Margin, ...], z: np.ndarray) -> np.ndarray:
    """Column by column the values of z (n, E)."""
    values = np.empty(z.shape)
    for e, margin in enumerate(margins):
        values[:, e] = margin.inverse(z[:, e])
    return values


def within_worker(values: np.ndarray, worker_index: np.ndarray) -> np.ndarray:
    """values (N, ...) less the mean of their worker."""
    counts = np.bincount(worker_index)
    sums = np.zeros((len(counts), *values.shape[1:]))
    np.add.at(sums, worker_index, values)
    means = sums / np.maximum(counts, 1).reshape(-1, *[1] * (values.ndim - 1))
    return values - means[worker_index]


def _shapiro(values: np.ndarray) -> float:
    from scipy.stats import shapiro

    return float(shapiro(values).pvalue)


def _normal_scores(values: np.ndarray, n_knots: int, spread: float) -> Margin:
    from scipy.special import ndtri

    n = len(values)
    blom = ndtri((np.arange(1, n + 1) - 0.375) / (n + 0.25))
    z = blom if n <= n_knots else np.linspace(blom[0], blom[-1], n_knots)
    at = np.interp(z, blom, np.sort(values))
    # ties would make the way back undefined
    return Margin(z, np.maximum.accumulate(at) + 1e-6 * spread * np.arange(len(z)), spread)


def _line(x: np.ndarray, x_knots: np.ndarray, y_knots: np.ndarray, slope: float) -> np.ndarray:
    if len(x_knots) == 1:
        return np.asarray(y_knots[0] + slope * (x - x_knots[0]))
    beyond = x - np.minimum(np.maximum(x, x_knots[0]), x_knots[-1])
    return np.interp(x, x_knots, y_knots) + slope * beyond


def bits(n_times: int) -> int:
    """Bits of a number of a sequence on ``n_times`` points: 15 on 101, 19 on 301.

    The grid shows in second differences, which fall with the square of the number of points: with 15 bits on 301 it
    was 2-4 % of the roughness of draws.
    """
    return min(15 + max(0, math.ceil(2 * math.log2(max(n_times - 1, 1) / 100))), 30)


def on_grid(rows: np.ndarray, n_bits: int) -> np.ndarray:
    """rows (R, P) rounded to multiples of a power of two a row, below 2^n_bits; again, it changes nothing."""
    whole, exponent = encode(rows, n_bits)
    return decode(whole, exponent)


def encode(rows: np.ndarray, n_bits: int) -> tuple[np.ndarray, np.ndarray]:
    """rows (R, P) -> int16, or int32 above 15 bits, (R, P) and exponents int16 (R,)."""
    largest = np.maximum(np.abs(rows).max(axis=1, initial=0.0), 1e-30)
    exponent = np.ceil(np.log2(largest / (2.0**n_bits - 1))).astype(np.int16)
    whole = np.rint(np.ldexp(rows, -exponent[:, None].astype(int)))
    return whole.astype(np.int16 if n_bits <= 15 else np.int32), exponent


def decode(whole: np.ndarray, exponent: np.ndarray) -> np.ndarray:
    """The way back: float64 (R, P). Raises ValueError for an exponent that no row of finite numbers has."""
    if exponent.dtype != np.int16 or np.any(np.abs(exponent.astype(int)) > 1000):
        raise ValueError(f"exponents must be int16 from -1000 to 1000, found {exponent.dtype}")
    return np.ldexp(whole.astype(float), exponent[:, None].astype(int))
