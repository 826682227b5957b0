"""What no model can be fitted to: repetitions with mistakes that nothing mends, all named at once.

What the feet of recordings say of the floor: whether there are feet, whether it is level, whether it has steps.

Nothing is changed by it: heights are modelled as recorded, with the lowest planted foot as the floor.

What is mended in repetitions before a model is fitted, each with a note: jumps, opposite points, uneven frames.

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

from emulator.geometry import sphere
from emulator.geometry.opposite_points import led_around, led_over, named
from emulator.geometry.pauses import moves
from emulator.motion import Motion, MotionSet, stretches

FEWEST_FRAMES = 4
"""A movement of fewer frames is only its ends."""
_MOST = 10


def refuse_unsound(motions: MotionSet) -> None:
    """Raises ValueError that names every repetition with a mistake: missing numbers, too few frames, wrong marks."""
    wrong = [f"{motions.task}: {m.name}: {why}" for m in motions.motions for why in _mistakes(m, motions.mark_names)]
    if wrong:
        more = [f"{motions.task}: and {len(wrong) - _MOST} more"] if len(wrong) > _MOST else []
        raise ValueError("\n".join([*wrong[:_MOST], *more]))


def _mistakes(motion: Motion, mark_names: tuple[str, ...]) -> list[str]:
    bones = motion.skeleton.bone_names
    wrong = []
    if len(motion.time_s) < FEWEST_FRAMES:
        wrong.append(f"found {len(motion.time_s)} frames, expected {FEWEST_FRAMES} or more")
    square = np.einsum("tbc,tbc->tb", motion.directions, motion.directions)
    for frame, bone in np.argwhere(~(np.abs(square - 1.0) <= 2e-6))[:1]:
        if np.isfinite(square[frame, bone]):
            wrong.append(f"the direction of {bones[bone]} at frame {frame} has another length than 1")
        else:
            wrong.append(f"the direction of {bones[bone]} is no number at frame {frame}")
    for name in ("root_m", "yaw_rad", "time_s"):
        values = np.asarray(getattr(motion, name)).reshape(len(motion.time_s), -1)
        if not np.all(np.isfinite(values)):
            wrong.append(f"{name} is no number at frame {int(np.argwhere(~np.isfinite(values))[0, 0])}")
    for bone in np.flatnonzero(~(np.isfinite(motion.bone_length_m) & (motion.bone_length_m > 0))):
        wrong.append(f"the bone to {bones[bone]} has length {motion.bone_length_m[bone]:g} m, expected a positive one")
    return wrong + _mark_mistakes(motion, mark_names)


def _mark_mistakes(motion: Motion, mark_names: tuple[str, ...]) -> list[str]:
    outside = [
        f"mark {name} at {at:g} s, expected 0 to {motion.duration_s:g} s"
        for name, at in zip(mark_names, motion.mark_s)
        if not 0 <= at <= motion.duration_s * (1 + 1e-9)
    ]
    if outside or not np.any(np.diff(motion.mark_s) < 0):
        return outside
    return [f"marks {', '.join(mark_names)} at {', '.join(f'{at:g}' for at in motion.mark_s)} s: out of order"]


SLOW_M_PER_S, SHORTEST_S = 0.15, 0.2
"""A foot rests where it is slower than this for at least so long."""
SLOPE_DEG = 2.0
"""A floor that slopes less is level: markers on shoes of several people tell it no better."""
STEP_M = 0.08
"""Feet that both rest this much above where they rest else stand on a step, or are held up."""
FEWEST_RESTS, LEAST_WAY_M = 12, 0.5
"""Resting feet, and their spread over the floor, from which a slope can be told."""
_FEET = ("toe", "foot", "heel", "ankle")


def floor_notes(motions: Sequence[Motion]) -> list[str]:
    """What is odd about feet and floor of these motions of one skeleton; mostly nothing."""
    feet = feet_of(motions[0].skeleton.names)
    missing = [side for side in ("left", "right") if side not in feet]
    if missing:
        which = "feet" if len(missing) == 2 else f"{missing[0]} foot"
        return [f"no {which} in the recordings: when it stands is not known, and it is held to no floor"]
    rests = [_rests(motion, feet) for motion in motions]
    return _slope_note(motions, rests) + _step_note(motions, feet)


def feet_of(names: Sequence[str]) -> dict[str, int]:
    """The joint number of each side's foot, the lowest joint there is, by side."""
    found = {}
    for side in ("left", "right"):
        joint = next((f"{side}_{word}" for word in _FEET if f"{side}_{word}" in names), None)
        if joint is not None:
            found[side] = list(names).index(joint)
    return found


