"""Movements to be scored: the takes of a recording, or performances drawn from a task of a library."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

DRAWN = 10


@dataclass(frozen=True, eq=False)
class Source:
    """What is scored, in words, on which skeleton, and where the neutral of necks comes from.

    movements : ``opsim.ergonomics.movement.Movement`` each;  notes : what was assumed on the way
    walking   : whether they are steps of somebody who walks
    """

    title: str
    skeleton: Any
    movements: list[Any]
    neck_neutral_rad: float
    neutral_said: str
    notes: tuple[str, ...] = ()
    walking: bool = False


Reader = Callable[[Any, float | None], Source]
"""(options, neck neutral or None) -> Source."""


def reader_of(source: str, task: str | None, n: int | None, seed: int) -> Reader:
    """How a recording or ``library/task`` is measured; the file is read now. Raises ValueError, all at once."""
    file = Path(source)
    if "\0" not in source and file.is_file() and not _is_library(file):
        wrong = [f"TASK: found {task!r} beside a recording, expected only its file"] if task is not None else []
        wrong += [f"-n: found {n} beside a recording, expected a library/task to draw from"] if n is not None else []
        takes = _takes(file, wrong)
        return lambda options, neutral_rad: _recorded(file, takes, options, neutral_rad)
    model = _model(source, task)
    return lambda options, neutral_rad: _drawn(model, n or DRAWN, seed, options, neutral_rad)


def _is_library(file: Path) -> bool:
    from opsim.cli.motion_files import _kind

    return file.suffix.lower() == ".npz" and _kind(file) == "library"


def _takes(file: Path, wrong: Sequence[str]) -> Any:
    """The takes of a recording, gaps and all."""
    from emulator.recordings.importing import imported, together
    from emulator.recordings.takes_npz import read_recording

    mistakes = list(wrong)
    try:
        recording = read_recording(file) if file.suffix.lower() == ".npz" else together(imported(file))
    except (ValueError, OSError) as error:
        mistakes.append(f"{file}: {error.strerror}" if isinstance(error, OSError) and error.strerror else str(error))
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


def _recorded(file: Path, recording: Any, options: Any, neutral_rad: float | None) -> Source:
    import numpy as np

    from opsim.ergonomics.neutral import neutral_told_rad

    skeleton = _Skeleton(tuple(recording.names), tuple(recording.parents))
    plain = [_movement(take, skeleton, options, 0.0) for take in recording.takes]
    told = neutral_told_rad(np.array([movement.measures[0] for movement in plain]))
    neutral, said = _neutral(
        neutral_rad, told, "how the take begins" if len(plain) == 1 else f"how the {len(plain)} takes begin"
    )
    movements = [_movement(take, skeleton, options, neutral) for take in recording.takes]
    n = len(movements)
    title = f"{file.name}: {n} take{'s' if n > 1 else ''} ({recording.source})"
    return Source(title, skeleton, movements, neutral, said, tuple(recording.notes))


@dataclass(frozen=True)
class _Skeleton:
    names: tuple[str, ...]
    parents: tuple[int, ...]


def _movement(take: Any, skeleton: _Skeleton, options: Any, neutral_rad: float) -> Any:
    """The frames of a take next to the middles of even parts, at most ``rate_hz`` a second; each frame is a while."""
    import numpy as np

    from opsim.ergonomics.measures import measures_of_joints
    from opsim.ergonomics.movement import Movement

    duration_s = take.n_frames / take.rate_hz
    n = min(max(int(np.ceil(duration_s * options.rate_hz)), 1), take.n_frames)
    frames = ((np.arange(n) + 0.5) * take.n_frames / n).astype(int)
    joints_m = take.positions_m[frames]
    measures = measures_of_joints(joints_m, skeleton.names, options, neutral_rad)
    return Movement(take.name, np.full(n, duration_s / n), measures, joints_m.__getitem__)


def _drawn(model: Any, n: int, seed: int, options: Any, neutral_rad: float | None) -> Source:
    import numpy as np

    from opsim.ergonomics.measures import measures_of, n_cells
    from opsim.ergonomics.movement import Movement
    from opsim.ergonomics.neutral import neck_neutral_told_rad
    from opsim.one_thread import one_blas_thread
    from opsim.provenance import behind

    with one_blas_thread():
        block = model.sample(n, np.random.default_rng(seed))
        neutral, said = _neutral(neutral_rad, neck_neutral_told_rad(model), "how draws of the task begin")
        measures, cells = measures_of(block, range(n), options, neutral), n_cells(block, options)
    movements = [
        Movement(f"draw {k + 1}", np.full(cells, block.duration_s[k] / cells), measures[k], _body(block, k, cells))
        for k in range(n)
    ]
    report = model.report
    title = f"{model.task}: {n} drawn ({behind(report.source, report.n_sequences, report.n_workers)}), seed {seed}"
    return Source(title, model.skeleton, movements, neutral, said, walking=bool(getattr(model, "walks", False)))


def _body(block: Any, row: int, cells: int) -> Callable[[int], Any]:
    """The joints in the middle of a part of a performance, decoded when they are asked for."""
    import numpy as np

    def joints_m(cell: int) -> Any:
        at_s = np.array([[(cell + 0.5) / cells * float(block.duration_s[row])]])
        return block[row].positions_m(times_s=at_s)[0, 0]

    return joints_m


def _neutral(given_rad: float | None, told_rad: float | None, found_from: str) -> tuple[float, str]:
    import numpy as np

    if given_rad is not None:
        return given_rad, f"{np.rad2deg(given_rad):.1f} degrees, as given"
    if told_rad is None:
        return 0.0, f"0: not told by {found_from}, as most do not begin upright or have no head; see --neck-neutral"
    return told_rad, f"{np.rad2deg(told_rad):.1f} degrees forward of the trunk, from {found_from}"
