"""Header and parameters of a C3D file by its specification (c3d.org, 2008), for Intel, DEC and MIPS processors.

NOTE: read by hand and not with ezc3d, which died (segmentation fault) on 9 of 400 files with 1 to 16 changed bytes; it
is the oracle of the tests. Nothing here is allocated by what a file declares before that is held against its size.

C3D, the exchange format of motion laboratories: labelled points; angles, forces and analog channels are left out.

TRC: markers by tabs, as Motion Analysis writes and OpenSim reads them; five lines of header, then a row a frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from emulator.recordings.columns import FASTEST_HZ, SLOWEST_HZ, Columns, rate_of, short, without_missing_frames
from emulator.recordings.marker_csv import points_of
from emulator.recordings.orientation import UNITS_M, placed, said_unit
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError, decoded, number_of, quoted, read_table, said_twice

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86


class C3dError(ValueError):
    """Bytes that are no C3D file; the message does not name the file."""


@dataclass(frozen=True)
class Parameter:
    """``values`` flat, the first dimension fastest; text as a list of strings in ``text``."""

    values: np.ndarray
    text: tuple[str, ...] = ()


@dataclass(frozen=True)
class Header:
    """The numbers of the first block; ``data_start`` is a block number from 1."""

    processor: int
    n_points: int
    analog_per_frame: int
    first_frame: int
    last_frame: int
    scale: float
    data_start: int
    rate_hz: float
    parameters: dict[str, Parameter] = field(default_factory=dict)


def read_header(content: bytes) -> Header:
    """The header with its parameters, by ``GROUP:NAME`` in capitals. Raises C3dError."""
    if len(content) < 2 * BLOCK:
        raise C3dError(f"found {len(content)} bytes, expected {2 * BLOCK} at least")
    if content[1] != 0x50:
        raise C3dError(f"found {content[1]:#04x} as second byte, expected 0x50, by which a C3D file is known")
    start = (content[0] - 1) * BLOCK
    if start < BLOCK or start + 4 > len(content):
        raise C3dError(f"found the parameters in block {content[0]}, expected 2 to {len(content) // BLOCK}")
    processor = content[start + 3]
    if processor not in (INTEL, DEC, MIPS):
        raise C3dError(f"found processor type {processor}, expected 84 (Intel), 85 (DEC) or 86 (MIPS)")
    words = np.frombuffer(content, ">u2" if processor == MIPS else "<u2", 12)
    floats = floats_of(content[:48], processor)
    return Header(
        processor,
        n_points=int(words[1]),
        analog_per_frame=int(words[2]),
        first_frame=int(words[3]),
        last_frame=int(words[4]),
        scale=float(floats[3]),
        data_start=int(words[8]),
        rate_hz=float(floats[5]),
        parameters=_parameters(content[start:], processor),
    )


def floats_of(content: bytes | np.ndarray, processor: int) -> np.ndarray:
    """Numbers of four bytes each in the way of a processor, as double precision."""
    if processor == DEC:  # VAX F-floating: words exchanged, and four times as large
        words = np.frombuffer(content, "<u2").reshape(-1, 2)[:, ::-1]
        with np.errstate(invalid="ignore", over="ignore"):
            return np.ascontiguousarray(words).view("<f4").reshape(-1).astype(float) / 4
    with np.errstate(invalid="ignore"):
        return np.frombuffer(content, ">f4" if processor == MIPS else "<f4").astype(float)


def _parameters(section: bytes, processor: int) -> dict[str, Parameter]:
    """Of the parameter section all that can be read; what points outside of it ends the reading."""
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Parameter]] = []
    end = min(len(section), max(section[2], 1) * BLOCK)
    at = 4
    while at + 4 <= end:
        length, number = abs(_signed(section[at])), _signed(section[at + 1])
        name = section[at + 2 : at + 2 + length].decode("latin-1").strip().upper()
        link = at + 2 + length
        if not length or not number or link + 2 > end:
            break
        if number < 0:
            groups[-number] = name
        else:
            parameter = _parameter(section[link + 2 : end], processor)
            if parameter is not None:
                found.append((number, name, parameter))
        step = int.from_bytes(section[link : link + 2], "big" if processor == MIPS else "little")
        if step < 2:
            break
        at = link + step
    return {f"{groups.get(number, '')}:{name}": parameter for number, name, parameter in found}


def _parameter(content: bytes, processor: int) -> Parameter | None:
    """A parameter from its type on; None where it does not fit into the rest of the section."""
    if len(content) < 2 or len(content) < 2 + content[1]:
        return None
    kind, dimensions = _signed(content[0]), list(content[2 : 2 + content[1]])
    count = int(np.prod(dimensions, dtype=np.int64)) if len(dimensions) < 8 else -1
    size = {-1: 1, 1: 1, 2: 2, 4: 4}.get(kind, 0) * count
    data = content[2 + len(dimensions) : 2 + len(dimensions) + size]
    if size <= 0 or len(data) < size:
        return None
    if kind == -1:
        width = dimensions[0] if dimensions else 1
        words = [data[i : i + width] for i in range(0, len(data), width)]
        return Parameter(np.empty(0), tuple(word.decode("utf-8", "replace").strip(" \0") for word in words))
    if kind == 4:
        return Parameter(floats_of(data, processor))
    return Parameter(np.frombuffer(data, "u1" if kind == 1 else ">u2" if processor == MIPS else "<u2").astype(float))


def _signed(byte: int) -> int:
    return byte - 256 if byte > 127 else byte


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
