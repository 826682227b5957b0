"""Registration of the repetitions of a task: their warps, the aligned postures and their common template.

Source: Chen, Park & Srivastava, sec. 3.2. Group template by alternating minimisation: align all to the template, take
the mean of the warped fields, again. Neither half can raise the objective, because dynamic programming is exact on its
grid and a path is straight within a cell. The warps are centred after the first round and at the end, not between:
centring blurs the fields by a part of a cell and would raise the objective by 0.1-1 % each time (``centred`` says by
how much at the end; another round after it, and centring again, brought the known warps of made work no nearer).
Limits: see ``elastic``: a hold (pause) in some repetitions only drives their warps to the slope limit 7; cut it out.
Smoothing the postures first changed nothing on optical recordings (explained share, spread of marks): none is done.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np

from emulator.geometry import elastic
from emulator.geometry.base_points import NUMBERS, Labels, checked, mean_posture
from emulator.geometry.elastic import warped
from emulator.geometry.flattening import resample
from emulator.geometry.warps import centre as centred_warps

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
    centred    : the same with the centred warps that are returned, by 0.1-1 % more than the last of ``history``
    """

    warps: np.ndarray
    directions: np.ndarray
    template: np.ndarray
    reference: np.ndarray
    history: tuple[float, ...]
    before: float
    centred: float

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
    labels: Labels = NUMBERS,
    marks: np.ndarray | None = None,
    mark_strength: float = elastic.STRENGTH,
    penalty: float = 0.0,
    n_threads: int | None = None,
    progress: Progress | None = None,
) -> Alignment:
    """Align sequences (T_i, B, 3), each uniform in its own time, to their common template on ``n_times`` points.

    Stops when a round gains less than ``tolerance`` of the objective. ``progress(done, total, label)`` is called after
    each sequence. The result does not depend on ``n_threads``. Raises ValueError that tells the sequence (by its name
    in ``labels``) for an empty list, unequal bones, postures opposite to the next one or to the mean of all.
    marks (N, E), own unit times, are brought together softly: see ``landmarks``; the history then counts them too.
    penalty : weight of |sqrt(gamma') - 1|^2 against the mean |q|^2; 0 leaves the warps free, as in the paper
    """
    sequences = checked(directions, labels)
    uniform = np.stack([resample(sequence, np.linspace(0.0, 1.0, n_times)) for sequence in sequences])
    reference = mean_posture(uniform, labels)
    fields = velocity = elastic.tsrvf(uniform, reference)
    if marks is not None and mark_strength > 0:
        bumps = elastic.channels(marks, n_times - 1, _mean_square(velocity), mark_strength)
        fields = np.concatenate([velocity, bumps], axis=-1)
    level = np.sqrt(penalty * _mean_square(velocity))
    if penalty > 0:
        fields = np.concatenate([fields, np.full((*fields.shape[:-1], 1), level)], axis=-1)
    spread = _spread(fields)
    if len(sequences) == 1 or spread == 0.0:
        identity = np.tile(np.linspace(0.0, 1.0, n_times), (len(sequences), 1))
        return Alignment(identity, uniform, velocity.mean(0), reference, (spread,), spread, spread)
    register = _Rounds(fields, n_threads, progress)
    warps, _ = register(fields[_nearest_to_mean(fields)])
    template = _mean_field(fields, centred_warps(warps), level)
    history: list[float] = []
    while len(history) < max_iterations and not _settled(history, tolerance):
        warps, inner = register(template)
        history.append(_mean_square(fields) + _mean_square(template[None]) - 2.0 * float(inner.mean()))
        template = _mean_field(fields, warps, level)
    warps = centred_warps(warps)
    template = warped(fields, warps).mean(0)
    centred = _mean_square(fields) - _mean_square(template[None])
    template = template[:, : velocity.shape[2]]
    aligned = np.stack([resample(sequence, gamma) for sequence, gamma in zip(sequences, warps)])
    return Alignment(warps, aligned, template, reference, tuple(history), spread, centred)


def align_to(
    directions: Sequence[np.ndarray],
    template: np.ndarray,
    reference: np.ndarray,
    *,
    penalty: float = 0.0,
    n_threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Warps (N, T) and aligned postures (N, T, B, 3) of new sequences (T_i, B, 3) against a given template."""
    sequences = checked(directions)
    clock = np.linspace(0.0, 1.0, len(template) + 1)
    fields = elastic.tsrvf(np.stack([resample(sequence, clock) for sequence in sequences]), reference)
    level = np.sqrt(penalty * _mean_square(fields))
    if penalty > 0:
        fields = np.concatenate([fields, np.full((*fields.shape[:-1], 1), level)], axis=-1)
        template = np.concatenate([template, np.full((len(template), 1), level)], axis=-1)
    warps, _ = _Rounds(fields, n_threads, progress)(template)
    return warps, np.stack([resample(sequence, gamma) for sequence, gamma in zip(sequences, warps)])


def _mean_field(fields: np.ndarray, warps: np.ndarray, level: float) -> np.ndarray:
    """Mean of the warped fields (cells, D); where warps are penalised the last channel stays at ``level``."""
    mean = warped(fields, warps).mean(0)
    if level > 0:
        mean[:, -1] = level
    return mean


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
        found = []
        workers = self.n_threads or min(4, os.cpu_count() or 1)
        with threadpool_limits(1, user_api="blas"), ThreadPoolExecutor(workers) as pool:
            for result in pool.map(partial(elastic.best_warp, template), self.fields):
                found.append(result)
                if self.progress is not None:
                    self.progress(len(found), len(self.fields), f"aligning, round {self.done}")
        warps, inner = zip(*found)
        return np.array(warps), np.array(inner)
