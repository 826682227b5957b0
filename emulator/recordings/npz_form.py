"""Is it a recording? Every array of the ``.npz`` form against what is expected of it, all mistakes at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

SLOWEST_HZ, FASTEST_HZ = 1.0, 10_000.0
"""Frames a second that a recording of people can have."""
MOST_NAMED = 3
_NUMBERS, _COLUMN, _NAME = "fiu", "one value a repetition", "one text or whole number a repetition"

NEEDED: dict[str, tuple[int, str, str]] = {
    "positions": (3, _NUMBERS, "metres, (frames, joints, 3)"),
    "offsets": (1, _NUMBERS, "the first frame of each repetition, and the number of frames last"),
    "fps": (0, _NUMBERS, "one number, frames a second"),
    "names": (1, "U", "the names of the joints"),
    "parents": (1, _NUMBERS, "a joint number for each joint, -1 for the root"),
    "subject": (1, "Uiu", _NAME),
    "trial": (1, "Uiu", _NAME),
}
"""Arrays of every recording: dimensions, kinds of numpy, and what they are."""
_CORE = {
    "core": (1, _NUMBERS, "numbers of the joints to read"),
    "core_parents": (1, _NUMBERS, "for each joint of core its parent's place in core, -1 for the root"),
}
_CONTACT = {"contact_feet": (2, "biu", "for each frame whether the left and the right foot bear, (frames, 2)")}


def is_mark(key: str) -> bool:
    """Whether this array says at which frame something happened."""
    return key.startswith("ann_") and key.endswith("_frame")


def expected_of(key: str) -> tuple[int, str, str] | None:
    """Dimensions, kinds and meaning of an array, or None for one that is not read."""
    if is_mark(key):
        return 1, _NUMBERS, "one frame a repetition"
    if key.startswith("cov_"):
        return 1, "Ufiub", _COLUMN
    return NEEDED.get(key) or _CORE.get(key) or _CONTACT.get(key)


def form_mistakes(arrays: Mapping[str, np.ndarray]) -> list[str]:
    """What keeps these arrays from being a recording: key, found and expected of each mistake; empty if nothing."""
    missing = [key for key in NEEDED if key not in arrays]
    mistakes = (
        [f"not a recording: no {', '.join(missing)}; found {', '.join(sorted(arrays)) or 'none of them'}"]
        if missing
        else []
    )
    sound = {}
    for key, array in arrays.items():
        wanted = expected_of(key)
        if wanted is None:
            continue
        if _fits(array, *wanted[:2]):
            sound[key] = array
        else:
            mistakes.append(f"{key}: found {_described(array)}, expected {wanted[2]}")
    return [*mistakes, *_rate(sound), *_frames(sound), *_joints(sound), *_columns(sound)]


def mark_mistakes(arrays: Mapping[str, np.ndarray], keep: np.ndarray) -> list[str]:
    """Marks of the repetitions to ``keep`` (N,) that are not finite or lie outside their frames, a line a key."""
    last = np.diff(arrays["offsets"]) - 1
    mistakes = []
    for key in filter(is_mark, arrays):
        frame = arrays[key]
        wrong = np.flatnonzero(keep & ~((frame >= 0) & (frame <= last)))
        if len(wrong):
            named = [
                f"{arrays['subject'][i]}/{arrays['trial'][i]} has {frame[i]} (expected 0 to {last[i]:g})"
                for i in wrong[:MOST_NAMED]
            ]
            more = ", ..." if len(wrong) > MOST_NAMED else ""
            mistakes.append(f"{key}: {len(wrong)} of {keep.sum()} marks lie outside: {', '.join(named)}{more}")
    return mistakes


def _fits(array: np.ndarray, ndim: int, kinds: str) -> bool:
    one_number = ndim == 0 and array.size == 1
    return (one_number or array.ndim == ndim) and array.dtype.kind in kinds


def _described(array: np.ndarray) -> str:
    kind = {"U": "text", "S": "bytes", "b": "yes or no"}.get(array.dtype.kind, str(array.dtype))
    return f"one value, {str(array)[:40]!r} ({kind})" if array.ndim == 0 else f"shape {array.shape} of {kind}"


def _rate(arrays: Mapping[str, Any]) -> Iterator[str]:
    if "fps" in arrays and not SLOWEST_HZ <= (rate := float(arrays["fps"].flat[0])) <= FASTEST_HZ:
        yield f"fps: found {rate:g}, expected {SLOWEST_HZ:g} to {FASTEST_HZ:g} frames a second"


def _frames(arrays: Mapping[str, Any]) -> Iterator[str]:
    positions, offsets, names = (arrays.get(key) for key in ("positions", "offsets", "names"))
    if positions is not None:
        joints = positions.shape[1] if names is None else len(names)
        if positions.shape[1:] != (joints, 3):
            yield f"positions: found {positions.shape}, expected (frames, {joints}, 3) for {joints} names"
    contact = arrays.get("contact_feet")
    if contact is not None and positions is not None and contact.shape != (len(positions), 2):
        yield f"contact_feet: found {contact.shape}, expected ({len(positions)}, 2)"
    if offsets is None:
        return
    if len(offsets) < 2 or not _whole(offsets):
        yield f"offsets: found {_few(offsets)}, expected whole numbers, two or more"
    elif offsets[0] != 0 or (positions is not None and offsets[-1] != len(positions)):
        end = "the number of frames" if positions is None else len(positions)
        yield f"offsets: found {offsets[0]:g} to {offsets[-1]:g}, expected 0 to {end}"
    elif np.any(short := offsets[1:] < offsets[:-1] + 2):
        i = int(np.argmax(short))
        yield f"offsets: found {offsets[i + 1]:g} after {offsets[i]:g}, expected to rise by two frames or more"


def _joints(arrays: Mapping[str, Any]) -> Iterator[str]:
    if ("core" in arrays) != ("core_parents" in arrays):
        yield "core, core_parents: found one of them, expected both or neither"
    n_joints = len(arrays["names"]) if "names" in arrays else None
    if n_joints is not None and "parents" in arrays:
        yield from _numbered("parents", arrays["parents"], -1, n_joints, n_joints)
    if n_joints is not None and "core" in arrays:
        yield from _numbered("core", arrays["core"], 0, n_joints, None)
    if "core" in arrays and "core_parents" in arrays:
        yield from _numbered("core_parents", arrays["core_parents"], -1, len(arrays["core"]), len(arrays["core"]))


def _numbered(key: str, array: Any, lowest: int, n_joints: int, length: int | None) -> Iterator[str]:
    if length is not None and len(array) != length:
        yield f"{key}: found {len(array)} values, expected {length}"
    if not _whole(array) or np.any((array < lowest) | (array >= n_joints)):
        yield f"{key}: found {_few(array)}, expected joint numbers from {lowest} to {n_joints - 1}"


def _columns(arrays: Mapping[str, Any]) -> Iterator[str]:
    if "offsets" not in arrays or len(arrays["offsets"]) < 2:
        return
    n = len(arrays["offsets"]) - 1
    for key, column in arrays.items():
        if (key in ("subject", "trial") or key.startswith("cov_") or is_mark(key)) and len(column) != n:
            yield f"{key}: found {len(column)} values, expected {n}, one a repetition"


def _whole(array: Any) -> bool:
    return bool(np.all(np.isfinite(array)) and np.all(array == np.floor(array)))


def _few(array: Any) -> str:
    return f"[{', '.join(f'{value:g}' for value in array[:6])}{', ...' if len(array) > 6 else ''}]"
