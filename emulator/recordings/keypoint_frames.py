"""Frames of keypoints as trackers write them, whatever their form: lists, objects by name, flat numbers, people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.keypoint_sets import KEYPOINTS

_POINTS = (
    "pose_keypoints_3d", "keypoints_3d", "keypoints3d", "pose_world_landmarks", "poseWorldLandmarks", "worldLandmarks",
    "world_landmarks", "positions", "keypoints", "points", "joints", "landmarks",
)  # fmt: skip
_FLAT = ("pose_keypoints_2d", "keypoints_2d", "pose_landmarks", "poseLandmarks", "normalized_landmarks")
_SCORES = ("score", "visibility", "confidence", "likelihood", "c")


class _Wrong(ValueError):
    """What is wrong with one frame."""


def points_of_frames(path: Path, frames: Sequence[Any], names: list[str]) -> tuple[np.ndarray, list[str]]:
    """(T, J, 4) x, y, z and score, nan where nobody is seen; and the names, where frames say them."""
    rows: list[np.ndarray | None] = []
    wrong: list[str] = []
    for i, frame in enumerate(frames):
        try:
            row, own = _frame(frame, names)
        except _Wrong as why:
            wrong.append(f"{path}: frame {i}: {why}")
            if len(wrong) == 5:
                break
            continue
        names = names or own
        rows.append(row)
    sizes = {len(row) for row in rows if row is not None}
    if len(sizes) > 1 and not wrong:
        wrong.append(_uneven(path, rows))
    if not sizes and not wrong:
        wrong.append(f"{path}: found nobody in any of {len(frames)} frames")
    if wrong:
        raise RecordingError("\n".join(wrong))
    nothing = np.full((sizes.pop(), 4), np.nan)
    return np.array([nothing if row is None else row for row in rows]), names


def _uneven(path: Path, rows: Sequence[np.ndarray | None]) -> str:
    """The first frame of another number of points than most."""
    sizes = {i: len(row) for i, row in enumerate(rows) if row is not None}
    usual = Counter(sizes.values()).most_common(1)[0][0]
    others = [i for i, size in sizes.items() if size != usual]
    more = f" ({len(others) - 1} more frames are otherwise)" if len(others) > 1 else ""
    return f"{path}: frame {others[0]}: found {sizes[others[0]]} points, expected {usual} as in most frames{more}"


def _frame(frame: Any, names: list[str]) -> tuple[np.ndarray | None, list[str]]:
    """One frame as (J, 4), None where nobody is in it, and the names it gives."""
    frame = _person(frame)
    if frame is None:
        return None, []
    own: list[str] = []
    if isinstance(frame, Mapping):
        own = names or [str(key) for key in frame]
        frame = [frame.get(name) for name in own]
    if isinstance(frame, list) and frame and all(isinstance(value, int | float) for value in frame):
        width = 4 if len(frame) % 4 == 0 and len(frame) // 4 in (len(names), *_numbers()) else 3
        if len(frame) % width:
            raise _Wrong(f"found {len(frame)} numbers, expected three or four a point")
        frame = [frame[i : i + width] for i in range(0, len(frame), width)]
    if not isinstance(frame, list) or not frame:
        return None, own
    return np.array([_point(value) for value in frame]), own


def _numbers() -> list[int]:
    return [len(names) for names in KEYPOINTS.values()]


def _person(frame: Any) -> Any:
    """The points of the one person of a frame."""
    if isinstance(frame, Mapping) and "people" in frame:
        people = frame["people"]
        if not isinstance(people, list) or len(people) > 1:
            raise _Wrong(f"found {len(people) if isinstance(people, list) else people!r} people, expected one")
        frame = people[0] if people else None
    if not isinstance(frame, Mapping):
        return frame
    found = next((frame[key] for key in _POINTS if frame.get(key)), None)
    if found is not None:
        return found
    flat = next((key for key in _FLAT if frame.get(key)), None)
    if flat:
        raise _Wrong(f"found {flat!r}, points in the plane of a picture; expected points in space (x, y and z)")
    return None if any(key in frame for key in (*_POINTS, *_FLAT)) or not frame else frame


def _point(value: Any) -> list[float]:
    """x, y, z and a score of 1 where none is given; nan for a point that is not there."""
    if value is None:
        return [np.nan, np.nan, np.nan, 1.0]
    if isinstance(value, Mapping):
        if "z" not in value:
            raise _Wrong(
                f"found a point of {', '.join(map(str, value))}, in the plane of a picture; expected x, y and z"
            )
        score = next((value[key] for key in _SCORES if key in value), 1.0)
        value = [value.get("x"), value.get("y"), value["z"], score]
    if not isinstance(value, list) or len(value) not in (3, 4):
        if isinstance(value, list) and len(value) == 2:
            raise _Wrong("found two numbers a point, in the plane of a picture; expected three: x, y and z in space")
        raise _Wrong(f"found {str(value)[:40]!r} as a point, expected x, y, z and perhaps a score")
    numbers = [np.nan if number is None else number for number in value]
    if not all(isinstance(number, int | float) and not isinstance(number, bool) for number in numbers):
        raise _Wrong(f"found {str(value)[:60]} as a point, expected numbers")
    if any(abs(number) > 1e30 for number in numbers):
        raise _Wrong(f"found {str(value)[:60]} as a point, expected finite numbers")
    return [*map(float, numbers), *([1.0] if len(numbers) == 3 else [])]
