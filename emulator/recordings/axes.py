"""The unit and the upward axis of a recording, found from the body where nobody says them; then metres, z up.

The chain from the feet over knees, hips and shoulders to the head is 1.1 to 2.4 m long in any posture, and units in use
lie further apart than that; the head is above the hips, and these above the feet, most of the time.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.body_landmarks import PARTS, part_places

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
