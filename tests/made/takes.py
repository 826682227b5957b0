"""Clean made recordings, and faults to put into them."""

from dataclasses import replace
from functools import cache

import numpy as np

from emulator.recordings.take import Recording, Take
from emulator.synthetic.tasks import make

RATE_HZ = 50.0


@cache
def clean(task="reach", n_workers=2, n_repetitions=4):
    """A made recording without any fault."""
    motions, _ = make(task, n_workers, n_repetitions)
    names = motions.mark_names
    takes = [
        Take(
            motions.skeleton.names, motions.skeleton.parents, m.positions_m(world=True), RATE_HZ, m.worker, m.trial,
            mark_frame={name: float(at * RATE_HZ) for name, at in zip(names, m.mark_s)},
            contact=np.ones((len(m.time_s), 2), bool),
        )
        for m in motions.motions
    ]  # fmt: skip
    return Recording(tuple(takes), "made", "MIT")


def spoilt(recording, change, number=1):
    """The recording with ``change(positions (T, J, 3), joint number by name)`` done to a copy of one take."""
    take = recording.takes[number]
    positions = take.positions_m.copy()
    change(positions, take.names.index)
    bad = replace(take, positions_m=positions)
    return replace(recording, takes=(*recording.takes[:number], bad, *recording.takes[number + 1 :]))


def error_m(one, other):
    """The greatest distance between the joints of two takes."""
    return float(np.linalg.norm(one.positions_m - other.positions_m, axis=-1).max())


def same(one, other):
    """Whether two recordings have the same positions to the bit."""
    return len(one.takes) == len(other.takes) and all(
        np.array_equal(a.positions_m, b.positions_m, equal_nan=True) for a, b in zip(one.takes, other.takes)
    )