def _slow(motion: Motion, places_m: np.ndarray) -> np.ndarray:
    """Whether points (T, 3) rest, (T,), by the speed over three frames."""
    step = np.gradient(places_m, motion.time_s, axis=0) if len(places_m) > 2 else np.zeros_like(places_m)
    return np.asarray(np.linalg.norm(step, axis=-1) < SLOW_M_PER_S)


def _rests(motion: Motion, feet: dict[str, int]) -> np.ndarray:
    """(n, 3) mean places of each rest of each foot that is the lower one then, in the recording's own frame."""
    places_m = motion.positions_m(world=True, rigid=False)[:, list(feet.values())]
    lower = places_m[..., 2] <= places_m[..., 2].min(axis=1, keepdims=True) + STEP_M
    found = []
    for foot in range(places_m.shape[1]):
        for start, stop in stretches(_slow(motion, places_m[:, foot]) & lower[:, foot]):
            if motion.time_s[stop - 1] - motion.time_s[start] >= SHORTEST_S:
                found.append(places_m[start:stop, foot].mean(axis=0))
    return np.array(found).reshape(-1, 3)


def _slope_note(motions: Sequence[Motion], rests: Sequence[np.ndarray]) -> list[str]:
    """Of the plane through all rests, each person's at a height of his own (shoes, markers)."""
    who = np.repeat([motion.worker for motion in motions], [len(each) for each in rests])
    places = np.concatenate(rests)
    centred = np.concatenate([np.empty((0, 3)), *(places[who == w] - places[who == w].mean(axis=0) for w in set(who))])
    if len(centred) < FEWEST_RESTS:
        return []
    axes = np.linalg.svd(centred[:, :2], full_matrices=False)[2]
    axes = axes[np.ptp(centred[:, :2] @ axes.T, axis=0) >= LEAST_WAY_M]  # across the others no slope can be told
    along = centred[:, :2] @ axes.T
    square = np.sum(along**2, axis=0)
    rises = along.T @ centred[:, 2] / square
    slope = float(np.linalg.norm(rises))
    if slope <= np.tan(np.radians(SLOPE_DEG)):
        return []
    left, towards = centred[:, 2] - along @ rises, rises / slope
    error = np.sqrt(left @ left / (len(left) - 3) * np.sum(towards**2 / square))
    if slope - 2 * error < np.tan(np.radians(SLOPE_DEG)):
        return []
    towards = towards @ axes
    degrees, heading = np.degrees(np.arctan(slope)), np.degrees(np.arctan2(towards[1], towards[0]))
    return [
        f"the floor is not level: by {len(places)} resting feet it rises by {degrees:.1f} degrees towards "
        f"{heading:.0f} degrees from x; heights are taken as recorded"
    ]


def _step_note(motions: Sequence[Motion], feet: dict[str, int]) -> list[str]:
    said = []
    for motion in motions:
        places_m = motion.positions_m(world=True, rigid=False)[:, list(feet.values())]
        resting = np.all([_slow(motion, places_m[:, foot]) for foot in range(2)], axis=0)
        height = (places_m[..., 2] - places_m[..., 2].min(axis=0)).min(axis=1)
        for start, stop in stretches(resting & (height > STEP_M)):
            if motion.time_s[stop - 1] - motion.time_s[start] >= SHORTEST_S:
                said.append(f"{motion.name} at {motion.time_s[start]:.2f} s ({height[start:stop].mean():.2f} m)")
                break
    if not said:
        return []
    more = f" and {len(said) - 3} more" if len(said) > 3 else ""
    return [f"both feet rest above the floor, on a step or held up: {', '.join(said[:3])}{more}"]


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
