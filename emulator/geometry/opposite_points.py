"""Opposite points: between a direction and its opposite there is no shortest way, so no mean and no tangent vector.

A bone that turns about from one frame to the next is left to the frames beside; one that points opposite to its mean
direction gets another base point (see ``alignable``), and where none has room, its way is led around. All is noted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator.geometry import sphere
from emulator.geometry.base_points import NEARLY_OPPOSITE_RAD, base_points, opposite, room_rad
from emulator.motion import Motion, stretches

MOST_WRONG = 0.5
"""The share of frames of a bone beyond which what is left of it says nothing."""
N_EVEN = 101
"""Frames of each repetition that the base points are found from: as many of a long one as of a short."""
_MOST_NAMES = 6


def led_over(motion: Motion, longest_s: float) -> tuple[Motion, str]:
    """The motion with bones that turn about between two frames led over by the frames beside, and a note on it.

    longest_s : a bone that turns about and back within this time is wrong between
    Raises ValueError for a bone that does so too often to tell which frames are right.
    """
    turns = opposite(motion.directions[1:], motion.directions[:-1])
    if len(turns) == 0:
        return motion, ""
    directions, said = motion.directions.copy(), []
    rate_hz = (len(motion.time_s) - 1) / motion.duration_s
    for bone in np.unique(turns[:, 1]):
        steps = turns[turns[:, 1] == bone, 0]
        frames = f"frames {steps[0]} and {steps[0] + 1} (at {motion.time_s[steps[0] + 1]:.2f} s)"
        what = f"the bone to {motion.skeleton.bone_names[bone]} turns about between {frames}"
        wrong, stays = _wrong_frames(steps, len(directions), round(longest_s * rate_hz))
        if wrong.mean() > MOST_WRONG:
            raise ValueError(f"{motion.name}: {what} and {len(steps) - 1} times more: no frame can be told to be right")
        directions[:, bone] = _way_over(directions[:, bone], wrong)
        more = f" and {len(steps) - 1} times more" if len(steps) > 1 else ""
        how = "led over by way of its mean direction: are markers swapped?" if stays else "left to the frames beside"
        said.append(f"{what}{more}; {how}")
    return replace(motion, directions=directions), named(said)


def _wrong_frames(steps: np.ndarray, n: int, longest: int) -> tuple[np.ndarray, bool]:
    """The frames (n,) not to be trusted, given the steps at which a bone turns about; does it stay so somewhere?

    Between two turns, or before the first, or after the last, ``longest`` frames or fewer are wrong. A turn after
    which it stays is in doubt on both sides.
    """
    wrong, bounds = np.zeros(n, bool), [0, *(steps + 1).tolist(), n]
    parts = list(pairwise(bounds))
    for start, stop in parts:
        wrong[start:stop] = stop - start <= min(longest, n // 4)
    sound = [not wrong[start] for start, _ in parts]
    turned = [side for side, fine in enumerate(sound) if fine]
    stays = any((b - a) % 2 for a, b in pairwise(turned))
    for a, b in pairwise(turned):
        if (b - a) % 2:
            wrong[parts[a][1] - 1], wrong[parts[b][0]] = True, True
    return wrong, stays


def _way_over(way: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    """Directions (T, 3) with the wrong frames (T,) on the geodesic between those beside, at an end as the one.

    Where these two are opposite, on the half circle that passes nearest to the mean of all right frames.
    """
    way, right = way.copy(), np.flatnonzero(~wrong)
    mean = way[right].mean(axis=0)
    for first, stop in stretches(wrong):
        before, after = first - 1, stop
        if before < 0 or after >= len(way):
            way[first:stop] = way[after if before < 0 else before]
            continue
        share = np.arange(1.0, stop - first + 1) / (stop - first + 1)
        way[first:stop] = _half_circle(way[before], way[after], mean, share)
    return way


def _half_circle(start: np.ndarray, end: np.ndarray, by: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Points (n, 3) at shares (n,) of the way from start to end; if they are opposite, of that which passes near by."""
    if float(start @ end) >= -np.cos(NEARLY_OPPOSITE_RAD):
        return sphere.between(np.broadcast_to(start, (len(share), 3)), np.broadcast_to(end, (len(share), 3)), share)
    aside = by - (start @ by) * start
    size = float(np.linalg.norm(aside))
    middle = aside / size if size > 1e-3 else sphere.basis(start)[0]
    near = np.where(share[:, None] <= 0.5, start, end)
    return sphere.between(near, np.broadcast_to(middle, near.shape), np.where(share <= 0.5, 2 * share, 2 - 2 * share))


