"""Registration of the repetitions of a task: their warps, the aligned postures and their common template.

Source: Chen, Park & Srivastava, sec. 3.2. Group template by alternating minimisation: align all to the template, take
the mean of the warped fields, again. Neither half can raise the objective, because dynamic programming is exact on its
grid and a path is straight within a cell. The warps are centred after the first round and at the end, not between:
centring blurs the fields by a part of a cell and would raise the objective by 0.1-0.3 % each time.
Limits: see ``elastic``: a hold (pause) in some repetitions only drives their warps to the slope limit 7; cut it out.
Smoothing the postures first changed nothing on optical recordings (explained share, spread of marks): none is done.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from emulator import elastic, sphere, warp

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, eq=False)
class Alignment:
    """What ``align`` found.

    warps      : (N, T) common clock -> own unit time; their Karcher mean is the identity
    directions : (N, T, B, 3) postures on the common clock
    template   : (T - 1, 3B) mean S-TSRVF of the aligned sequences
    reference  : (B, 3) Karcher mean of all postures, where the fields live
    history    : mean squared elastic distance to the template in each round; it never rises
    before     : the same without any warp
    """

    warps: np.ndarray
    directions: np.ndarray
    template: np.ndarray
    reference: np.ndarray
    history: tuple[float, ...]
    before: float

    @property
    def explained(self) -> float:
        """The share of the fields' variance about their mean that the warps take away."""
        return 1.0 - self.history[-1] / self.before if self.before > 0 else 0.0


def align(
    directions: Sequence[np.ndarray],
    *,
    n_times: int = 101,
    max_iterations: int = 20,
    tolerance: float = 1e-3,
    n_threads: int | None = None,
    progress: Progress | None = None,
) -> Alignment:
    """Align sequences (T_i, B, 3), each uniform in its own time, to their common template on ``n_times`` points.

    Stops when a round gains less than ``tolerance`` of the objective. ``progress(done, total, label)`` is called after
    each sequence. The result does not depend on ``n_threads``. Raises ValueError for an empty list, unequal bones, or
    postures opposite to the reference.
    """
    sequences = _checked(directions)
    uniform = np.stack([resample(sequence, np.linspace(0.0, 1.0, n_times)) for sequence in sequences])
    reference = sphere.mean(uniform.reshape(-1, *uniform.shape[2:]))
    fields = elastic.tsrvf(uniform, reference)
    spread = _spread(fields)
    if len(sequences) == 1 or spread == 0.0:
        identity = np.tile(np.linspace(0.0, 1.0, n_times), (len(sequences), 1))
        return Alignment(identity, uniform, fields.mean(0), reference, (spread,), spread)
    register = _Rounds(fields, n_threads, progress)
    warps, _ = register(fields[_nearest_to_mean(fields)])
    template = _warp_fields(fields, warp.centre(warps)).mean(0)
    history: list[float] = []
    while len(history) < max_iterations and not _settled(history, tolerance):
        warps, inner = register(template)
        history.append(_mean_square(fields) + _mean_square(template[None]) - 2.0 * float(inner.mean()))
        template = _warp_fields(fields, warps).mean(0)
    warps = warp.centre(warps)
    template = _warp_fields(fields, warps).mean(0)
    aligned = np.stack([resample(sequence, gamma) for sequence, gamma in zip(sequences, warps)])
    return Alignment(warps, aligned, template, reference, tuple(history), spread)


