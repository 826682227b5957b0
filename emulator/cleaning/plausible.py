"""Is it a body, in metres, z up? What is not is refused: a wrong unit cannot be told from a wrong body afterwards."""

from __future__ import annotations

import numpy as np

from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Recording, Take

UNITS_M = {"millimetres": 0.001, "centimetres": 0.01, "inches": 0.0254, "decimetres": 0.1, "feet": 0.3048}
USUAL_M = 1.7
N_FRAMES = 15
LYING, STANDING = 0.3, 0.9
MOST_NAMED = 5


def mistakes(recording: Recording, settings: CleaningSettings) -> list[str]:
    """What speaks against the recording as a whole: place, found and expected; empty if nothing."""
    if settings.plausible == "off":
        return []
    wrong = [said for take in recording.takes if (said := _wrong_size(take, settings))]
    hidden = _never_seen(recording)
    if len(wrong) > MOST_NAMED:
        wrong = [*wrong[:MOST_NAMED], f"and {len(wrong) - MOST_NAMED} more takes of {len(recording.takes)}"]
    return [*wrong, *hidden, *([] if wrong else _wrong_way_up(recording))]


def size_m(take: Take) -> float:
    """Between the two farthest joints, median over frames; nan where nothing was seen."""
    frames = np.unique(np.linspace(0, take.n_frames - 1, N_FRAMES).astype(int))
    positions = take.positions_m[frames]
    away = np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1)
    most = np.where(np.isfinite(away), away, 0.0).max(axis=(1, 2))
    return float(np.median(most[most > 0])) if np.any(most > 0) else float("nan")


def _wrong_size(take: Take, settings: CleaningSettings) -> str:
    size = size_m(take)
    if np.isfinite(size) and settings.shortest_m <= size <= settings.tallest_m:
        return ""
    expected = f"expected {settings.shortest_m:g} to {settings.tallest_m:g} m"
    if not np.isfinite(size):
        return f"take {take.name}: found no frame in which two joints are seen, {expected} between the farthest"
    fitting = {unit: size * metres for unit, metres in UNITS_M.items()}
    unit = min(fitting, key=lambda name: abs(np.log(fitting[name] / USUAL_M)))
    fits = settings.shortest_m <= fitting[unit] <= settings.tallest_m
    hint = f"; in {unit} it would be {fitting[unit]:.2f} m" if fits else ""
    return f"take {take.name}: found {size:.3g} m between the two farthest joints, {expected}{hint}"


def _never_seen(recording: Recording) -> list[str]:
    """Joints that are seen in no frame of any take."""
    seen = np.any([np.isfinite(take.positions_m).all(axis=-1).any(axis=0) for take in recording.takes], axis=0)
    names = [recording.names[joint] for joint in np.flatnonzero(~seen)]
    return (
        [f"{', '.join(names)}: found in no frame, expected joints that are seen, or none of this name"] if names else []
    )


def _wrong_way_up(recording: Recording) -> list[str]:
    """That bodies stand along another axis than z, all the time."""
    names = recording.names
    top = next((name for name in ("head", "neck") if name in names), None)
    feet = [names.index(name) for name in ("left_ankle", "right_ankle") if name in names]
    if top is None or not feet:
        return []
    up = np.concatenate(
        [take.positions_m[:, names.index(top)] - take.positions_m[:, feet].mean(axis=1) for take in recording.takes]
    )
    up = up[np.isfinite(up).all(axis=-1)]
    if not len(up):
        return []
    x, y, z = np.median(up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9), axis=0)
    if z < -STANDING:
        return [f"bodies stand on their heads: found the {top} below the feet along z, expected z up"]
    if abs(z) < LYING and max(abs(x), abs(y)) > STANDING:
        axis = "x" if abs(x) > abs(y) else "y"
        return [
            f"bodies stand along {axis}: found the {top} {'+' if (x if axis == 'x' else y) > 0 else '-'}{axis} of the "
            "feet, expected z up (somebody who lies all the time passes with plausible='off')"
        ]
    return []
