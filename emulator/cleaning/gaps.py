"""Bridging: a joint's way across a few frames that are not to be had, by a spline that keeps the bone's length.

Local frames: three points that move with a joint say where it is when it is not seen.

Gaps: what was not seen is bridged, filled from neighbours, or the take is cut, by how long it is.

Up to ``bridged_gap_s`` a cubic spline (C2) through the frames around, with the bone's length kept; up to
``filled_gap_s`` the joint keeps its place in the frame of three points that move with it, going over from its place
before to that after the gap. At the start and end, and around anything longer, frames are cut off. What was seen is
never changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from emulator.cleaning.report import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.motion import stretches
from emulator.recordings.take import Take

KNOTS = 4
"""Frames on either side that a spline goes through."""
ROUNDS = 40
"""Projections onto two bones come together linearly; this many leave less than noise."""


def spline(way_m: np.ndarray, first: int, last: int) -> np.ndarray:
    """Points (last - first + 1, 3) of a cubic spline (C2) through the seen frames of way_m (T, 3) on either side."""
    from scipy.interpolate import CubicSpline

    seen = np.isfinite(way_m).all(axis=-1)
    low = max(0, first - KNOTS)
    before = np.flatnonzero(seen[low:first]) + low
    after = np.flatnonzero(seen[last + 1 : last + 1 + KNOTS]) + last + 1
    knots = np.concatenate([before, after])
    return np.asarray(CubicSpline(knots, way_m[knots])(np.arange(first, last + 1)))


def bridge(take: Take, positions_m: np.ndarray, joint: int, first: int, last: int) -> np.ndarray:
    """The joint (last - first + 1, 3) across frames first to last of positions_m (T, J, 3), seen on both sides.

    A spline, held by its bones: across a turning bone a spline alone would cut the corner.
    """
    return held_by_bones(take, positions_m, joint, first, last, spline(positions_m[:, joint], first, last))


def held_by_bones(
    take: Take, positions_m: np.ndarray, joint: int, first: int, last: int, way_m: np.ndarray
) -> np.ndarray:
    """way_m (last - first + 1, 3) moved so that each bone to a joint that is seen goes over from its length before
    to that after; projections onto one bone after the other, the one to the parent last.
    """
    around, share = slice(first - 1, last + 2), np.linspace(0.0, 1.0, last - first + 3)[:, None]
    held = []
    for other in reversed(neighbours(take, joint)):
        bone = positions_m[around, joint] - positions_m[around, other]
        if np.isfinite(positions_m[around, other]).all():
            before, after = np.linalg.norm(bone[[0, -1]], axis=-1)
            held.append((positions_m[first : last + 1, other], (before + share * (after - before))[1:-1]))
    return onto_bones(way_m, held)


def onto_bones(way_m: np.ndarray, held: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Points (T, 3) moved to the given lengths (T, 1) from the given centres (T, 3), the last exactly."""
    way = way_m
    for _ in range(ROUNDS if len(held) > 1 else 1):
        for centre, length in held:
            arm = way - centre
            now = np.linalg.norm(arm, axis=-1, keepdims=True)
            way = np.where(now > 1e-9, centre + arm * (length / np.where(now > 1e-9, now, 1.0)), way)
    return way


def neighbours(take: Take, joint: int) -> list[int]:
    """The joints at the other ends of its bones, the parent first; none where the points are markers."""
    parents = take.parents or (-1,) * len(take.names)
    return [j for j in (parents[joint],) if j >= 0] + [j for j, parent in enumerate(parents) if parent == joint]


def outwards(take: Take) -> list[int]:
    """Joint numbers, each parent before its children; as they are where the points are markers."""
    if take.parents is None:
        return list(range(len(take.names)))
    depth = [0] * len(take.names)
    for joint in range(len(take.names)):
        above = take.parents[joint]
        while above >= 0:
            depth[joint] += 1
            above = take.parents[above]
    return sorted(range(len(take.names)), key=lambda joint: depth[joint])