def align_to(
    directions: Sequence[np.ndarray],
    template: np.ndarray,
    reference: np.ndarray,
    *,
    n_threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Warps (N, T) and aligned postures (N, T, B, 3) of new sequences (T_i, B, 3) against a given template."""
    sequences = _checked(directions)
    clock = np.linspace(0.0, 1.0, len(template) + 1)
    fields = elastic.tsrvf(np.stack([resample(sequence, clock) for sequence in sequences]), reference)
    warps, _ = _Rounds(fields, n_threads, progress)(template)
    return warps, np.stack([resample(sequence, gamma) for sequence, gamma in zip(sequences, warps)])


def resample(directions: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Postures (S, B, 3) of a sequence (T, B, 3), uniform over [0, 1], at the moments ``at`` (S,), along geodesics.

    Raises ValueError where two successive postures are opposite.
    """
    directions = np.asarray(directions, float)
    cells = len(directions) - 1
    place = np.clip(np.asarray(at, float), 0.0, 1.0) * cells
    low = np.minimum(place.astype(int), cells - 1)
    return sphere.between(directions[low], directions[low + 1], (place - low)[:, None])


def _checked(directions: Sequence[np.ndarray]) -> list[np.ndarray]:
    sequences = [np.asarray(sequence, float) for sequence in directions]
    if not sequences:
        raise ValueError("align: no sequence given")
    for i, sequence in enumerate(sequences):
        if sequence.ndim != 3 or sequence.shape[1:] != sequences[0].shape[1:] or len(sequence) < 2:
            expected = f"(T, {sequences[0].shape[1] if sequences[0].ndim == 3 else 'B'}, 3) with T >= 2"
            raise ValueError(f"align: sequence {i} must be {expected}, found {sequence.shape}")
        if not np.allclose(np.linalg.norm(sequence, axis=-1), 1.0, atol=1e-6):
            raise ValueError(f"align: sequence {i} is not made of unit vectors")
    return sequences


def _spread(fields: np.ndarray) -> float:
    """Mean squared L2 distance of fields (N, cells, D) to their mean."""
    return _mean_square(fields - fields.mean(0))


def _mean_square(fields: np.ndarray) -> float:
    """Mean squared L2 norm of fields (N, cells, D)."""
    return float(np.mean(np.sum(fields**2, axis=(1, 2)))) / fields.shape[1]


def _nearest_to_mean(fields: np.ndarray) -> int:
    return int(np.argmin(np.sum((fields - fields.mean(0)) ** 2, axis=(1, 2))))


def _settled(history: list[float], tolerance: float) -> bool:
    return len(history) > 1 and history[-2] - history[-1] < tolerance * history[-2]


@dataclass
class _Rounds:
    """Rounds of registration of the fields (N, cells, D), counted for the progress. One BLAS thread, several ours."""

    fields: np.ndarray
    n_threads: int | None
    progress: Progress | None
    done: int = 0

    def __call__(self, template: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The best warps (N, cells + 1) towards a template (cells, D) and their inner products (N,) with it."""
        from threadpoolctl import threadpool_limits

        self.done += 1
        with threadpool_limits(1, user_api="blas"):
            kernels = [template @ field.T for field in self.fields]
        found = []
        with ThreadPoolExecutor(self.n_threads or min(4, os.cpu_count() or 1)) as pool:
            for result in pool.map(elastic.best_warp, kernels):
                found.append(result)
                if self.progress is not None:
                    self.progress(len(found), len(kernels), f"aligning, round {self.done}")
        warps, inner = zip(*found)
        return np.array(warps), np.array(inner)


def _warp_fields(fields: np.ndarray, warps: np.ndarray) -> np.ndarray:
    """(q o gamma) sqrt(gamma') of each field (N, cells, D), averaged exactly over each cell of the common clock."""
    cells = fields.shape[1]
    rise = np.diff(warps, axis=-1)
    return np.stack([_mean_over(q, gamma) for q, gamma in zip(fields, warps)]) * np.sqrt(rise * cells)[..., None]


def _mean_over(field: np.ndarray, gamma: np.ndarray) -> np.ndarray:
    """The mean of a step function (cells, D) over each interval between successive gamma: (T - 1, D)."""
    cells = len(field)
    area = np.concatenate([np.zeros((1, field.shape[1])), np.cumsum(field, axis=0)]) / cells
    low = np.minimum((gamma * cells).astype(int), cells - 1)
    share = (gamma * cells - low)[:, None]
    return np.diff(area[low] * (1.0 - share) + area[low + 1] * share, axis=0) / np.diff(gamma)[:, None]
