"""TRC: markers by tabs, as Motion Analysis writes and OpenSim reads them; five lines of header, then a row a frame."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.axes import UNITS_M, placed, said_unit
from emulator.recordings.columns import Columns
from emulator.recordings.marker_csv import points_of
from emulator.recordings.table import number_of, read_table
from emulator.recordings.take import Take
from emulator.recordings.text import decoded, quoted, said_twice
from emulator.recordings.timing import rate_of, without_missing_frames

_FIRST = "PathFileType"
_STARTS = {b"HIERARCHY": "BVH", b":version": "ASF", b"{": "JSON", b"[": "JSON", b"PK": "npz"}
_NEEDED = ("DataRate", "NumFrames", "NumMarkers", "Units")
_UNITS = {"meters": "m", "millimeters": "mm", "centimeters": "cm", "inches": "inch"}


def read_trc(path: Path, *, unit_m: float | None = None, up: str | None = None) -> Take:
    """The markers of a TRC file in metres, z up; nan where cells are empty.

    Raises RecordingError with the line: a header that is none, or other numbers of markers and frames than it declares.
    """
    try:
        table = read_table(path, delimiter="\t", first_row=4, short_rows=True)
    except RecordingError as error:
        raise _not_trc(path) or error from None
    said = _header(path, table.header)
    names = _names(path, table.header, table.header_line, said)
    _count(path, "NumFrames", said["NumFrames"], len(table.values))
    columns = Columns({n: (2 + 3 * i, 3 + 3 * i, 4 + 3 * i) for i, n in enumerate(names)}, time=1, frame=0)
    if table.values.shape[1] < 2 + 3 * len(names):
        found = (table.values.shape[1] - 2) / 3
        raise RecordingError(f"{path}:{table.line[0]}: found coordinates of {found:g} markers, expected {len(names)}")
    positions, notes = points_of(table.values, columns, 0.0)
    rate_hz, rate_notes = rate_of(path, None, number_of(said["DataRate"]), table.values, columns, table.line)
    positions, more = without_missing_frames(path, positions, table.values, columns)
    unit = said["Units"].lower()
    said_m = UNITS_M.get(_UNITS.get(unit, unit))
    places, found_notes = placed(positions, names, unit_m=unit_m or said_m, up=up, where=str(path))
    notes = [*rate_notes, *more, said_unit(said["Units"], said_m), *found_notes, *notes]
    return Take(tuple(names), None, places, rate_hz, notes=tuple(notes))


def _not_trc(path: Path) -> RecordingError | None:
    with path.open("rb") as file:
        first = file.read(len(_FIRST) + 8)
    if _FIRST.lower().encode() in first.lower().replace(b"\0", b""):
        return None
    found = decoded(first.split(b"\n")[0]).strip()
    known = next((name for start, name in _STARTS.items() if first.lstrip().startswith(start)), "")
    looks = f"; it looks like a {known}" if known else ""
    return RecordingError(f"{path}:1: found {quoted(found)}, expected {_FIRST!r}, with which a TRC file begins{looks}")


def _header(path: Path, header: tuple[tuple[str, ...], ...]) -> dict[str, str]:
    """The words of line 2 with the values of line 3. Raises RecordingError for those that are missing."""
    if not header or header[0][0].lower() != _FIRST.lower():
        found = header[0][0] if header else ""
        raise RecordingError(f"{path}:1: found {quoted(found)}, expected {_FIRST!r}, with which a TRC file begins")
    said = dict(zip(*(header[1], header[2]))) if len(header) > 2 else {}
    missing = [word for word in _NEEDED if word not in said]
    if missing:
        raise RecordingError(f"{path}:2: found no {', '.join(missing)}, expected them with their values in line 3")
    return said


def _names(path: Path, header: Sequence[Sequence[str]], lines: Sequence[int], said: dict[str, str]) -> list[str]:
    row = next(((line, row) for line, row in zip(lines[3:], header[3:]) if row[0].lower().startswith("frame")), None)
    if row is None:
        raise RecordingError(f"{path}:4: found no line of names, expected 'Frame#', 'Time' and the markers")
    line, cells = row
    column = [i for i, cell in enumerate(cells[2:], 3) if cell]
    names = [cells[i - 1] for i in column]
    wrong = said_twice(names, "column", column, "give each marker a name of its own")
    if wrong:
        raise RecordingError("\n".join(f"{path}:{line}: {each}" for each in wrong[:5]))
    _count(path, "NumMarkers", said["NumMarkers"], len(names))
    if not names:
        raise RecordingError(f"{path}:{line}: found no marker")
    return names


def _count(path: Path, word: str, declared: str, found: int) -> None:
    number = number_of(declared)
    if number is None or not np.isfinite(number):
        raise RecordingError(f"{path}:3: {word}: found {quoted(declared)}, expected a number")
    if number != found:
        raise RecordingError(f"{path}:3: {word} says {quoted(declared)}, found {found} in the file")
