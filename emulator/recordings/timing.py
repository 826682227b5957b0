"""The rate of frames and the frames left out, by columns of time and frame numbers, by the header, by the user."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.columns import Columns

SLOWEST_HZ, FASTEST_HZ = 1.0, 10_000.0
SLOWEST_STEP_S = 1.0
"""Larger steps of time are milliseconds."""
UNEVEN = 0.2
"""Steps of time may differ by this share of the middle one: clocks jitter, or times are rounded."""
MOST_FILLED = 4
"""Frames that are left out in a file may make it this many times as long."""


def refuse_short(path: Path, n_frames: int) -> None:
    """Raises RecordingError for a take that does not move."""
    if n_frames < 2:
        raise RecordingError(f"{path}: {short(n_frames)}")


def short(n_frames: int) -> str:
    """What is wrong with a take of so few frames."""
    return f"found {n_frames} frame{'s' * (n_frames != 1)}, expected 2 or more"


def rate_of(
    path: Path, given_hz: float | None, said_hz: float | None, values: np.ndarray, columns: Columns, line: np.ndarray
) -> tuple[float, tuple[str, ...]]:
    """Frames a second as given, as said by the header, or by the steps of the time column; and notes.

    Raises RecordingError where none is known, where it is no rate of people, or where time does not run evenly.
    """
    refuse_short(path, len(values))
    timed, notes = None, []
    if columns.time is not None:
        timed = _timed_hz(path, values[:, columns.time], line, even=given_hz is None and columns.frame is None)
    hz = next((hz for hz in (given_hz, said_hz, timed) if hz is not None and np.isfinite(hz)), None)
    if hz is None:
        raise RecordingError(f"{path}: found no frame rate and no column of time, expected one; give it with --rate")
    if not SLOWEST_HZ <= hz <= FASTEST_HZ:
        raise RecordingError(f"{path}: found {hz:g} frames a second, expected {SLOWEST_HZ:g} to {FASTEST_HZ:g}")
    if given_hz is None and said_hz is None and timed is not None:
        notes.append(f"rate by the column of time: {hz:g} a second")
    if timed is not None and abs(timed / hz - 1) > 0.02 and np.isfinite(timed):
        notes.append(f"the column of time says {timed:.4g} frames a second, {hz:g} is used")
    return float(hz), tuple(notes)


def _timed_hz(path: Path, time: np.ndarray, line: np.ndarray, *, even: bool) -> float:
    """Frames a second by times in seconds, or in milliseconds where they would be too slow otherwise."""
    step = np.diff(time)
    if not np.isfinite(step).all() or np.any(step <= 0):
        i = int(np.argmax(~(step > 0)))
        raise RecordingError(f"{path}:{line[i + 1]}: found time {time[i + 1]:g} after {time[i]:g}, expected it to rise")
    middle = float(np.median(step))
    uneven = np.flatnonzero(np.abs(step - middle) > UNEVEN * middle)
    if even and len(uneven) > 0.02 * len(step):
        i = int(uneven[0])
        raise RecordingError(
            f"{path}:{line[i + 1]}: found a step of {step[i]:g} in time, expected {middle:g} as in most rows; "
            "give even frames, or their rate with --rate"
        )
    mean = float(np.mean(np.delete(step, uneven))) if len(uneven) < len(step) else middle
    return 1.0 / mean if mean < SLOWEST_STEP_S else 1000.0 / mean


def without_missing_frames(
    path: Path, positions: np.ndarray, values: np.ndarray, columns: Columns
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Positions (T, J, 3) with nan in the frames that the numbers of the frame column leave out."""
    if columns.frame is None:
        return positions, ()
    frame = values[:, columns.frame]
    if not np.isfinite(frame).all() or np.any(frame != np.round(frame)) or np.any(np.diff(frame) <= 0):
        return positions, ("the column of frame numbers does not count; it is not used",)
    step = np.diff(frame)
    at = np.round((frame - frame[0]) / step.min()).astype(np.int64)
    n_frames = int(at[-1]) + 1
    if n_frames == len(positions):
        return positions, ()
    if n_frames > MOST_FILLED * len(positions):
        raise RecordingError(
            f"{path}: found {len(positions)} rows for frames {frame[0]:g} to {frame[-1]:g}, expected most of them"
        )
    filled = np.full((n_frames, *positions.shape[1:]), np.nan)
    filled[at] = positions
    return filled, (f"{n_frames - len(positions)} frames are left out in the file; they are gaps",)
