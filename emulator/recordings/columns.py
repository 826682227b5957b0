"""Which columns of a table are x, y and z of which point: names in one header row or over rows of coordinates.

The rate of frames and the frames left out, by columns of time and frame numbers, by the header, by the user.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from emulator.recordings.text import RecordingError, quoted, text_lines

_COORDINATE = re.compile(r"^(?:pos(?:ition)?[\s_.]*)?([xyz])\d*(?:\s*[\[(].*[\])])?$", re.IGNORECASE)
_AXIS_LAST = re.compile(r"([xyz])(?:[ \t]*[\[(][^\[\]()]*[\])])?$", re.IGNORECASE)
_SCORE_LAST = re.compile(r"(?:score|likelihood|confidence|conf|visibility|c|p)$", re.IGNORECASE)
_POSITION_LAST = re.compile(r"pos(?:ition)?$", re.IGNORECASE)
_BETWEEN = " \t_.:-/"
"""What stands between a name and its axis. NOTE: cut off by hand: patterns with two runs of these are cubic."""
_TYPES = ("Bone", "Marker", "Bone Marker", "Rigid Body Marker", "Rigid Body")
"""What Motive exports; the first of these that a file has is read."""
_SCORES = {"score", "likelihood", "confidence", "conf", "visibility", "c", "p"}
TIME = re.compile(r"^(time|timestamp|t)\b.*$|^time", re.IGNORECASE)
FRAME = re.compile(r"^(frame|frames|fnum|frame#|field|sample|index|frame_?(no|number|index|id))\.?$", re.IGNORECASE)


@dataclass
class Columns:
    """Column numbers: of each point its (x, y, z) and its score, and of time and frame where they are given."""

    points: dict[str, tuple[int, int, int]] = field(default_factory=dict)
    score: dict[str, int] = field(default_factory=dict)
    time: int | None = None
    frame: int | None = None


def columns_of(path: Path, header: Sequence[Sequence[str]], header_line: Sequence[int], width: int) -> Columns:
    """The columns by the header rows. Raises RecordingError for none, two of one name, and points without z."""
    coordinates = next((i for i in reversed(range(len(header))) if _is_coordinates(header[i])), None)
    if coordinates is not None:
        labels = _over(header, coordinates, width)
    else:
        row = next((i for i in reversed(range(len(header))) if sum(map(bool, header[i])) > 2), None)
        if row is None:
            raise RecordingError(
                f"{path}: found {width} columns of numbers without names, expected a header; name them with --columns"
            )
        labels = [_split(label) for label in header[row]]
        coordinates = row
    return _gathered(path, header_line[coordinates], labels, width)


def _is_coordinates(row: Sequence[str]) -> bool:
    axes = [found.group(1).lower() for cell in row if (found := _COORDINATE.match(cell))]
    return axes.count("x") > 1 and axes.count("x") == axes.count("y")


def _over(header: Sequence[Sequence[str]], at: int, width: int) -> list[tuple[str, str]]:
    """(name, what) of each column: the name stands in a row above, over the first of its columns or over each."""
    row = [*header[at], *[""] * width][:width]
    words = [cell.lower() for cell in row]
    above = _names_row(header, at)
    over = _passed_over(header, at)
    labels: list[tuple[str, str]] = []
    name = ""
    for i, word in enumerate(words):
        given = above[i] if i < len(above) else ""
        name = given or name
        found = _COORDINATE.match(word)
        if i < len(over) and over[i]:
            labels.append(("", ""))
        elif found:
            labels.append((name, found.group(1).lower()))
        elif word in _SCORES:
            labels.append((name, "score"))
        else:
            labels.append((word or given, ""))
    return labels


def _names_row(header: Sequence[Sequence[str]], at: int) -> list[str]:
    """The row of names: of those above the coordinates the one that says most over the x's; in Motive it says Name."""
    for row in header[:at]:
        if any(cell.lower() in ("name", "bodyparts") for cell in row[:2]):
            return ["" if cell.lower() in ("name", "bodyparts") else cell for cell in row]
    first = [i for i, cell in enumerate(header[at]) if (found := _COORDINATE.match(cell)) and found[1].lower() == "x"]

    def names(row: Sequence[str]) -> int:
        return len({row[i] for i in first if i < len(row)} - {""})

    above = [list(row) for row in reversed(header[:at])]
    return max(above, key=names, default=[])


