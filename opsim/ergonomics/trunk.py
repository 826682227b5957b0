"""Trunk flexion of performances, through the seam alone: whoever gives postures can be measured.

How long each worker's trunk was bent how far: the postures behind the rows of an EventLog.

Only what was really done counts: each performance is drawn again by its name (worker, task, k), each piece of it is
looked at where its progress lies, and its time is the time it took (who works faster passes through the same postures
in less time). What has no body, or a posture without a flexion, is counted as not measured, never as upright.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.angles import TRUNK_JOINTS, trunk_flexion_rad
from opsim.ergonomics.redraw import Pieces, drawn_again, pieces_in_window
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.plugins.guard import blamed
from opsim.problems import PluginError
from opsim.streams import BLOCK
from opsim.subjects.tasks.plan import TaskPlan
from opsim.threads import one_blas_thread

RATE_HZ = 10.0
"""Postures a second that are decoded."""
FINER = 4
"""Into so many parts the way from each posture to the next is cut, on a cubic through four postures.

Both were chosen beside 200 postures a second, over 5 x 768 performances of shipped movements: time beyond 20, 40 and 50
degrees is within 0.5 %, also where flexion only just gets there. Straight lines between 10 a second cut off peaks
(3 %), between 25 a second they still lose 0.5 to 2 %, at twice the cost.
"""
MOST_STEPS = 4096
"""Of one performance: those longer than 6.8 minutes are looked at less often."""
AT_ONCE = 2**20
"""Coordinates decoded at a time, 8 bytes each."""


def has_trunk(block: Any) -> bool:
    """Whether performances have a body with the joints that make a trunk."""
    return block.skeleton is not None and set(TRUNK_JOINTS) <= set(block.skeleton.names)


def rows_at_once(block: Any) -> int:
    """How many performances of a block may be decoded together."""
    return max(1, AT_ONCE // (3 * len(block.skeleton.names) * (_steps(block) + 1)))


def flexion_rad(block: Any, rows: Sequence[int] | np.ndarray) -> np.ndarray:
    """Trunk flexion (m, C) in the middles of C even parts of some performances of a block that has a trunk.

    C is the same for all of a block. nan where a posture, or one of its neighbours, has no flexion.
    Raises ValueError where the postures have another shape than the seam promises.
    """
    alone = hasattr(type(block), "__getitem__")
    some = block[np.asarray(rows)] if alone else block
    joints_m, names = _joints_m(some, _steps(block) + 1)
    return _finer(trunk_flexion_rad(joints_m if alone else joints_m[np.asarray(rows)], names))


def _steps(block: Any) -> int:
    """Even steps into which each performance of a block is cut: at most 1 / ``RATE_HZ`` s in the longest of them."""
    return int(np.clip(np.ceil(np.max(block.duration_s) * RATE_HZ), 1, MOST_STEPS))


def _finer(flexion: np.ndarray) -> np.ndarray:
    """(n, S + 1) radians at even points -> (n, S * FINER) between them; through their cosines and sines, so that
    nothing happens at 180 degrees.

    Source: Catmull & Rom 1974, A class of local interpolating splines (tension 1/2); the ends go on straight.
    """
    turn = np.exp(1j * flexion)
    turn = np.concatenate([2 * turn[:, :1] - turn[:, 1:2], turn, 2 * turn[:, -1:] - turn[:, -2:-1]], axis=1)
    t = (np.arange(FINER) + 0.5) / FINER
    weights = [-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, -(t**2) + t**3]
    n_steps = flexion.shape[1] - 1
    between = sum(turn[:, i : i + n_steps, None] * (0.5 * weight) for i, weight in enumerate(weights))
    return np.angle(between).reshape(len(flexion), -1)


def _joints_m(block: Any, n_times: int) -> tuple[np.ndarray, tuple[str, ...]]:
    """Joints (n, T, J, 3) in metres and their names (J,); heading and place are free, as angles know neither.

    NOTE: from directions and lengths of bones where there are both, in a fifth of the time of ``positions_m``, which
    finds the path over the floor.
    """
    if hasattr(block, "directions") and hasattr(block, "bone_length_m"):
        return _hung(block, n_times), TRUNK_JOINTS
    found = np.asarray(block.positions_m(n_times=n_times))
    expected = (len(block.duration_s), n_times, len(block.skeleton.names), 3)
    if found.shape != expected:
        raise ValueError(f"{type(block).__name__}.positions_m gave {found.shape}, expected {expected}")
    return found, tuple(block.skeleton.names)


def _hung(block: Any, n_times: int) -> np.ndarray:
    """(n, T, 4, 3) the joints of a trunk, from the root: each the sum of the bones that lead to it."""
    names, parents = list(block.skeleton.names), block.skeleton.parents
    directions = block.directions(n_times=n_times)
    lengths = np.asarray(block.bone_length_m)[:, None, :, None]
    bone_of = {joint: bone for bone, joint in enumerate(j for j, parent in enumerate(parents) if parent >= 0)}
    out = np.zeros((*directions.shape[:2], len(TRUNK_JOINTS), 3))
    for place, name in enumerate(TRUNK_JOINTS):
        joint = names.index(name)
        while joint in bone_of:
            bone = bone_of[joint]
            out[:, :, place] += directions[:, :, bone] * lengths[:, :, bone]
            joint = parents[joint]
    return out


DEGREES = np.arange(-180, 181)
"""Edges of the bins in which time is counted."""


@dataclass(frozen=True)
class Exposure:
    """What the trunks of W workers went through in the window.

    seconds_by_degree : (W, 360) seconds of work between ``DEGREES[i]`` and ``DEGREES[i + 1]`` degrees of flexion
    degree_seconds    : (W,) flexion in degrees, integrated over those seconds
    unmeasured_s      : (W,) seconds of work whose posture is not known
    """

    seconds_by_degree: np.ndarray
    degree_seconds: np.ndarray
    unmeasured_s: np.ndarray

    @property
    def measured_s(self) -> np.ndarray:
        """(W,) seconds of work whose posture is known."""
        return self.seconds_by_degree.sum(axis=1)

    def beyond_s(self, degrees: int) -> np.ndarray:
        """(W,) seconds of work with the trunk flexed by at least so many whole degrees."""
        return self.seconds_by_degree[:, DEGREES[:-1] >= degrees].sum(axis=1)

    def __add__(self, other: Exposure) -> Exposure:
        """What the same workers went through in both."""
        return Exposure(
            self.seconds_by_degree + other.seconds_by_degree,
            self.degree_seconds + other.degree_seconds,
            self.unmeasured_s + other.unmeasured_s,
        )

    def together(self) -> Exposure:
        """All workers as one."""
        return Exposure(
            self.seconds_by_degree.sum(axis=0, keepdims=True),
            self.degree_seconds.sum(keepdims=True),
            self.unmeasured_s.sum(keepdims=True),
        )


def trunk_exposure(log: EventLog, plan: Plan) -> Exposure:
    """The exposure of each worker of a plan, from the rows of one replication of it.

    Raises ValueError, naming the task, where its model gives postures of a shape it should not; whatever goes wrong in
    a plug-in is a PluginError.
    """
    n = len(plan.workers)
    found = Exposure(np.zeros((n, DEGREES.size - 1)), np.zeros(n), np.zeros(n))
    with one_blas_thread():
        for block, pieces in drawn_again(pieces_in_window(log, plan), log.replication, plan):
            with named_by(plan.tasks[pieces.task[0]]):
                add_flexion(found, block, pieces)
    return found


@contextmanager
def named_by(task: TaskPlan) -> Iterator[None]:
    """What goes wrong in here is said with the task's name, or is the mistake of the plug-in behind it."""
    behind = getattr(task.model, "found", None)
    try:
        with nullcontext() if behind is None else blamed(behind, f"failed as it gave the postures of {task.name}"):
            yield
    except PluginError:
        raise
    except ValueError as error:
        raise ValueError(f"task {task.name}: {error}") from error