def led_around(motions: Sequence[Motion]) -> tuple[list[Motion], list[str]]:
    """The motions with every bone kept off the opposite point of its base; notes on bones opposite to their mean."""
    evenly = [np.linspace(0, len(m.time_s) - 1, N_EVEN).round().astype(int) for m in motions]
    mean, base = base_points(np.stack([m.directions[at] for m, at in zip(motions, evenly)]))
    opposite_to_mean = {
        bone: [_near_opposite(m, bone, mean[bone]) for m in motions]
        for bone in np.flatnonzero(_least_room(motions, mean) < NEARLY_OPPOSITE_RAD).tolist()
    }
    words = "opposite to the mean direction in {where}; another base point is taken"
    notes = _notes(motions, opposite_to_mean, words)
    opposite_to_base = {
        bone: [_near_opposite(m, bone, base[bone]) for m in motions]
        for bone in np.flatnonzero(_least_room(motions, base) < NEARLY_OPPOSITE_RAD).tolist()
    }
    mended = list(motions)
    for bone, found in opposite_to_base.items():
        for number in (i for i, frames in enumerate(found) if len(frames)):
            directions = mended[number].directions.copy()
            directions[:, bone] = _kept_off(directions[:, bone], -base[bone], found[number])
            mended[number] = replace(mended[number], directions=directions)
    words = "every way, opposite to any base point in {where}; led around by the frames beside"
    return mended, notes + _notes(motions, opposite_to_base, words)


def _near_opposite(motion: Motion, bone: int, base: np.ndarray) -> np.ndarray:
    """The frames in which a bone is nearly opposite to its base (3,)."""
    return np.flatnonzero(motion.directions[:, bone] @ base < -np.cos(NEARLY_OPPOSITE_RAD))


def _notes(motions: Sequence[Motion], found: dict[int, list[np.ndarray]], words: str) -> list[str]:
    """A note on each group of bones found in the same repetitions; the frames (n,) of each bone and repetition."""
    bones = motions[0].skeleton.bone_names
    groups: dict[tuple[int, ...], list[int]] = {}
    for bone, frames in found.items():
        groups.setdefault(tuple(i for i, at in enumerate(frames) if len(at)), []).append(bone)
    notes = []
    for repetitions, group in groups.items():
        where = named([_times(motions[i], np.concatenate([found[bone][i] for bone in group])) for i in repetitions])
        one = f"the bone to {bones[group[0]]} points"
        what = one if len(group) == 1 else f"the bones to {named([bones[bone] for bone in group])} point"
        notes.append(f"{what} {words.format(where=where)}")
    return notes


def _times(motion: Motion, frames: np.ndarray) -> str:
    first, last = motion.time_s[frames.min()], motion.time_s[frames.max()]
    return f"{motion.name} at {first:.2f} s" if first == last else f"{motion.name} at {first:.2f} to {last:.2f} s"


def _least_room(motions: Sequence[Motion], base: np.ndarray) -> np.ndarray:
    return np.min([room_rad(motion.directions, base) for motion in motions], axis=0)


def _kept_off(way: np.ndarray, point: np.ndarray, close: np.ndarray) -> np.ndarray:
    """Directions (T, 3) with the close frames (n,) on the rim about the point, from the way in to the way out."""
    way, (first, second) = way.copy(), sphere.basis(point)
    angle = np.arctan2(way @ second, way @ first)
    for start, stop in stretches(np.isin(np.arange(len(way)), close)):
        before = angle[start - 1] if start else angle[min(stop, len(way) - 1)]
        after = angle[stop] if stop < len(way) else before
        turn = (after - before + np.pi) % (2 * np.pi) - np.pi
        at = before + turn * np.arange(1.0, stop - start + 1) / (stop - start + 1)
        across = np.cos(at)[:, None] * first + np.sin(at)[:, None] * second
        way[start:stop] = np.cos(NEARLY_OPPOSITE_RAD) * point + np.sin(NEARLY_OPPOSITE_RAD) * across
    return way


def named(names: Sequence[str]) -> str:
    """The names in a sentence, the first six and how many more."""
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return ", ".join(names[:_MOST_NAMES]) + more
