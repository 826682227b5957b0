"""Slips: a joint's marker steps aside and stays there. The bones tell which side of the step is wrong.

The stretch in which the bones to the joint have another length than the person's (in the other takes; else than in
the longer stretch) is put back by one constant offset in the frame of three points that move with the joint, since
that is how a marker slips. A step that leaves the bones as long as they were is a turn of the bone and left alone.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator.cleaning.bridge import neighbours, onto_bones
from emulator.cleaning.found import Repair
from emulator.cleaning.frames import companions, into, local_frame, out_of
from emulator.cleaning.settings import CleaningSettings
from emulator.cleaning.steps import OWN, largest_beside, surprising
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
