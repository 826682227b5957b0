"""Tasks that lead somewhere: who carries something three metres begins so far from the bench that he ends before it.

Where an operation goes to and fro (pick up, bring, put down, go back) the first way leads away from the bench and the
next one back, and what is done between is done where he is. Where it goes one way only, each begins at the far end.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import groupby
from typing import NamedTuple

import numpy as np

from opsim.viewer.skeletons import turned

Frames = tuple[np.ndarray, np.ndarray, np.ndarray]
"""x, y in metres and heading of each row."""


class Doing(NamedTuple):
    """Rows of whereabouts in which something is performed, (R,) each, by worker and time.

    far_m : (R, 2) how far the performance leads, in its own frame; 0 where it does not
    """

    row: np.ndarray
    worker: np.ndarray
    station: np.ndarray
    job: np.ndarray
    performance: np.ndarray
    far_m: np.ndarray


def placed(doing: Doing, frames: Frames) -> Frames:
    """The frames of whereabouts with those of ``doing`` put where they lead to the bench, or from it."""
    x, y, yaw = (column.copy() for column in frames)
    going = set(doing.station[doing.far_m.any(axis=1)].tolist())
    operations = [which for which in _operations(doing) if int(doing.station[which[0]]) in going]
    to_and_fro = _to_and_fro(doing, operations)
    for which in operations:
        returns = int(doing.station[which[0]]) in to_and_fro
        for row, back_m, turn in _steps(doing, which, returns):
            shift = turned(np.array([*back_m, 0.0]), yaw[row])
            x[row], y[row], yaw[row] = x[row] - shift[0], y[row] - shift[1], yaw[row] + turn
    return x, y, yaw


def _operations(doing: Doing) -> Iterator[list[int]]:
    """What one worker does of one job at one station, one after the other."""
    of = list(zip(doing.worker.tolist(), doing.station.tolist(), doing.job.tolist()))
    for _, which in groupby(range(len(of)), of.__getitem__):
        yield list(which)


def _to_and_fro(doing: Doing, operations: list[list[int]]) -> set[int]:
    """Stations whose operations mostly have an even number of ways."""
    ways: dict[int, Counter[int]] = {}
    for which in operations:
        far = {int(doing.performance[k]) for k in which if doing.far_m[k].any()}
        ways.setdefault(int(doing.station[which[0]]), Counter())[len(far)] += 1
    return {station for station, n in ways.items() if n.most_common(1)[0][0] % 2 == 0}


def _steps(doing: Doing, which: list[int], returns: bool) -> Iterator[tuple[int, np.ndarray, float]]:
    """(row, how far before the bench its frame begins, how much it is turned) of each piece of an operation."""
    away, at_m = False, np.zeros(2)
    for _, pieces in groupby(which, lambda k: int(doing.performance[k])):
        same = list(pieces)
        far_m = doing.far_m[same[0]]
        leads = bool(far_m.any())
        if leads and not returns:
            away, at_m = True, far_m
        for k in same:
            turn = np.pi if away != leads else 0.0
            yield int(doing.row[k]), at_m if away else np.zeros(2), turn
        if leads:
            away, at_m = not away, far_m
