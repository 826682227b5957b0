"""Angular offsets: a joint angle that is off by a constant in one take, against the same person's other takes.

Source: Baydal-Bertomeu et al., step 3 a: offsets appear when standing and go through the whole trial; the difference
between the angle seen and the angle expected at this position is taken out. They did so by hand; here an angle is
expected to run as the median of the person's other takes does, at the start and all the way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from emulator.cleaning.angles import angle_deg, turned
from emulator.cleaning.found import Repair
from emulator.cleaning.limits import Limit, limits_for
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

FEWEST_OTHERS = 3
N_TIMES = 50
"""Times at which takes are compared, as many as the source has."""
STEADY = 0.33
"""An offset is constant if what varies about it has a standard deviation of this share of it, or less."""
BEYOND_OTHERS = 4.0
"""An offset is this many times as large as those of the other takes usually are."""
ALONE = 0.5
"""No other take is offset by more than this share of it to the same side: several are a way of moving, no offset."""
CLEAR_DEG = 5.0
"""Below this bend an axis is taken from the nearest frame with more."""


def without_offsets(takes: list[Take], settings: CleaningSettings) -> list[tuple[Take, tuple[Repair, ...]]]:
    """The takes of one person, and in each the angles that are offset, in degrees; taken out where asked."""
    if settings.offsets == "off" or len(takes) <= FEWEST_OTHERS or takes[0].parents is None:
        return [(take, ()) for take in takes]
    mended, repairs = list(takes), [[] for _ in takes]  # type: list[Take], list[list[Repair]]
    for limit in (limit for limit in limits_for(takes[0].names) if limit.kind in ("bend", "lift")):
        curves = np.stack([_curve(take, limit) for take in takes])
        for number, offset in _offsets(curves, settings.least_offset_deg):
            mend = settings.offsets == "mend"
            if mend:
                mended[number] = _turned_back(mended[number], limit, offset)
            done = "taken out" if mend else "left as it is"
            words = f"{limit.what} is {offset:+.0f} deg off the person's other takes all the way; {done}"
            last = takes[number].n_frames - 1
            repairs[number].append(
                Repair(takes[number].name, "offset", (limit.joint,), 0, last, abs(offset), "deg", words, mend)
            )
    return [(take, tuple(found)) for take, found in zip(mended, repairs)]


def _curve(take: Take, limit: Limit) -> np.ndarray:
    """The angle (N_TIMES,) over the take's own time."""
    angle, _ = angle_deg(take, limit)
    return np.interp(np.linspace(0, take.n_frames - 1, N_TIMES), np.arange(take.n_frames), angle)


def _offsets(curves: np.ndarray, least_deg: float) -> list[tuple[int, float]]:
    """(number, offset) of the curves (N, T) that run beside the median of the others."""
    off = np.stack([curve - np.median(np.delete(curves, i, axis=0), axis=0) for i, curve in enumerate(curves)])
    size = np.median(off, axis=1)
    found = []
    for number in np.flatnonzero(np.abs(size) > least_deg).tolist():
        usual = np.median(np.abs(np.delete(size, number)))
        steady = np.std(off[number]) < STEADY * abs(size[number])
        at_start = abs(off[number, 0]) > abs(size[number]) / 2
        alone = not np.any(np.delete(size, number) / size[number] > ALONE)
        if steady and at_start and alone and abs(size[number]) > BEYOND_OTHERS * usual:
            found.append((number, float(size[number])))
    return found


def _turned_back(take: Take, limit: Limit, offset_deg: float) -> Take:
    bend, axis = angle_deg(take, limit)
    clear = np.flatnonzero(bend > CLEAR_DEG)
    if not len(clear):
        return take
    frames = np.arange(take.n_frames)
    after = np.minimum(np.searchsorted(clear, frames), len(clear) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(frames - clear[before] < clear[after] - frames, clear[before], clear[after])
    by_deg = np.full(take.n_frames, -offset_deg)
    return replace(take, positions_m=turned(take, limit.joint, limit.far, axis[nearest], by_deg))
