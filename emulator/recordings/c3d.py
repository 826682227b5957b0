"""C3D, the exchange format of motion laboratories: labelled points; angles, forces and analog channels are left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.axes import UNITS_M, placed
from emulator.recordings.c3d_parts import BLOCK, MIPS, C3dError, Header, Parameter, floats_of, read_header
from emulator.recordings.take import Take
from emulator.recordings.text import said_twice
from emulator.recordings.timing import FASTEST_HZ, SLOWEST_HZ, short

MOST_BYTES = 4 * 2**30
_NO_POINTS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS", "MODELED_MARKERS")
"""Groups of labels that Vicon's models add; the last is of points, yet of such as are made from others."""


def read_c3d(path: Path, *, unit_m: float | None = None, up: str | None = None) -> Take:
    """The labelled points of a C3D file in metres, z up; nan where the residual says that a point was not seen.

    Raises RecordingError for what is no C3D file, or one that does not hold the frames that it declares.
    """
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise RecordingError(f"{path}: found {size / 2**30:.1f} GB, expected {MOST_BYTES >> 30} at most")
    content = path.read_bytes()
    try:
        header = read_header(content)
        points = _points(content, header)
        rate_hz = _rate(header)
        names, at, left_out = _labels(header, points.shape[1])
    except C3dError as why:
        raise RecordingError(f"{path}: {why}") from None
    notes = [f"{left_out} points without a name, or that are no places, are left out"] if left_out else []
    if unit_m is None and (said := _unit(header)):
        unit_m = UNITS_M[said]
        notes.append(f"unit said by the file: {said}")
    places, found = placed(points[:, at], names, unit_m=unit_m, up=up, where=str(path))
    return Take(tuple(names), None, places, rate_hz, notes=(*notes, *found))


def _points(content: bytes, header: Header) -> np.ndarray:
    """Points (T, J, 3) in the file's unit, nan where the fourth number is negative."""
    start = (int(_number(header, "POINT:DATA_START") or header.data_start) - 1) * BLOCK
    n_points = int(_number(header, "POINT:USED") or header.n_points)
    n_frames = _n_frames(header)
    scale = _number(header, "POINT:SCALE") or header.scale
    width = 4 if not scale > 0 else 2
    frame_bytes = (4 * n_points + header.analog_per_frame) * width
    if n_points < 1:
        raise C3dError("found no points, only other channels")
    if n_frames < 2:
        raise C3dError(short(n_frames))
    held = max(0, len(content) - start) // frame_bytes if start >= BLOCK else 0
    if held < n_frames:
        raise C3dError(
            f"declares {n_frames} frames of {n_points} points from block {start // BLOCK + 1} on, and holds {held}"
        )
    rows = np.frombuffer(content, "u1", n_frames * frame_bytes, start).reshape(n_frames, frame_bytes)
    raw = np.ascontiguousarray(rows[:, : 4 * n_points * width])
    if width == 4:
        values = floats_of(raw, header.processor).reshape(n_frames, n_points, 4)
    else:
        whole = raw.view(">i2" if header.processor == MIPS else "<i2").reshape(n_frames, n_points, 4)
        values = whole * np.array([scale, scale, scale, 1.0])
    points = np.where(values[..., 3:] >= 0, values[..., :3], np.nan)
    points[~(np.abs(points) < 1e9).all(axis=-1)] = np.nan
    return points


def _n_frames(header: Header) -> int:
    """By the header, or by TRIAL or POINT:FRAMES where it is longer than the header's two bytes can say."""
    frames = header.last_frame - header.first_frame + 1
    first, last = (_pair(header, f"TRIAL:ACTUAL_{word}_FIELD") for word in ("START", "END"))
    if last is not None and first is not None:
        frames = max(frames, last - first + 1)
    if header.last_frame == 65535:
        frames = max(frames, int(_number(header, "POINT:FRAMES") or 0))
    return frames


def _pair(header: Header, name: str) -> int | None:
    """A number kept in two words, the lower first."""
    parameter = header.parameters.get(name)
    if parameter is None or len(parameter.values) != 2 or not np.isfinite(parameter.values).all():
        return None
    return int(parameter.values[0]) + 65536 * int(parameter.values[1])


def _rate(header: Header) -> float:
    rate_hz = _number(header, "POINT:RATE") or header.rate_hz
    if not SLOWEST_HZ <= rate_hz <= FASTEST_HZ:
        raise C3dError(f"found {rate_hz:g} frames a second, expected {SLOWEST_HZ:g} to {FASTEST_HZ:g}")
    return rate_hz


def _unit(header: Header) -> str | None:
    words = header.parameters.get("POINT:UNITS", Parameter(np.empty(0))).text
    word = words[0].lower() if words else ""
    return word if word in UNITS_M else None


def _labels(header: Header, n_points: int) -> tuple[list[str], list[int], int]:
    """Names of the points that are named and are places, their numbers, and how many are left out."""
    labels: list[str] = []
    for name in ("LABELS", *(f"LABELS{i}" for i in range(2, 20))):
        labels += header.parameters.get(f"POINT:{name}", Parameter(np.empty(0))).text
    labels = [*labels[:n_points], *[""] * (n_points - len(labels))]
    others = {word for group in _NO_POINTS for word in header.parameters.get(f"POINT:{group}", _EMPTY).text}
    at = [i for i, label in enumerate(labels) if label and not label.startswith("*") and label not in others]
    wrong = said_twice(
        [labels[i] for i in at], "POINT:LABELS", [i + 1 for i in at], "give each point a label of its own"
    )
    if wrong:
        raise C3dError("; ".join(wrong[:5]))
    if not at:
        raise C3dError(f"found {n_points} points, none of them with a label")
    return [labels[i] for i in at], at, n_points - len(at)


_EMPTY = Parameter(np.empty(0))


def _number(header: Header, name: str) -> float | None:
    """The first number of a parameter; None where there is none or it is no number."""
    values = header.parameters.get(name, _EMPTY).values
    return float(values[0]) if len(values) and np.isfinite(values[0]) else None
