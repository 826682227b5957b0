"""Steps: by how much each joint's way from one frame to the next is not what its neighbours in time foretell.

Steps that no body can do: beyond one near an end the take is cut off; one that nothing mended makes it bad.

Jumps: a joint leaves its way and is back within ``longest_jump_s``; a jump that no body can do is a glitch.

Found by surprise (``steps``): one step away, one back against it, and a spline across the frames between takes the
surprise away; a movement, however quick, is not smoother without its middle. Those frames are bridged. What is too
violent for a body and does not come back is for ``slips`` and ``violent``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from emulator.cleaning.gaps import bridge, outwards, spline
from emulator.cleaning.report import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

USUAL_QUANTILE = 0.9
OWN = 0.6
"""A step surprises on its own by more than this share of what the steps beside it do: theirs makes half of it."""


def surprise_vectors_m(positions_m: np.ndarray) -> np.ndarray:
    """(T - 1, J, 3) of each step what the mean of the steps before and after it does not foretell; 0 beside gaps.

    Half the third difference: a step S gives S (and -S / 2 beside it), a spike of one frame 1.5 S and -1.5 S, an even
    or evenly changing speed nothing. The first and the last step are held against the one beside.
    """
    step = np.diff(positions_m, axis=0)
    if len(step) < 3:
        return np.zeros_like(step)
    around = np.concatenate([step[1:2], step, step[-2:-1]])
    return np.nan_to_num(step - (around[:-2] + around[2:]) / 2, nan=0.0)


def surprise_m(positions_m: np.ndarray) -> np.ndarray:
    """(T - 1, J) length of ``surprise_vectors_m``."""
    return np.asarray(np.linalg.norm(surprise_vectors_m(positions_m), axis=-1))


def usual_m(surprise: np.ndarray) -> np.ndarray:
    """(J,) what each joint does in this take: the 90th percentile of its surprise."""
    return np.asarray(np.quantile(surprise, USUAL_QUANTILE, axis=0))


def surprising(take: Take, settings: CleaningSettings) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Surprise (T - 1, J), the limit (J,) above which it is a jump's, and (J,) above which no body does it, in metres.

    A joint whose marker shakes all the time has a high limit of its own: what it does always is no jump.
    """
    surprise = surprise_m(take.positions_m)
    usual = usual_m(surprise)
    small = np.maximum(settings.least_jump_m, settings.times_usual * usual)
    violent = np.maximum(settings.jump_m_per_s / take.rate_hz, 2.0 * usual)
    return surprise, np.minimum(small, violent), violent


def largest_beside(surprise: np.ndarray) -> np.ndarray:
    """(T - 1,) the larger surprise of the steps before and after each of (T - 1,)."""
    padded = np.concatenate([[0.0], surprise, [0.0]])
    return np.maximum(padded[:-2], padded[2:])


FEWEST_FRAMES = 12
AT_END = 2
"""A jump this many frames from the start or the end cannot be bridged; they are cut off."""


def violent_steps(take: Take, settings: CleaningSettings) -> tuple[Repair, ...]:
    """Steps that no body can do and that are still there, each run of them as one, in m/s."""
    if settings.jumps == "off" or take.n_frames < FEWEST_FRAMES:
        return ()
    surprise, _, violent = surprising(take, settings)
    found, longest = [], settings.frames(settings.longest_jump_s, take.rate_hz)
    for joint in np.flatnonzero((surprise > violent).any(axis=0)).tolist():
        runs: list[list[int]] = []
        for step in np.flatnonzero(surprise[:, joint] > violent[joint]).tolist():
            if runs and step - runs[-1][-1] <= longest:
                runs[-1].append(step)
            else:
                runs.append([step])
        for run in runs:
            size = float(surprise[run, joint].max()) * take.rate_hz
            words = f"its speed changes by {size:.1f} m/s between frames, which no body can do; left as it is"
            found.append(
                Repair(take.name, "glitch", (take.names[joint],), run[0], run[-1] + 1, size, "m/s", words, False, True)
            )
    return tuple(found)


def at_the_ends(surprise: np.ndarray, violent: np.ndarray) -> list[tuple[int, int, int, float]]:
    """(joint, first, last, size) of frames at the start or the end that a step no body can do parts from the rest."""
    n_frames, found = len(surprise) + 1, []
    for joint in range(surprise.shape[1]):
        own = np.flatnonzero(
            (surprise[:, joint] > violent[joint]) & (surprise[:, joint] > OWN * largest_beside(surprise[:, joint]))
        )
        for step in own.tolist():
            if step < AT_END:
                found.append((joint, 0, step, float(surprise[step, joint])))
            elif step >= n_frames - 1 - AT_END:
                found.append((joint, step + 1, n_frames - 1, float(surprise[step, joint])))
    return found


def cut_repair(take: Take, joint: int, first: int, last: int, size: float, settings: CleaningSettings) -> Repair:
    mended = settings.jumps == "mend"
    where = "from the first frames" if first == 0 else "in the last frames"
    words = f"jumps {where}, as no body can, {100 * size:.1f} cm; {'cut off' if mended else 'left as it is'}"
    return Repair(take.name, "glitch", (take.names[joint],), first, last, size, "m", words, mended, not mended)


