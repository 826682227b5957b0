"""Gaps: what was not seen is bridged, filled from neighbours, or the take is cut, by how long it is.

Up to ``bridged_gap_s`` a cubic spline (C2) through the frames around, with the bone's length kept; up to
``filled_gap_s`` the joint keeps its place in the frame of three points that move with it, going over from its place
before to that after the gap. At the start and end, and around anything longer, frames are cut off. What was seen is
never changed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from emulator.cleaning.bridge import bridge, held_by_bones, outwards
from emulator.cleaning.found import Repair
from emulator.cleaning.frames import companions, into, local_frame, out_of
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take
from emulator.runs import stretches

FEWEST_FRAMES = 3
WANDER = 2.0
"""In the frame of its companions a joint may wander by this many times what their distances may vary."""


def without_gaps(take: Take, settings: CleaningSettings) -> tuple[Take | None, tuple[Repair, ...]]:
    """The take with its gaps filled; None where so little is seen that it is of no use. Repairs say which and how.

    With ``gaps="cut"`` nothing is filled, and all that is not seen is cut off.
    """
    missing = ~np.isfinite(take.positions_m).all(axis=-1)
    if not missing.any():
        return take, ()
    positions = np.where(missing[..., None], np.nan, take.positions_m)
    left, repairs = missing.copy(), []
    gaps = _inner_gaps(take, missing) if settings.gaps == "mend" else []
    at_most = [settings.frames(each, take.rate_hz) for each in (0.0, settings.bridged_gap_s, settings.filled_gap_s)]
    for short in (True, False):  # short gaps first: what they give back helps to fill longer ones
        longer_than, longest = at_most[:2] if short else at_most[1:]
        for joint, first, last in gaps:
            if not longer_than < last - first + 1 <= longest:
                continue
            way = (
                bridge(take, positions, joint, first, last)
                if short
                else _filled(take, positions, joint, first, last, settings)
            )
            if way is None:
                continue
            positions[first : last + 1, joint] = way
            left[first : last + 1, joint] = False
            repairs.append(_repair(take, joint, first, last, short))
    whole, cut = _cut(replace(take, positions_m=positions), left, settings)
    return whole, (*repairs, *cut)


def _filled(
    take: Take, positions: np.ndarray, joint: int, first: int, last: int, settings: CleaningSettings
) -> np.ndarray | None:
    around = np.arange(first - 1, last + 2)
    seen = np.zeros(len(positions), bool)
    seen[around] = True
    three = companions(positions, joint, seen, settings.rigid_m, most_wander_m=WANDER * settings.rigid_m)
    if not three:
        return None
    frame = local_frame(positions[around][:, three])
    local = into(frame, positions[around, joint])
    share = np.linspace(0.0, 1.0, len(around))[:, None]
    share = share**2 * (3 - 2 * share)
    way = out_of(frame, local[0] + share * (local[-1] - local[0]))[1:-1]
    return held_by_bones(take, positions, joint, first, last, way)


def _inner_gaps(take: Take, missing: np.ndarray) -> list[tuple[int, int, int]]:
    """(joint, first, last) of gaps that have seen frames on both sides, from the root outwards."""
    return [
        (joint, start, stop - 1)
        for joint in outwards(take)
        for start, stop in stretches(missing[:, joint])
        if start > 0 and stop < len(missing)
    ]


def _cut(take: Take, missing: np.ndarray, settings: CleaningSettings) -> tuple[Take | None, tuple[Repair, ...]]:
    """The longest stretch in which every joint is seen, where it is long enough and holds every mark."""
    if not missing.any():
        return take, ()
    seen = stretches(np.all(~missing, axis=1))
    first, stop = max(seen, key=lambda run: (run[1] - run[0], -run[0]), default=(0, 0))
    last = stop - 1
    away = [(start, end) for start, end in ((0, first - 1), (last + 1, take.n_frames - 1)) if end >= start]
    kept = last - first + 1
    marks_kept = all(first <= frame <= last for frame in take.mark_frame.values())
    if kept < max(FEWEST_FRAMES, settings.kept_share * take.n_frames) or not marks_kept:
        return None, tuple(_cut_repair(take, missing, *part, 0.0) for part in away or [(0, take.n_frames - 1)])
    inside = slice(first, last + 1)
    whole = replace(
        take,
        positions_m=take.positions_m[inside],
        contact=None if take.contact is None else take.contact[inside],
        mark_frame={name: frame - first for name, frame in take.mark_frame.items()},
    )
    lost_s = [_lost_s(take, missing, *part) for part in away]
    return whole, tuple(
        _cut_repair(take, missing, *part, lost if lost > settings.least_lost_s else 0.0)
        for part, lost in zip(away, lost_s)
    )


def _lost_s(take: Take, missing: np.ndarray, first: int, last: int) -> float:
    """How long of what is cut off, from first to last, was seen or lies between such: not what nobody ever saw."""
    seen = first + np.flatnonzero(~missing[first : last + 1].all(axis=1))
    if not len(seen):
        return 0.0
    return float(last + 1 - seen[0] if first == 0 else seen[-1] + 1 - first) / take.rate_hz


def _cut_repair(take: Take, missing: np.ndarray, first: int, last: int, lost_s: float) -> Repair:
    joints = tuple(take.names[j] for j in np.flatnonzero(missing[first : last + 1].any(axis=0)))
    seconds = (last - first + 1) / take.rate_hz
    words = f"not seen; {seconds:.2f} s cut off"
    words += f", of which {lost_s:.2f} s were seen or lie within the movement" if lost_s else ""
    return Repair(take.name, "cut", joints, first, last, seconds, "s", words, shortens=lost_s > 0)


def _repair(take: Take, joint: int, first: int, last: int, short: bool) -> Repair:
    seconds = (last - first + 1) / take.rate_hz
    how = "bridged by a spline" if short else "filled from points that move with it"
    words = f"not seen for {seconds:.2f} s; {how}"
    return Repair(take.name, "gap", (take.names[joint],), first, last, seconds, "s", words)
