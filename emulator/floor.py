"""What the feet of recordings say of the floor: whether there are feet, whether it is level, whether it has steps.

Nothing is changed by it: heights are modelled as recorded, with the lowest planted foot as the floor.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from emulator.motion import Motion
from emulator.runs import stretches

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
