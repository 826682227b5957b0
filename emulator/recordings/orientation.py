"""Which way is forward, by feet, knees, elbows and the way walked, held against the line of the hips.

Where head, shoulders, hips, knees and feet are, roughly, in named points: joints, keypoints or markers.

The unit and the upward axis of a recording, found from the body where nobody says them; then metres, z up.

The chain from the feet over knees, hips and shoulders to the head is 1.1 to 2.4 m long in any posture, and units in use
lie further apart than that; the head is above the hips, and these above the feet, most of the time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from emulator.recordings.joint_names import joints_of, marker_name, without_common_start
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError

LEAST_BEND_RAD = np.radians(20.0)
"""Knees and elbows that are straighter do not show where they bend to."""
LEAST_WALK_M_PER_S, LEAST_WAY_M = 0.4, 2.0
"""Slower, and over a shorter way, people also go backwards: they sit down, or swing back for a throw."""


def witnesses_of(take: Take) -> dict[str, float]:
    """Forward by each witness against forward by the hips: from -1 to 1, those that have something to say."""
    names, places = take.names, take.positions_m
    hips = vector(take, "right_hip", "left_hip")
    forward = unit(np.stack([hips[:, 1], -hips[:, 0]], axis=-1))
    said = {
        "toes": _both(lambda side: _toes(take, side, forward)),
        "knees": _both(lambda side: _bend(take, [f"{side}_{j}" for j in ("hip", "knee", "ankle")], forward)),
        "walking": _walking(places[:, names.index("pelvis")], take.rate_hz, forward),
        "elbows": _elbows(take, forward),
    }
    return {name: float(value) for name, value in said.items() if np.isfinite(value)}


def _both(witness: Callable[[str], float]) -> float:
    values = [witness(side) for side in ("left", "right")]
    told = [value for value in values if np.isfinite(value)]
    return float(np.mean(told)) if told else np.nan


def _toes(take: Take, side: str, forward: np.ndarray) -> float:
    """Toes are in front of the ankle, or of the heel."""
    back = next((f"{side}_{j}" for j in ("heel", "ankle") if f"{side}_{j}" in take.names), None)
    if back is None or f"{side}_toe" not in take.names:
        return np.nan
    foot = vector(take, back, f"{side}_toe")
    level = np.linalg.norm(foot[:, :2], axis=-1) > 0.5 * np.linalg.norm(foot, axis=-1)
    return _agreement(unit(foot[level, :2]), forward[level])


def _bend(take: Take, chain: Sequence[str], forward: np.ndarray) -> float:
    """A knee lies in front of the line from hip to ankle."""
    if not set(chain) <= set(take.names):
        return np.nan
    upper, lower = vector(take, chain[0], chain[1]), vector(take, chain[1], chain[2])
    bent = np.arccos(np.clip(np.sum(unit(upper) * unit(lower), axis=-1), -1, 1)) > LEAST_BEND_RAD
    out = unit(upper) - unit(lower)
    level = np.linalg.norm(out[:, :2], axis=-1) > 0.5 * np.linalg.norm(out, axis=-1)
    use = bent & level
    return _agreement(unit(out[use, :2]), forward[use]) if use.sum() >= 3 else np.nan


def _elbows(take: Take, forward: np.ndarray) -> float:
    """A forearm points forward of the upper arm while that hangs."""
    return _both(lambda side: _elbow(take, side, forward))


def _elbow(take: Take, side: str, forward: np.ndarray) -> float:
    chain = [f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist")]
    if not set(chain) <= set(take.names):
        return np.nan
    upper, lower = unit(vector(take, chain[0], chain[1])), unit(vector(take, chain[1], chain[2]))
    bent = np.arccos(np.clip(np.sum(upper * lower, axis=-1), -1, 1)) > LEAST_BEND_RAD
    use = bent & (upper[:, 2] < -0.7)
    across = lower[use] - np.sum(lower[use] * upper[use], axis=-1, keepdims=True) * upper[use]
    return _agreement(unit(across[:, :2]), forward[use]) if use.sum() >= 3 else np.nan


def _walking(pelvis: np.ndarray, rate_hz: float, forward: np.ndarray) -> float:
    """People walk forward, where they walk at all."""
    lag = max(1, round(0.3 * rate_hz))
    if len(pelvis) <= lag:
        return np.nan
    step = (pelvis[lag:] - pelvis[:-lag])[:, :2] * rate_hz / lag
    walks = np.linalg.norm(step, axis=-1) > LEAST_WALK_M_PER_S
    far = np.sum(np.linalg.norm(step[walks], axis=-1)) / rate_hz > LEAST_WAY_M
    return _agreement(unit(step[walks]), forward[:-lag][walks]) if far else np.nan


def _agreement(one: np.ndarray, other: np.ndarray) -> float:
    cosine = np.sum(one * other, axis=-1)
    cosine = cosine[np.isfinite(cosine)]
    return float(np.median(cosine)) if len(cosine) else np.nan


def vector(take: Take, start: str, end: str) -> np.ndarray:
    return np.asarray(take.positions_m[:, take.names.index(end)] - take.positions_m[:, take.names.index(start)])


def unit(vectors: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


PARTS = ("head", "shoulders", "hips", "knees", "feet")
_JOINTS = {
    "head": ("head", "nose", "left_ear", "right_ear", "left_eye", "right_eye"),
    "shoulders": ("neck", "left_shoulder", "right_shoulder"),
    "hips": ("pelvis", "left_hip", "right_hip"),
    "knees": ("left_knee", "right_knee"),
    "feet": ("left_ankle", "right_ankle", "left_toe", "right_toe", "left_heel", "right_heel"),
}
_MARKERS = {
    "head": r"[LR][FB]HD|ARIEL|TOPHEAD|HEAD(L|R|TOP|FRONT)",
    "shoulders": r"C7|CLAV|[LR]SHO|[LR]ACR",
    "hips": r"[LR](ASI|PSI|ASIS|PSIS)|SACR|SAC",
    "knees": r"[LR](KNE|KNM|MKNE|FLE|FME)",
    "feet": r"[LR](ANK|HEE|TOE|FAL|TAM|FCC|MT1|MT2|MT5|5MT|1MT)",
}
"""Skin markers of Plug-in Gait and of the sets derived from it."""


def part_places(positions: np.ndarray, names: Sequence[str]) -> dict[str, np.ndarray]:
    """The middle (T, 3) of each part of the body that these points (T, J, 3) know; nan where it was not seen."""
    joints = joints_of(names)
    bare = [marker_name(name) for name in without_common_start(names)]
    places = {}
    for part in PARTS:
        at = [i for i, joint in enumerate(joints) if joint in _JOINTS[part]]
        at = at or [i for i, name in enumerate(bare) if re.fullmatch(_MARKERS[part], name)]
        if at:
            places[part] = middle_of(positions[:, at])
    return places


def middle_of(points: np.ndarray) -> np.ndarray:
    """The mean over the points seen, (T, n, 3) -> (T, 3); nan where none is."""
    seen = np.isfinite(points).all(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        total: np.ndarray = np.where(seen, points, 0.0).sum(axis=1) / seen.sum(axis=1)
    return total


UNITS_M = {"m": 1.0, "ft": 0.3048, "inch": 0.0254, "cm": 0.01, "mm": 0.001}
"""Metres of one unit, by its name."""
_ODD_UNITS_M = {"1/0.45 inch, as CMU's files": 0.0254 / 0.45}
SHORTEST_M, LONGEST_M = 1.05, 2.35
"""Between these lies the chain of a person's joints from foot to head, markers on the skin and raised arms included."""
AXES = ("x", "y", "z", "-x", "-y", "-z")
CLEAR_UP = 1.5
"""The upward axis must rise this many times as much from the feet to the head as the next axis."""
MOST_LOOKED_AT = 200
_LARGEST = 1e9
_TURNS = {
    "x": [[0, 1, 0], [0, 0, 1], [1, 0, 0]], "-x": [[0, 1, 0], [0, 0, -1], [-1, 0, 0]],
    "y": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "-y": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    "z": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "-z": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
}  # fmt: skip
"""Proper turns (determinant 1) that bring each axis up; y up becomes (x, -z, y)."""