def companions(
    positions_m: np.ndarray,
    joint: int,
    seen: np.ndarray,
    rigid_m: float,
    pieces: Sequence[slice] = (slice(None),),
    most_wander_m: float = np.inf,
) -> list[int]:
    """Three points that move with ``joint``: the first two at a distance that varies by ``rigid_m`` at most, the third
    the one in whose frame the joint wanders least.

    positions_m : (T, J, 3), nan where not seen
    seen        : (T,) the frames in which they must be seen: those to be filled, and one on either side
    most_wander_m : standard deviation of the joint's place in their frame beyond which they say too little
    pieces      : the stretches within which the distance is looked at; the joint may have stepped between them
    returns     : three joint numbers that never lie in one line, or none where there are not three
    """
    away = np.linalg.norm(positions_m - positions_m[:, joint : joint + 1], axis=-1)
    known = np.isfinite(positions_m).all(axis=-1)
    counted = sum(np.isfinite(away[piece]).sum(axis=0) for piece in pieces)
    mean = sum(np.nansum(away[piece], axis=0) for piece in pieces) / np.maximum(counted, 1)
    spread = np.sqrt(sum(_square_sum(away[piece]) for piece in pieces) / np.maximum(counted, 1))
    usable = known[seen].all(axis=0) & (counted > 3) & (mean > 1e-6)
    usable[joint] = False
    order = [int(j) for j in np.lexsort((np.round(mean, 6), np.round(spread, 4))) if usable[j]]
    if len(order) < 3 or spread[order[1]] > rigid_m:
        return []
    possible = [third for third in order[2:] if _in_no_line(positions_m[seen][:, [order[0], order[1], third]])]
    if not possible:
        return []
    whole = np.concatenate([np.arange(len(positions_m))[piece] for piece in pieces])
    wander = {third: _wander(positions_m[whole], joint, [order[0], order[1], third]) for third in possible}
    third = min(wander, key=lambda j: wander[j])
    return [order[0], order[1], third] if wander[third] <= most_wander_m else []


def _wander(positions_m: np.ndarray, joint: int, three: list[int]) -> float:
    """Standard deviation of the joint's place in the frame of three points, over the frames in which all are seen."""
    known = np.isfinite(positions_m[:, [joint, *three]]).all(axis=(1, 2))
    part = positions_m[known]
    local = into(local_frame(part[:, three]), part[:, joint])
    return float(np.sqrt(local.var(axis=0).sum()))


def _square_sum(away_m: np.ndarray) -> np.ndarray:
    """(J,) sum of squares about the mean of each column of (T, J), nan left out."""
    counted = np.maximum(np.isfinite(away_m).sum(axis=0), 1)
    return np.asarray(np.nansum((away_m - np.nansum(away_m, axis=0) / counted) ** 2, axis=0))


def _in_no_line(triangle: np.ndarray) -> bool:
    """Whether three points (T, 3, 3) are never near one line: the sine of their angle stays above 0.1."""
    one, other = triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]
    lengths = np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
    return bool(np.all(np.linalg.norm(np.cross(one, other), axis=-1) > 0.1 * np.maximum(lengths, 1e-9)))


def local_frame(triangle_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The place (T, 3) and the axes (T, 3, 3), in columns, of three points (T, 3, 3)."""
    first = triangle_m[:, 1] - triangle_m[:, 0]
    first = first / np.maximum(np.linalg.norm(first, axis=-1, keepdims=True), 1e-12)
    across = np.cross(first, triangle_m[:, 2] - triangle_m[:, 0])
    across = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-12)
    axes = np.stack([first, np.cross(across, first), across], axis=-1)
    return triangle_m.mean(axis=1), axes


def into(frame: tuple[np.ndarray, np.ndarray], points_m: np.ndarray) -> np.ndarray:
    """Points (T, 3) of the world as seen from the frame."""
    place, axes = frame
    return np.einsum("tcl,tc->tl", axes, points_m - place)


def out_of(frame: tuple[np.ndarray, np.ndarray], local_m: np.ndarray) -> np.ndarray:
    """Points (T, 3) of the frame in the world."""
    place, axes = frame
    return np.einsum("tcl,tl->tc", axes, local_m) + place


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
