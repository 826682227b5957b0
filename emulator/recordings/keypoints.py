"""A folder of keypoints with a file a frame, as OpenPose writes them: ``take_000000000012_keypoints.json``.

Frames of keypoints as trackers write them, whatever their form: lists, objects by name, flat numbers, people.

Keypoints of markerless trackers as JSON: a list of frames of points in space, with the names or in a known order.

Read are: frames as lists ``[[x, y, z(, score)], ...]``, as ``{name: [x, y, z]}``, as ``[{"x":, "y":, "z":,
"visibility":}]`` (world landmarks of MediaPipe), flat as ``pose_keypoints_3d`` of OpenPose; one object with ``frames``
(or ``positions``, ``keypoints``), ``names`` and ``fps``; or a bare list. CSV of trackers: ``marker_csv.py``.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from emulator.recordings.columns import FASTEST_HZ, SLOWEST_HZ, read_names, refuse_short
from emulator.recordings.joint_names import KEYPOINTS, names_by_number
from emulator.recordings.marker_csv import MIN_SCORE
from emulator.recordings.orientation import UNITS_M, placed, said_unit
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError, said_twice

KEYPOINT_FILES = "*_keypoints.json"


def is_keypoint_folder(path: Path) -> bool:
    """Whether this is a folder with at least one such file."""
    return "\0" not in str(path) and path.is_dir() and next(path.glob(KEYPOINT_FILES), None) is not None


def keypoint_files(folder: Path) -> list[Path]:
    """The files by the numbers in their names: frame 2 before frame 10."""
    return sorted(folder.glob(KEYPOINT_FILES), key=lambda file: (_in_order(file.name), file.name))


def _in_order(name: str) -> list[tuple[int, str]]:
    parts = re.split(r"([0-9]+)", name)
    return [(int(part), "") if i % 2 else (0, part) for i, part in enumerate(parts)]


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


MOST_BYTES = 512 * 2**20
_FRAMES = ("frames", "positions", "keypoints", "keypoints_3d", "poses", "landmarks", "data")
_NAMES = ("names", "joint_names", "keypoint_names", "labels", "bodyparts", "joints")
_RATES = ("rate_hz", "fps", "frame_rate", "framerate", "frequency")


def read_json(
    path: Path,
    *,
    unit_m: float | None = None,
    up: str | None = None,
    rate_hz: float | None = None,
    columns: Path | str | None = None,
    min_score: float = MIN_SCORE,
) -> Take:
    """The keypoints of a JSON file in metres, z up; nan where one is missing or its score is below ``min_score``.

    columns : a file of the names in their order, or the name of a known set (``KEYPOINTS``)
    Raises RecordingError with line or frame; for keypoints in the plane of a picture; for several people in a frame.
    """
    document = _document(path)
    frames = _frames(path, document)
    said = document if isinstance(document, Mapping) else {}
    points, names = points_of_frames(path, frames, _names(path, said, columns))
    notes = [] if names else [f"names by their number: {names_by_number(points.shape[1])[0]}"]
    names = names or list(names_by_number(points.shape[1])[1])
    if len(names) != points.shape[1]:
        raise RecordingError(
            f"{path}: found {points.shape[1]} points a frame, expected {len(names)} as there are names"
        )
    remedy = "give each point a name of its own, here or with --columns"
    wrong = said_twice(names, "point", range(1, len(names) + 1), remedy)
    if wrong:
        raise RecordingError("\n".join(f"{path}: {each}" for each in wrong[:5]))
    positions, doubted = points[..., :3].copy(), points[..., 3] < min_score
    if np.nanmax(np.abs(positions[..., 2]), initial=0.0) == 0:
        raise RecordingError(f"{path}: found 0 in every z, points in the plane of a picture; expected points in space")
    positions[doubted] = np.nan
    if doubted.any():
        notes.append(f"{doubted.sum()} points with a confidence below {min_score:g} are gaps")
    rate = _rate(path, said, rate_hz)
    if unit_m is None and isinstance(unit := said.get("unit", said.get("units")), str):
        unit_m = UNITS_M.get(unit.lower())
        notes.append(said_unit(unit, unit_m))
    places, found = placed(positions, names, unit_m=unit_m, up=up, where=str(path))
    return Take(tuple(names), None, places, rate, notes=(*notes, *found))


def _document(path: Path) -> Any:
    """The JSON; of a folder of one file a frame the list of all frames."""
    if path.is_dir():
        files = keypoint_files(path)
        if sum(file.stat().st_size for file in files) > MOST_BYTES:
            raise RecordingError(f"{path}: found more than {MOST_BYTES >> 20} MB, expected less; write it as CSV")
        return [_document(file) for file in files]
    if path.stat().st_size > MOST_BYTES:
        raise RecordingError(f"{path}: found more than {MOST_BYTES >> 20} MB, expected less; write it as CSV")
    try:
        return json.loads(path.read_bytes(), parse_constant=lambda word: float("nan"))
    except json.JSONDecodeError as error:
        raise RecordingError(f"{path}:{error.lineno}:{error.colno}: not JSON: {error.msg}") from None
    except (UnicodeDecodeError, RecursionError, ValueError) as error:
        raise RecordingError(f"{path}: not JSON ({type(error).__name__}: {str(error)[:80]})") from None


def _frames(path: Path, document: Any) -> Sequence[Any]:
    frames = document
    if isinstance(document, Mapping):
        found = next((document[key] for key in _FRAMES if key in document), None)
        frames = found if found is not None else _by_name(document)
    if not isinstance(frames, list) or not frames:
        raise RecordingError(
            f"{path}: found no list of frames, expected one, or an object with {' or '.join(_FRAMES[:3])}"
        )
    refuse_short(path, len(frames))
    return frames


def _by_name(document: Mapping[str, Any]) -> list[Any] | None:
    """Frames out of ``{name: [[x, y, z], ...]}``; None where that is not the form."""
    rows = {key: value for key, value in document.items() if isinstance(value, list) and value}
    rows = {key: value for key, value in rows.items() if isinstance(value[0], list)}
    if len(rows) < 3 or len({len(value) for value in rows.values()}) != 1:
        return None
    return [dict(zip(rows, frame)) for frame in zip(*rows.values())]


def _names(path: Path, said: Mapping[str, Any], columns: Path | str | None) -> list[str]:
    if columns is not None:
        if str(columns) in KEYPOINTS:
            return list(KEYPOINTS[str(columns)])
        if not Path(columns).is_file():
            raise RecordingError(f"{columns}: no such file, expected one with names, or {', '.join(KEYPOINTS)}")
        return read_names(Path(columns))
    for key in _NAMES:
        value = said.get(key)
        if isinstance(value, list) and value and all(isinstance(word, str) for word in value):
            return list(value)
    return []


def _rate(path: Path, said: Mapping[str, Any], given_hz: float | None) -> float:
    rate_hz = given_hz if given_hz is not None else next((said[key] for key in _RATES if key in said), None)
    if rate_hz is None:
        raise RecordingError(
            f"{path}: found no frame rate ({', '.join(_RATES[:3])}), expected one; give it with --rate"
        )
    if not isinstance(rate_hz, int | float) or not SLOWEST_HZ <= rate_hz <= FASTEST_HZ:
        raise RecordingError(f"{path}: found {rate_hz!r} frames a second, expected {SLOWEST_HZ:g} to {FASTEST_HZ:g}")
    return float(rate_hz)
