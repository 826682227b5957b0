"""Slips: a joint's marker steps aside and stays there. The bones tell which side of the step is wrong.

The stretch in which the bones to the joint have another length than the person's (in the other takes; else than in
the longer stretch) is put back by one constant offset in the frame of three points that move with the joint, since
that is how a marker slips. A step that leaves the bones as long as they were is a turn of the bone and left alone.

Swaps: two joints exchange their names, such as the left and the right wrist, and often back again.

Found by continuity: from one frame to the next each goes on where the other was. Which stretch is the swapped one is
told by the bones: the one in which they fit the rest of the take worse; where they do not tell, the shorter one.

Angular offsets: a joint angle that is off by a constant in one take, against the same person's other takes.

Source: Baydal-Bertomeu et al., step 3 a: offsets appear when standing and go through the whole trial; the difference
between the angle seen and the angle expected at this position is taken out. They did so by hand; here an angle is
expected to run as the median of the person's other takes does, at the start and all the way.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator.cleaning.bones_and_angles import angle_deg, turned
from emulator.cleaning.gaps import companions, into, local_frame, neighbours, onto_bones, out_of
from emulator.cleaning.report import Repair
from emulator.cleaning.settings import CleaningSettings, Limit, limits_for
from emulator.cleaning.spikes import OWN, largest_beside, surprising
from emulator.recordings.take import Take

FEWEST_FRAMES = 8
"""A stretch between steps has at least this many frames."""


def without_slips(
    take: Take, settings: CleaningSettings, usual_m: np.ndarray | None = None
) -> tuple[Take, tuple[Repair, ...]]:
    """The take with slipped joints put back, and each stretch that was off, with the offset in metres.

    usual_m : (J,) the person's usual length of the bone that ends at each joint, nan where not known
    """
    if settings.slips == "off" or take.parents is None or take.n_frames < 2 * FEWEST_FRAMES:
        return take, ()
    surprise, limit, _ = surprising(take, settings)
    positions, repairs = take.positions_m.copy(), []
    for joint in np.flatnonzero((surprise > limit).any(axis=0)).tolist():
        pieces = _pieces(surprise[:, joint], float(limit[joint]))
        wrong = _wrong(take, joint, pieces, settings.least_slip_share, usual_m) if len(pieces) > 1 else []
        for piece in wrong:
            back = _put_back(take, positions, joint, pieces, wrong, piece, settings.rigid_m)
            if back is None:
                continue
            first, last = pieces[piece].start, pieces[piece].stop - 1
            size = float(np.linalg.norm(back - positions[pieces[piece], joint], axis=-1).max())
            mended = settings.slips == "mend"
            words = f"steps aside by {100 * size:.1f} cm and stays; {'put back' if mended else 'left as it is'}"
            repairs.append(
                Repair(take.name, "slip", (take.names[joint],), first, last, size, "m", words, mended, not mended)
            )
            positions[pieces[piece], joint] = back
    mended = settings.slips == "mend" and bool(repairs)
    return replace(take, positions_m=positions) if mended else take, tuple(repairs)


def _pieces(surprise: np.ndarray, limit: float) -> list[slice]:
    """Stretches between the steps, each at least ``FEWEST_FRAMES`` long."""
    peaks = np.flatnonzero((surprise > limit) & (surprise > OWN * largest_beside(surprise))).tolist()
    edges = [0, *(peak + 1 for peak in peaks), len(surprise) + 1]
    if any(stop - start < FEWEST_FRAMES for start, stop in pairwise(edges)):
        return []
    return [slice(start, stop) for start, stop in pairwise(edges)]


def _wrong(take: Take, joint: int, pieces: list[slice], least_share: float, usual_m: np.ndarray | None) -> list[int]:
    """The numbers of the stretches whose bones are too long or too short, where the others are as they should be."""
    assert take.parents is not None
    bones = [joint] if take.parents[joint] >= 0 else []
    bones += [j for j, parent in enumerate(take.parents) if parent == joint]
    ends = [take.parents[bone] for bone in bones]
    away = np.linalg.norm(take.positions_m[:, bones] - take.positions_m[:, ends], axis=-1)
    length = np.stack([np.median(away[piece], axis=0) for piece in pieces])
    longest = int(np.argmax([piece.stop - piece.start for piece in pieces]))
    usual = (
        length[longest] if usual_m is None else np.where(np.isfinite(usual_m[bones]), usual_m[bones], length[longest])
    )
    off = (np.abs(length - usual) > least_share * usual).any(axis=1)
    return np.flatnonzero(off).tolist() if off.any() and not off.all() else []


def _put_back(
    take: Take, positions: np.ndarray, joint: int, pieces: list[slice], wrong: list[int], number: int, rigid_m: float
) -> np.ndarray | None:
    """The joint (T, 3) over a wrong stretch, moved so that it goes on from the stretch before (or into the next), and
    that its bones are as long as in the stretches that are right.
    """
    right = [piece for i, piece in enumerate(pieces) if i not in wrong]
    three = companions(positions, joint, np.ones(len(positions), bool), rigid_m, right)
    if not three:
        return None
    frame = local_frame(positions[:, three])
    local = into(frame, positions[:, joint])
    piece = pieces[number]
    inside, outside = (piece.start, piece.start - 1) if number > 0 else (piece.stop - 1, piece.stop)
    way = out_of((frame[0][piece], frame[1][piece]), local[piece] + local[outside] - local[inside])
    frames = np.concatenate([np.arange(each.start, each.stop) for each in right])
    held = []
    for other in reversed(neighbours(take, joint)):
        length = np.median(np.linalg.norm(positions[frames, joint] - positions[frames, other], axis=-1))
        held.append((positions[piece, other], np.full((len(way), 1), length)))
    return onto_bones(way, held)


CROSSED = 0.5
"""A crossed way is at most this share of the straight one."""
TELLING_M = 0.01
"""Bones tell which stretch is swapped where their mean misfit differs by this much."""


def without_swaps(take: Take, settings: CleaningSettings) -> tuple[Take, tuple[Repair, ...]]:
    """The take with mirrored joints (left_..., right_...) under their own names; size is how far they were apart, m."""
    if settings.swaps == "off":
        return take, ()
    positions, repairs = take.positions_m.copy(), []
    for left, right in mirrored(take.names):
        at = _exchanges(positions[:, left], positions[:, right], settings.least_swap_m)
        if not at:
            continue
        for first, last in _swapped(take, left, right, at):
            apart = float(
                np.nanmedian(
                    np.linalg.norm(positions[first : last + 1, left] - positions[first : last + 1, right], axis=-1)
                )
            )
            repairs.append(_repair(take, (left, right), first, last, apart, settings.swaps == "mend"))
            positions[first : last + 1, [left, right]] = positions[first : last + 1, [right, left]]
    mended = settings.swaps == "mend" and bool(repairs)
    return replace(take, positions_m=positions) if mended else take, tuple(repairs)


def mirrored(names: tuple[str, ...]) -> list[tuple[int, int]]:
    """Joint numbers of each left joint with its right one."""
    return [
        (number, names.index(other))
        for number, name in enumerate(names)
        if name.startswith("left_") and (other := f"right_{name.removeprefix('left_')}") in names
    ]


def _exchanges(one: np.ndarray, other: np.ndarray, least_m: float) -> list[int]:
    """First frames (after a gap, too) at which each goes on where the other was, at least ``least_m`` away."""
    seen = np.flatnonzero(np.isfinite(one).all(axis=-1) & np.isfinite(other).all(axis=-1))
    if len(seen) < 2:
        return []
    a, b = one[seen], other[seen]
    straight = np.linalg.norm(a[1:] - a[:-1], axis=-1) + np.linalg.norm(b[1:] - b[:-1], axis=-1)
    crossed = np.linalg.norm(a[1:] - b[:-1], axis=-1) + np.linalg.norm(b[1:] - a[:-1], axis=-1)
    return seen[1:][(crossed < CROSSED * straight) & (straight > 2 * least_m)].tolist()


def _swapped(take: Take, left: int, right: int, at: list[int]) -> list[tuple[int, int]]:
    """(first, last) of the swapped stretches: every other one between the exchanges."""
    edges = [0, *at, take.n_frames]
    stretches = [(start, stop - 1) for start, stop in pairwise(edges)]
    even, odd = stretches[0::2], stretches[1::2]
    misfit = _misfit(take, left, right, even), _misfit(take, left, right, odd)
    if abs(misfit[0] - misfit[1]) > TELLING_M:
        return odd if misfit[1] > misfit[0] else even
    return odd if _length(odd) <= _length(even) else even


def _misfit(take: Take, left: int, right: int, stretches: list[tuple[int, int]]) -> float:
    """How much longer, on average, the bones to the two joints are than if they were exchanged; 0 without bones."""
    if take.parents is None:
        return 0.0
    frames = np.concatenate([np.arange(first, last + 1) for first, last in stretches])
    total = [0.0, 0.0]
    for way, pair in enumerate(((left, right), (right, left))):
        for joint, stand_in in zip((left, right), pair):
            for other in neighbours(take, joint):
                bone = take.positions_m[frames, stand_in] - take.positions_m[frames, other]
                total[way] += float(np.nanmean(np.linalg.norm(bone, axis=-1)))
    return total[0] - total[1]


def _length(stretches: list[tuple[int, int]]) -> int:
    return sum(last - first + 1 for first, last in stretches)


def _repair(take: Take, pair: tuple[int, int], first: int, last: int, apart: float, mended: bool) -> Repair:
    words = f"exchange places, {100 * apart:.1f} cm apart; {'put back' if mended else 'left as it is'}"
    joints = tuple(take.names[joint] for joint in pair)
    return Repair(take.name, "swap", joints, first, last, apart, "m", words, mended, bad=not mended)


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