CALMED = 0.4
"""A jump is taken out if this share of its surprise, or less, is left."""
LEAST_BACK, LEAST_AGAINST = 0.67, 0.5
"""The step back has this share of the step away, and points against it by this cosine. A step that stays has 0.5."""
AROUND = 3
BROKEN_SHARE = 0.1
"""A bridge that makes a bone longer or shorter by this share of its usual length is no mending."""


def without_jumps(take: Take, settings: CleaningSettings) -> tuple[Take, tuple[Repair, ...]]:
    """The take with its jumps bridged (at its ends: not seen, nan), and the jumps with their size in metres."""
    if settings.jumps == "off" or take.n_frames < FEWEST_FRAMES:
        return take, ()
    surprise, limit, violent = surprising(take, settings)
    found = [
        (joint, *away)
        for joint in outwards(take)
        if (surprise[:, joint] > limit[joint]).any()
        for away in _away(take, joint, float(limit[joint]), settings)
    ]
    positions = _across(take, found)
    while broken := [jump for jump in found if _breaks_bones(take, positions, jump)]:
        found = [jump for jump in found if jump not in broken]
        positions = _across(take, found)
    ends = at_the_ends(surprise, violent)
    repairs = [cut_repair(take, *each, settings) for each in ends]
    for joint, first, last, _ in ends:
        positions[first : last + 1, joint] = np.nan
    for joint, first, last, size in found:
        glitch = bool(surprise[first - 1 : last + 1, joint].max() > violent[joint])
        repairs.append(_repair(take, joint, first, last, size, glitch, settings))
    mended = settings.jumps == "mend" and bool(repairs)
    return replace(take, positions_m=positions) if mended else take, tuple(repairs)


def _across(take: Take, found: list[tuple[int, int, int, float]]) -> np.ndarray:
    """Positions (T, J, 3) in which each jump is bridged, from the root outwards."""
    positions = take.positions_m.copy()
    for joint, first, last, _ in found:
        positions[first : last + 1, joint] = np.nan
    for joint, first, last, _ in found:
        positions[first : last + 1, joint] = bridge(take, positions, joint, first, last)
    return positions


def _breaks_bones(take: Take, positions: np.ndarray, jump: tuple[int, int, int, float]) -> bool:
    """Whether a bone at the joint leaves its usual length, and by more than it did with the jump: then it was none."""
    joint, first, last, _ = jump
    if take.parents is None:
        return False
    for child in (j for j, parent in enumerate(take.parents) if joint in (j, parent) and parent >= 0):
        ends = [child, take.parents[child]]
        was, now = (
            np.linalg.norm(np.subtract(*np.moveaxis(each[:, ends], 1, 0)), axis=-1)
            for each in (take.positions_m, positions)
        )
        usual = np.nanmedian(was)
        off = [np.nan_to_num(np.abs(each[first : last + 1] - usual), nan=0.0).max() for each in (was, now)]
        if off[1] > BROKEN_SHARE * usual and off[1] > off[0] + 1e-9:
            return True
    return False


def _away(take: Take, joint: int, limit: float, settings: CleaningSettings) -> list[tuple[int, int, float]]:
    """(first, last, size) of the frames in which the joint is away, each the shortest that leaves nothing behind."""
    way = take.positions_m[:, joint]
    vectors = surprise_vectors_m(way[:, None])[:, 0]
    size = np.linalg.norm(vectors, axis=-1)
    edges = np.flatnonzero((size > limit) & (size > OWN * largest_beside(size))).tolist()
    longest, found, free = settings.frames(settings.longest_jump_s, take.rate_hz), [], 0
    for leave in edges:
        for back in (edge for edge in edges if leave >= free and leave < edge <= leave + longest):
            if not _against(vectors[leave], vectors[back]):
                continue
            size = _taken_out(way, leave + 1, back, limit)
            if size > settings.least_jump_m / 2:
                found.append((leave + 1, back, size))
                free = back + 1
                break
    return found


def _against(away: np.ndarray, back: np.ndarray) -> bool:
    """Whether one step is nearly the other taken back."""
    small, large = sorted((np.linalg.norm(away), np.linalg.norm(back)))
    return bool(small > LEAST_BACK * large and -away @ back > LEAST_AGAINST * small * large)


def _taken_out(way: np.ndarray, first: int, last: int, limit: float) -> float:
    """How far the joint is away from a spline across frames first to last; 0 where the spline does not calm it."""
    low, high = max(0, first - AROUND - 1), min(len(way), last + AROUND + 2)
    part = way[low:high].copy()
    inside = slice(first - low, last + 1 - low)
    part[inside] = np.nan
    if first < 2 or last > len(way) - 3 or not np.isfinite(part[[first - low - 1, last - low + 1]]).all():
        return 0.0
    part[inside] = spline(part, first - low, last - low)
    left, worst = (float(surprise_m(each[:, None]).max()) for each in (part, way[low:high]))
    size = float(np.linalg.norm(way[first : last + 1] - part[inside], axis=-1).max())
    return size if left < CALMED * worst and left <= limit else 0.0


def _repair(
    take: Take, joint: int, first: int, last: int, size: float, glitch: bool, settings: CleaningSettings
) -> Repair:
    mended = settings.jumps == "mend"
    what = "jumps, as no body can, and comes back" if glitch else "leaves its way and comes back"
    words = f"{what}, {100 * size:.1f} cm; {'bridged' if mended else 'left as it is'}"
    kind, joints = "glitch" if glitch else "jump", (take.names[joint],)
    return Repair(take.name, kind, joints, first, last, size, "m", words, mended, bad=glitch and not mended)