def _passed_over(header: Sequence[Sequence[str]], at: int) -> list[bool]:
    """Columns that are no places: rotations and errors, and what Motive solves from bones where it has the bones."""
    kinds = next((row for row in header[:at] if sum(cell == "Position" for cell in row) > 2), [])
    types = next((row for row in header[:at] if sum(cell in _TYPES for cell in row) > 2), [])
    wanted = next((kind for kind in _TYPES if kind in types), "")
    n = max(len(kinds), len(types))
    other = [i < len(kinds) and kinds[i] not in ("", "Position") for i in range(n)]
    return [other[i] or (i < len(types) and types[i] in _TYPES and types[i] != wanted) for i in range(n)]


def _split(label: str) -> tuple[str, str]:
    if TIME.match(label) or FRAME.match(label):
        return label, ""
    score = _SCORE_LAST.search(label)
    if score and (name := label[: score.start()]) != (bare := name.rstrip(_BETWEEN)) and bare:
        return bare, "score"
    axis = _AXIS_LAST.search(label)
    if not axis or not (name := label[: axis.start()].rstrip(_BETWEEN)):
        return label, ""
    return _POSITION_LAST.sub("", name).rstrip(_BETWEEN) or name, axis.group(1).lower()


def _gathered(path: Path, line: int, labels: Sequence[tuple[str, str]], width: int) -> Columns:
    columns, wrong = Columns(), []
    twice: dict[str, tuple[int, int]] = {}
    axes: dict[str, dict[str, int]] = {}
    for i, (name, what) in enumerate(labels):
        if i >= width and what not in ("x", "y", "z"):
            continue
        if what in ("x", "y", "z"):
            own = axes.setdefault(name, {})
            if what in own:
                twice.setdefault(name, (own[what], i))
            own.setdefault(what, i)
        elif what == "score":
            columns.score[name] = i
        elif columns.time is None and TIME.match(name):
            columns.time = i
        elif columns.frame is None and FRAME.match(name):
            columns.frame = i
    for name, (here, there) in twice.items():
        found = f"{quoted(name)} twice, its {labels[here][1]} in columns {here + 1} and {there + 1}"
        wrong.append(f"{path}:{line}: found {found}; give each point a name of its own")
    flat = [name for name, own in axes.items() if set(own) == {"x", "y"}]
    if flat and not any(len(own) == 3 for own in axes.values()):
        raise RecordingError(
            f"{path}:{line}: found two coordinates a point, in the plane of a picture; expected x, y and z in space"
        )
    for name, own in axes.items():
        if len(own) == 3:
            columns.points[name] = (own["x"], own["y"], own["z"])
        elif len(own) == 2:  # one alone is another word that ends in x, y or z
            wrong.append(f"{path}:{line}: {quoted(name)}: found {', '.join(sorted(own))}, expected x, y and z")
    if wrong:
        raise RecordingError("\n".join(wrong[:10]))
    if len(labels) > width and any(max(at) >= width for at in columns.points.values()):
        raise RecordingError(
            f"{path}:{line}: found names of {len(labels)} columns, expected {width} as in the rows below"
        )
    if not columns.points:
        raise RecordingError(
            f"{path}:{line}: found no columns such as 'LKNE_x, LKNE_y, LKNE_z', expected three a point; "
            "name them with --columns"
        )
    return columns


def read_names(path: Path) -> list[str]:
    """Names of points, one a line, or by commas or blanks; ``#`` begins a remark. Raises RecordingError."""
    names: list[str] = []
    wrong = []
    for number, line in text_lines(path):
        text = line.split("#", 1)[0].strip()
        words = [text] if not re.search(r"[,;\t]", text) and "\n" not in text else re.split(r"[,;\t]+", text)
        for word in (each.strip().strip('"') for each in words):
            if word in names:
                wrong.append(f"{path}:{number}: found {quoted(word)} a second time")
            if word:
                names.append(word)
    if len(names) == 1 and " " in names[0]:
        names = names[0].split()
    if not names and not wrong:
        wrong.append(f"{path}: found no name, expected the names of the points in the order of their columns")
    if wrong:
        raise RecordingError("\n".join(wrong[:10]))
    return names


def in_threes(path: Path, names: Sequence[str], width: int) -> Columns:
    """The columns of a table without header: three a name, perhaps after a frame and a time. Raises RecordingError."""
    before = width - 3 * len(names)
    if before not in (0, 1, 2):
        raise RecordingError(
            f"{path}: found {width} columns, expected {3 * len(names)} for {len(names)} names "
            "(or one or two more in front, frame and time)"
        )
    points = {name: (before + 3 * i, before + 3 * i + 1, before + 3 * i + 2) for i, name in enumerate(names)}
    return Columns(points, frame=0 if before else None, time=1 if before == 2 else None)


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
