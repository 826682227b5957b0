"""Keypoints of markerless trackers as JSON: a list of frames of points in space, with the names or in a known order.

Read are: frames as lists ``[[x, y, z(, score)], ...]``, as ``{name: [x, y, z]}``, as ``[{"x":, "y":, "z":,
"visibility":}]`` (world landmarks of MediaPipe), flat as ``pose_keypoints_3d`` of OpenPose; one object with ``frames``
(or ``positions``, ``keypoints``), ``names`` and ``fps``; or a bare list. CSV of trackers: ``marker_csv.py``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.axes import UNITS_M, placed, said_unit
from emulator.recordings.columns import read_names
from emulator.recordings.keypoint_folder import keypoint_files
from emulator.recordings.keypoint_frames import points_of_frames
from emulator.recordings.keypoint_sets import KEYPOINTS, names_by_number
from emulator.recordings.marker_csv import MIN_SCORE
from emulator.recordings.take import Take
from emulator.recordings.text import said_twice
from emulator.recordings.timing import FASTEST_HZ, SLOWEST_HZ, refuse_short

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