class NotTold(ValueError):
    """The body does not tell; the message says what was found."""


def placed(
    positions: np.ndarray,
    names: Sequence[str],
    *,
    unit_m: float | None = None,
    up: str | None = None,
    where: str = "",
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Positions (T, J, 3) in a file's unit and axes as metres, z up, and notes on what was found.

    unit_m : metres of one unit of the file; None finds it from the size of the body
    up     : the axis that points up, one of ``AXES``; None finds it from the body
    where  : the file, for messages
    Raises RecordingError where unit or axis cannot be told, both at once, and for values that no room holds.
    """
    positions = np.asarray(positions, float)
    if not np.isfinite(positions).any():
        raise RecordingError(f"{where}: found no position at all in {len(positions)} frames, expected numbers")
    if np.nanmax(np.abs(positions)) > _LARGEST:
        raise RecordingError(f"{where}: found a coordinate of {np.nanmax(np.abs(positions)):.3g}, expected a place")
    notes, wrong = [], []
    if unit_m is None:
        try:
            unit_m, said = found_unit_m(positions, names)
            notes.append(said)
        except NotTold as why:
            wrong.append(f"{where}: the unit cannot be told: {why}; give it with --unit ({', '.join(UNITS_M)})")
    elif not (np.isfinite(unit_m) and unit_m > 0):
        wrong.append(f"{where}: unit: found {unit_m}, expected metres of one unit, a positive number")
    if up is None:
        try:
            up, said = found_up(positions, names)
            notes.append(said)
        except NotTold as why:
            wrong.append(f"{where}: the upward axis cannot be told: {why}; give it with --up ({', '.join(AXES)})")
    elif up not in AXES:
        wrong.append(f"{where}: up: found {up!r}, expected one of {', '.join(AXES)}")
    if wrong or unit_m is None or up is None:
        raise RecordingError("\n".join(wrong))
    return turned_up(positions, up) * unit_m, tuple(notes)


def said_unit(word: str, unit_m: float | None) -> str:
    """A note on the unit that a file states; ``unit_m`` None where nobody knows it."""
    return f"unit said by the file: {word}" if unit_m is not None else f"the file's unit, {word!r:.40}, is not known"


def turned_up(positions: np.ndarray, up: str) -> np.ndarray:
    """Positions (..., 3) turned so that the axis ``up`` points along z; a turn, never a mirror."""
    turn = np.array(_TURNS[up])
    columns, signs = np.abs(turn).argmax(axis=1), turn.sum(axis=1)
    return np.asarray(positions[..., columns] * signs, float)


def found_unit_m(positions: np.ndarray, names: Sequence[str]) -> tuple[float, str]:
    """Metres of one unit, from the size of the body in (T, J, 3), and a sentence on it.

    Raises NotTold where the size fits no unit in use.
    """
    size, how = body_size(positions, names)
    if not (np.isfinite(size) and size > 0):
        raise NotTold("no frame shows enough of the body")
    for name, unit_m in (*UNITS_M.items(), *_ODD_UNITS_M.items()):
        if SHORTEST_M <= size * unit_m <= LONGEST_M:
            return unit_m, f"unit found from the body: {name} ({how} {size * unit_m:.2f} m)"
    raise NotTold(f"{how} {size:.4g} units, {SHORTEST_M:g} to {LONGEST_M:g} m in none of {', '.join(UNITS_M)}")


def body_size(positions: np.ndarray, names: Sequence[str]) -> tuple[float, str]:
    """The median size of the body in the unit of (T, J, 3), and how it was measured; nan where not enough is seen.

    Along the chain from head to feet where names tell, whatever the posture; else between its furthest points.
    """
    positions = _few(positions)
    places = part_places(positions, names)
    if "head" in places and "feet" in places and len(places) > 2:
        chain = [places[part] for part in PARTS if part in places]
        return _median(sum(np.linalg.norm(a - b, axis=-1) for a, b in pairwise(chain))), "from head to feet it is"
    extent = np.linalg.norm(_span(positions), axis=-1)
    extent = extent[np.isfinite(extent)]
    return (float(np.quantile(extent, 0.9)) if len(extent) else np.nan), "it measures"


def found_up(positions: np.ndarray, names: Sequence[str]) -> tuple[str, str]:
    """The axis (one of ``AXES``) that points up in (T, J, 3), and a sentence on it. Raises NotTold."""
    positions = _few(positions)
    places = part_places(positions, names)
    low = next((places[part] for part in ("feet", "knees") if part in places), None)
    high = next((places[part] for part in ("head", "shoulders", "hips") if part in places), None)
    if low is None or high is None:
        return _longest_axis(positions)
    rise = high - low
    if "hips" in places:  # a stoop hides the head's height, never that of the hips
        rise = rise + (places["hips"] - low)
    with np.errstate(invalid="ignore"):
        rise = rise[np.isfinite(rise).all(axis=-1)]
    if len(rise) == 0:
        raise NotTold("head and feet are never seen at once")
    mean = np.median(rise, axis=0)
    axis = int(np.abs(mean).argmax())
    others = np.delete(np.abs(mean), axis).max()
    steady = np.mean(np.sign(rise[:, axis]) == np.sign(mean[axis]))
    name = ("-" if mean[axis] < 0 else "") + "xyz"[axis]
    if np.abs(mean[axis]) < CLEAR_UP * others or steady < 0.8:
        raise NotTold(f"from feet to head it rises by {', '.join(f'{v:.3g}' for v in mean)} along x, y, z")
    return name, f"up axis found from the body: {name} (head and hips above the feet)"


def _longest_axis(positions: np.ndarray) -> tuple[str, str]:
    """Without names: the axis along which a person is longest, and who stands on a floor at 0 is above it."""
    extent = np.array([_median(column) for column in _span(positions).T])
    axis = int(np.nan_to_num(extent).argmax())
    others = np.delete(extent, axis).max()
    if not extent[axis] > CLEAR_UP * others:
        raise NotTold(f"head and feet are not known by name, and it measures {_three(extent)} along x, y, z")
    values = positions[..., axis]
    lowest, highest = np.nanquantile(values, [0.02, 0.98])
    if abs(lowest) < 0.15 * extent[axis] < highest:
        return "xyz"[axis], f"up axis found from the body: {'xyz'[axis]} (its longest, from the floor at 0)"
    if abs(highest) < 0.15 * extent[axis] < -lowest:
        return f"-{'xyz'[axis]}", f"up axis found from the body: -{'xyz'[axis]} (its longest, from the floor at 0)"
    raise NotTold(f"head and feet are not known by name, and {'xyz'[axis]} goes from {lowest:.3g} to {highest:.3g}")


def _span(positions: np.ndarray) -> np.ndarray:
    """(T, 3) from the lowest to the highest point along each axis; nan in frames that show less than half of them."""
    seen = np.isfinite(positions).all(axis=-1)
    enough = seen.mean(axis=1) > 0.5
    low = np.where(seen[..., None], positions, np.inf).min(axis=1)
    high = np.where(seen[..., None], positions, -np.inf).max(axis=1)
    with np.errstate(invalid="ignore"):
        return np.where(enough[:, None], high - low, np.nan)


def _few(positions: np.ndarray) -> np.ndarray:
    step = max(1, len(positions) // MOST_LOOKED_AT)
    return np.asarray(positions[::step], float)


def _median(values: np.ndarray) -> float:
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else np.nan


def _three(values: np.ndarray) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
