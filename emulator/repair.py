"""What is mended in repetitions before a model is fitted, each with a note: jumps, opposite points, uneven frames.

A jump: a bone (or the root, the heading) leaves in one frame by far more than its usual step and is back within 0.2 s.
Registration stands it (no other warp moves by more than 0.1 frames, tests/emulator/test_bad_sets.py); the postures do
not. In the public recordings it is found in 3 of 900 repetitions, one of them the known marker fault of the squats.
Opposite points: see ``opposite_points``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from emulator import sphere
from emulator.floor import floor_notes
from emulator.motion import Motion, MotionSet
from emulator.opposite_points import led_around, led_over, named
from emulator.stillness import moves

LEAST_JUMP = 0.15
"""Radians (metres for the root): a smaller step is no jump."""
TIMES_USUAL = 8.0
"""A jump is this many times the median step of the quarter seconds around it."""
LONGEST_S = 0.2
UNEVEN = 0.01


def repaired(motions: MotionSet) -> MotionSet:
    """The set with what could be mended, and notes on it; the very same set where nothing was wrong.

    Notes, too, where repetitions do not move, or are copies of one another: those are left as they are.
    """
    notes, mended = [], []
    for motion in motions.motions:
        bridged, jump_note = _bridged(motion)
        turning, turn_note = led_over(bridged, LONGEST_S)
        even, uneven_note = _even(turning)
        mended.append(even)
        notes += [f"{motion.name}: {note}" for note in (jump_note, turn_note, uneven_note) if note]
    mended, far_notes = led_around(mended)
    notes += far_notes + _still_note(mended) + _copies_note(mended) + floor_notes(mended)
    return replace(motions, motions=tuple(mended), notes=(*motions.notes, *notes)) if notes else motions


def _even(motion: Motion) -> tuple[Motion, str]:
    """The motion with frames at even times, since registration takes them so."""
    steps = np.diff(motion.time_s)
    if np.ptp(steps) <= UNEVEN * np.median(steps):
        return motion, ""
    time_s = np.linspace(0.0, motion.duration_s, len(motion.time_s))
    place = np.interp(time_s, motion.time_s, np.arange(len(time_s), dtype=float))
    low = np.minimum(place.astype(int), len(time_s) - 2)
    share = place - low
    even = replace(
        motion,
        directions=sphere.between(motion.directions[low], motion.directions[low + 1], share[:, None]),
        time_s=time_s,
        root_m=motion.root_m[low] + share[:, None] * (motion.root_m[low + 1] - motion.root_m[low]),
        yaw_rad=np.interp(time_s, motion.time_s, motion.yaw_rad),
        stretch=None,
    )
    return even, f"its frames are uneven in time ({steps.min():.3g} to {steps.max():.3g} s); evened out along geodesics"


def _bridged(motion: Motion) -> tuple[Motion, str]:
    """The motion with its jumps bridged from the frame before to the frame after."""
    rate_hz = (len(motion.time_s) - 1) / motion.duration_s
    changed: dict[str, Any] = {}
    said: list[str] = []
    for name, unit in (("directions", "rad"), ("root_m", "m"), ("yaw_rad", "rad")):
        values = getattr(motion, name)
        parts = values if name == "directions" else values.reshape(len(values), 1, -1)
        found = jumps(parts, rate_hz)
        if found:
            changed[name] = _across(parts, found, name == "directions").reshape(values.shape)
        for part, first, last, size in found:
            what = motion.skeleton.bone_names[part] if name == "directions" else name
            size = 2 * np.arcsin(min(size / 2, 1.0)) if name == "directions" else size  # chord to arc
            said.append(f"{what} jumps by {size:.2f} {unit} at frame{'s' * (last > first)} {_frames(first, last)}")
    return (replace(motion, **changed), f"{named(said)}; bridged") if said else (motion, "")


def _across(values: np.ndarray, found: list[tuple[int, int, int, float]], on_sphere: bool) -> np.ndarray:
    """A copy of values (T, P, C) in which each jump is a straight way, on the sphere a geodesic."""
    values = values.copy()
    for part, first, last, _ in found:
        share = np.arange(1.0, last - first + 2) / (last - first + 2)
        before, after = (
            np.broadcast_to(values[at, part], (len(share), values.shape[2])) for at in (first - 1, last + 1)
        )
        way = sphere.between(before, after, share) if on_sphere else before + share[:, None] * (after - before)
        values[first : last + 1, part] = way
    return values


def _frames(first: int, last: int) -> str:
    return f"{first}" if first == last else f"{first} to {last}"


def jumps(values: np.ndarray, rate_hz: float) -> list[tuple[int, int, int, float]]:
    """Jumps in values (T, P, C) as (part, first frame, last frame, size), never at the first or last frame."""
    step = np.diff(values, axis=0)
    step = np.sqrt(np.einsum("tpc,tpc->tp", step, step))
    window = max(3, round(0.25 * rate_hz))
    if len(step) <= window or step.max() <= LEAST_JUMP:
        return []
    padded = np.pad(step, ((window, window), (0, 0)), mode="reflect")
    usual = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * window + 1, axis=0), axis=-1)
    large = step > np.maximum(LEAST_JUMP, TIMES_USUAL * usual)
    found = []
    for part in np.flatnonzero(large.any(axis=0)):
        at = np.flatnonzero(large[:, part]).tolist()
        while at:
            leave = at.pop(0)
            size = float(step[leave, part])
            back = [b for b in at if b - leave <= LONGEST_S * rate_hz and _near(values[:, part], leave, b + 1, size)]
            if back:
                found.append((int(part), leave + 1, back[-1], size))
                at = [b for b in at if b > back[-1]]
    return found


def _near(values: np.ndarray, before: int, after: int, size: float) -> bool:
    return bool(np.linalg.norm(values[after] - values[before]) < size / 2)


def _still_note(motions: Sequence[Motion]) -> list[str]:
    still = [motion.name for motion in motions if not moves(motion)]
    if not still:
        return []
    return [f"{len(still)} of {len(motions)} repetitions do not move, their own clock is kept: {named(still)}"]


def _copies_note(motions: Sequence[Motion]) -> list[str]:
    first: dict[tuple[int, bytes], int] = {}
    copies = []
    for number, motion in enumerate(motions):
        middle = len(motion.time_s) // 2
        known = first.setdefault((len(motion.time_s), motion.directions[middle].tobytes()), number)
        if known != number and np.array_equal(motion.directions, motions[known].directions):
            copies.append(f"{motion.name} of {motions[known].name}")
    if not copies or len(first) == 1:  # that all are one recording is said by the fit itself
        return []
    return [f"copies of one recording, all used: {named(copies)}"]
