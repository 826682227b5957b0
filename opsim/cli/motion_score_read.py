"""Movements to be scored: the takes of a recording, or performances drawn from a task of a library."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.cli.motion_score_drawn import drawn
from opsim.cli.motion_score_source import Source, between, neutral_of

DRAWN = 10


@dataclass(frozen=True, eq=False)
class Reader:
    """A file that was read: ``measured`` (``motion_score_asked.Asked`` -> Source), and the marks of its movements."""

    measured: Callable[[Any], Source]
    mark_names: tuple[str, ...]


def reader_of(source: str, task: str | None, n: int | None, seed: int) -> Reader:
    """How a recording or ``library/task`` is measured; the file is read now. Raises ValueError, all at once."""
    file = Path(source)
    if "\0" not in source and file.is_file() and not _is_library(file):
        wrong = [f"TASK: found {task!r} beside a recording, expected only its file"] if task is not None else []
        wrong += [f"-n: found {n} beside a recording, expected a library/task to draw from"] if n is not None else []
        takes = _takes(file, wrong)
        return Reader(lambda asked: _recorded(file, takes, asked), tuple(takes.takes[0].mark_frame))
    model = _model(source, task)
    return Reader(lambda asked: drawn(model, n or DRAWN, seed, asked), tuple(getattr(model, "mark_names", ())))


def _is_library(file: Path) -> bool:
    from opsim.cli.motion_files import _kind

    return file.suffix.lower() == ".npz" and _kind(file) == "library"


def _takes(file: Path, wrong: Sequence[str]) -> Any:
    """The takes of a recording, gaps and all."""
    from emulator.recordings.importing import imported, together
    from emulator.recordings.npz import read_recording
    from opsim.cli.motion_score_bodies import wrong_bodies

    mistakes = list(wrong)
    try:
        recording = read_recording(file) if file.suffix.lower() == ".npz" else together(imported(file))
    except (ValueError, OSError) as error:
        mistakes.append(f"{file}: {error.strerror}" if isinstance(error, OSError) and error.strerror else str(error))
        raise ValueError("\n".join(mistakes)) from None
    mistakes += wrong_bodies(recording, str(file))
    if mistakes:
        raise ValueError("\n".join(mistakes))
    return recording


def _model(source: str, task: str | None) -> Any:
    """The emulator of ``library/task``, or of a library and a task beside it."""
    from opsim.cli.motion_files import chosen, found

    library = source
    if task is None and "/" in source and not Path(source).is_file():
        library, _, task = source.rpartition("/")
    try:
        found(library)
    except ValueError as error:
        expected = "a recording (.npz, .bvh, ...), or library/task such as public_movements/deep_squat"
        raise ValueError(f"{source}: found neither a file nor a library, expected {expected}\n{error}") from None
    return chosen(library, task)


def _recorded(file: Path, recording: Any, asked: Any) -> Source:
    import numpy as np

    from opsim.cli.motion_score_bodies import gaps, seen_joints
    from opsim.ergonomics.neutral import neutral_told_rad

    skeleton = _Skeleton(tuple(recording.names), tuple(recording.parents))
    plain = [_movement(take, skeleton, asked, 0.0) for take in recording.takes]
    told = neutral_told_rad(np.array([movement.measures[0] for movement in plain]))
    neutral, said = neutral_of(
        asked.neck_neutral_rad, told, "how the take begins" if len(plain) == 1 else f"how the {len(plain)} takes begin"
    )
    movements = [_movement(take, skeleton, asked, neutral) for take in recording.takes]
    _refuse_unknown(file, movements)
    n, marks = len(movements), tuple(recording.takes[0].mark_frame)
    title = f"{file.name}: {n} take{'s' if n > 1 else ''} ({recording.source})"
    notes = tuple(gaps(recording))
    return Source(title, skeleton, movements, neutral, said, notes, False, marks, seen_joints(recording))


def _refuse_unknown(file: Path, movements: Sequence[Any]) -> None:
    if not any(movement.known.any() for movement in movements):
        raise ValueError(f"{file}: found no posture of which anything is known, expected joints of a body")


@dataclass(frozen=True)
class _Skeleton:
    names: tuple[str, ...]
    parents: tuple[int, ...]


def _movement(take: Any, skeleton: _Skeleton, asked: Any, neutral_rad: float) -> Any:
    """The frames of a take next to the middles of even parts, at most ``rate_hz`` a second; each frame is a while."""
    import numpy as np

    from opsim.ergonomics.measures import measures_of_joints
    from opsim.ergonomics.shift.movement import Movement

    duration_s = take.n_frames / take.rate_hz
    n = min(max(int(np.ceil(duration_s * asked.options.rate_hz)), 1), take.n_frames)
    frames = ((np.arange(n) + 0.5) * take.n_frames / n).astype(int)
    joints_m = take.positions_m[frames]
    measures = measures_of_joints(joints_m, skeleton.names, asked.options, neutral_rad)
    carrying = None
    if asked.loaded is not None:
        carrying = between((frames + 0.5) / take.n_frames, asked.loaded.in_take(take.mark_frame, take.n_frames))
    return Movement(take.name, np.full(n, duration_s / n), measures, joints_m.__getitem__, carrying)
