"""Points by columns: markers or keypoints as CSV or TSV, with the header of whoever wrote it, or with none.

Read are: one header row (``LKNE_x,LKNE_y,LKNE_z``, anipose's with scores besides), names over coordinates (Vicon Nexus,
OptiTrack Motive, DeepLabCut's several rows), Qualisys TSV (``MARKER_NAMES``), and bare numbers with a file of names.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from emulator.recordings.columns import Columns, columns_of, in_threes, rate_of, read_names, without_missing_frames
from emulator.recordings.joint_names import KEYPOINTS
from emulator.recordings.markers import PLUG_IN_GAIT
from emulator.recordings.orientation import UNITS_M, placed
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError, Table, number_of, read_table

MIN_SCORE = 0.3
"""A point of less confidence is not there: half of what trackers call certain, and more than their guesses."""
KNOWN_COLUMNS: dict[str, tuple[str, ...]] = {"plug-in-gait": PLUG_IN_GAIT, **KEYPOINTS}
"""Names of columns that need no file."""
_RATE_WORDS = ("frequency", "export frame rate", "capture frame rate", "frame rate", "datarate", "fps", "sampling rate")
_UNIT_WORDS = {
    "mm": "mm", "millimeters": "mm", "millimetres": "mm", "cm": "cm", "centimeters": "cm", "centimetres": "cm",
    "m": "m", "meters": "m", "metres": "m", "inches": "inch", "in": "inch", "feet": "ft",
}  # fmt: skip


def read_csv(
    path: Path,
    *,
    unit_m: float | None = None,
    up: str | None = None,
    rate_hz: float | None = None,
    columns: Path | str | None = None,
    min_score: float = MIN_SCORE,
) -> Take:
    """The points of a CSV or TSV in metres, z up; nan where a cell is empty, all three are 0, or the score too low.

    columns : a file of names in the order of the columns, or "plug-in-gait"; for numbers without a header
    Raises RecordingError with the lines, and where unit, axis or rate are neither given nor to be found.
    """
    table = read_table(path)
    if columns is None and not table.header:
        raise _nameless(path, table.values.shape[1], rate_hz)
    names = _qualisys_names(table) if columns is None else _named(columns)
    if names:
        found = in_threes(path, names, _width(table.values, 3 * len(names)))
    else:
        found = columns_of(path, table.header, table.header_line, table.values.shape[1])
    positions, notes = points_of(table.values, found, min_score)
    rate, said = rate_of(path, rate_hz, _said_rate(table), table.values, found, table.line)
    positions, more = without_missing_frames(path, positions, table.values, found)
    unit_m, unit_note = (unit_m, ()) if unit_m is not None else _said_unit(table)
    places, found_notes = placed(positions, tuple(found.points), unit_m=unit_m, up=up, where=str(path))
    return Take(tuple(found.points), None, places, rate, notes=(*said, *more, *unit_note, *found_notes, *notes))


def points_of(values: np.ndarray, columns: Columns, min_score: float) -> tuple[np.ndarray, list[str]]:
    """Positions (T, J, 3) with gaps as nan, and notes on how many were made."""
    at = np.array([columns.points[name] for name in columns.points])
    positions = values[:, at]
    notes = []
    nothing = (positions == 0).all(axis=-1)
    if nothing.any():
        positions[nothing] = np.nan
        notes.append(f"{nothing.sum()} points at exactly 0, 0, 0 are gaps")
    doubted = np.zeros(positions.shape[:2], bool)
    for i, name in enumerate(columns.points):
        if name in columns.score:
            doubted[:, i] = values[:, columns.score[name]] < min_score
    if doubted.any():
        positions[doubted] = np.nan
        notes.append(f"{doubted.sum()} points with a confidence below {min_score:g} are gaps")
    return positions, notes


def _named(columns: Path | str) -> Sequence[str]:
    if str(columns) in KNOWN_COLUMNS:
        return KNOWN_COLUMNS[str(columns)]
    if not Path(columns).is_file():
        known = ", ".join(KNOWN_COLUMNS)
        raise RecordingError(f"{columns}: no such file, expected one with the names of the points, or {known}")
    return read_names(Path(columns))


def _nameless(path: Path, width: int, rate_hz: float | None) -> RecordingError:
    fitting = [name for name, names in KNOWN_COLUMNS.items() if len(names) == width / 3]
    hint = f" ({width // 3} points are perhaps {fitting[0]})" if fitting else ""
    timed = width % 3 == 2  # a frame and a time in front
    rate = "" if rate_hz is not None or timed else ", and give the frames a second with --rate"
    return RecordingError(
        f"{path}: found {width} columns of numbers without names, expected a header; "
        f"name them with --columns{hint}{rate}"
    )


def _width(values: np.ndarray, least: int) -> int:
    """Columns of a table without those at its end that are empty, as a sign at the end of each row makes one."""
    width = values.shape[1]
    while width > least and np.isnan(values[:, width - 1]).all():
        width -= 1
    return width


def _qualisys_names(table: Table) -> list[str]:
    row = next((row for row in table.header if row and row[0].upper() == "MARKER_NAMES"), ())
    return [name for name in row[1:] if name]


def _said_rate(table: Table) -> float | None:
    """Frames a second by the header: after its word, or Vicon's second line."""
    for row in table.header:
        for word, value in pairwise(row):
            if word.lower() in _RATE_WORDS:
                return number_of(value)
    for row, after in pairwise(table.header):
        if row[0].lower() in ("trajectories", "model outputs"):
            return number_of(after[0])
    return None


def _said_unit(table: Table) -> tuple[float | None, tuple[str, ...]]:
    """Metres of one unit by the header: after Length Units, or a row of nothing but units."""
    for row in table.header:
        for word, value in pairwise(row):
            if word.lower() in ("length units", "units") and value.lower() in _UNIT_WORDS:
                return UNITS_M[_UNIT_WORDS[value.lower()]], (f"unit said by the file: {value}",)
        words = {cell.lower() for cell in row if cell}
        if len(words) == 1 and words <= set(_UNIT_WORDS) and len(row) > 3:
            word = words.pop()
            return UNITS_M[_UNIT_WORDS[word]], (f"unit said by the file: {word}",)
    return None, ()