def add_flexion(found: Exposure, block: Any, pieces: Pieces) -> None:
    """Add some pieces of one worker, all of one block, a few performances at a time; ``found`` is written to."""
    if not has_trunk(block):
        found.unmeasured_s[pieces.worker[0]] += pieces.seconds.sum()
        return
    together = rows_at_once(block)
    for start in range(0, pieces.k.size, together):
        _count(found, block, pieces.some(slice(start, start + together)))


def _count(found: Exposure, block: Any, pieces: Pieces) -> None:
    """Add what the trunk went through in some pieces of one worker, all of one block."""
    worker = pieces.worker[0]
    rows, which = np.unique(pieces.k % BLOCK, return_inverse=True)
    degrees = np.rad2deg(flexion_rad(block, rows))[which]
    seconds, nowhere_s = spread(pieces, degrees.shape[1])
    known = np.isfinite(degrees)
    at, spent_s = degrees[known], seconds[known]
    cell = np.clip(np.floor(at).astype(int) - DEGREES[0], 0, DEGREES.size - 2)
    found.seconds_by_degree[worker] += np.bincount(cell, spent_s, DEGREES.size - 1)
    found.degree_seconds[worker] += at @ spent_s
    found.unmeasured_s[worker] += seconds[~known].sum() + nowhere_s


def spread(pieces: Pieces, n_cells: int) -> tuple[np.ndarray, float]:
    """(P, C) seconds of each piece in each of C even parts of its performance; and those of pieces without progress."""
    edges = np.linspace(0.0, 1.0, n_cells + 1)
    begin, end = pieces.progress_from[:, None], pieces.progress_to[:, None]
    overlap = np.maximum(np.minimum(end, edges[1:]) - np.maximum(begin, edges[:-1]), 0.0)
    whole = overlap.sum(axis=1, keepdims=True)
    share = np.divide(overlap, whole, out=np.zeros_like(overlap), where=whole > 0)
    return share * pieces.seconds[:, None], float(pieces.seconds[whole[:, 0] <= 0].sum())
