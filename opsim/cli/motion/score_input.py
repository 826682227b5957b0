"""Whether the takes of a recording are upright bodies in metres, and which of their joints are not seen, and when.

What ``opsim motion score`` scores: movements, their necks' neutral, when hands are full.

Movements to be scored that are drawn from a task of a library.

Movements to be scored: the takes of a recording, or performances drawn from a task of a library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

FURTHEST_M = 1e5
"""From the origin of a recording: further away, single precision no longer tells a finger's width."""
SEE = "see `opsim motion import`, which finds unit and axis"
WORTH_SAYING = 0.001


def wrong_bodies(recording: Any, where: str) -> list[str]:
    """Why takes are refused: nothing seen, no place in a room, a size that no body has, standing along another axis."""
    if not any(np.isfinite(take.positions_m).any() for take in recording.takes):
        return [f"{where}: found no position at all, expected joints of a body in metres"]
    wrong: dict[str, list[tuple[str, str]]] = {}
    for take in recording.takes:
        for found, expected in _why_refused(take):
            wrong.setdefault(expected, []).append((take.name, found))
    return [
        f"{where}: {_takes([name for name, _ in each], len(recording.takes))}"
        f"found {each[0][1]}, expected {expected}; {SEE}"
        for expected, each in wrong.items()
    ]


def _takes(names: list[str], n_takes: int) -> str:
    if len(names) == n_takes:
        return ""
    return f"take{'s' if len(names) > 1 else ''} {', '.join(names[:6])}{', ...' if len(names) > 6 else ''}: "


def _why_refused(take: Any) -> Iterator[tuple[str, str]]:
    """What is found and what is expected: takes of which the same is expected are one sentence."""
    from emulator.recordings.orientation import LONGEST_M, SHORTEST_M, body_size
    from emulator.recordings.plausibility import PART_SHARE, SPREAD_SHARE, stands_along

    if not np.isfinite(take.positions_m).any():
        return
    furthest_m = float(np.nanmax(np.abs(take.positions_m)))
    if furthest_m > FURTHEST_M:
        yield f"a coordinate of {furthest_m:.3g} m", "a place in metres"
        return
    size_m, how = body_size(take.positions_m, take.names)
    whole = how.startswith("from head")
    least, most = (SHORTEST_M, LONGEST_M) if whole else (PART_SHARE * SHORTEST_M, SPREAD_SHARE * LONGEST_M)
    if np.isfinite(size_m) and not least <= size_m <= most:
        yield f"a body of {size_m:.3g} m", f"{least:.3g} to {most:.3g} m: it is not in metres"
    elif stands_along(take) != "z":
        yield f"a body that stands along {stands_along(take)}", "z: it does not stand upright"


def seen_joints(recording: Any) -> tuple[str, ...]:
    """Those that are seen in some frame."""
    seen = np.any([np.isfinite(take.positions_m).all(axis=-1).any(axis=0) for take in recording.takes], axis=0)
    return tuple(name for name, there in zip(recording.names, seen) if there)


def gaps(recording: Any) -> Iterator[str]:
    """Sentences on bodies that lie or hang, takes without any position, and joints that are not seen all the time."""
    from emulator.recordings.plausibility import lies_all_along

    lying = [take.name for take in recording.takes if np.isfinite(take.positions_m).any() and lies_all_along(take)]
    if lying:
        yield f"{_takes(lying, len(recording.takes))}does not stand upright at any time; {SEE}, if it should"
    empty = [take.name for take in recording.takes if not np.isfinite(take.positions_m).any()]
    if empty:
        yield f"missing: nothing is known of {', '.join(empty[:6])}{', ...' if len(empty) > 6 else ''}"
    there = np.concatenate([np.isfinite(take.positions_m).all(axis=-1) for take in recording.takes])
    there = there[there.any(axis=1)]
    unseen = 1.0 - there.mean(axis=0)
    some = [
        f"{name.replace('_', ' ')} {100 * share:.1f} %"
        for name, share in zip(recording.names, unseen)
        if WORTH_SAYING <= share < 1.0
    ]
    if some:
        yield f"missing: not seen for a part of the time, where scores are wider: {', '.join(some)}"


@dataclass(frozen=True, eq=False)
class Source:
    """What is scored, in words, on which skeleton, and where the neutral of necks comes from.

    movements : ``opsim.ergonomics.shift.movement.Movement`` each;  notes : what is missing or odd, in sentences
    walking   : whether they are steps of somebody who walks
    mark_names, seen_names : marks of the movements, and joints that are seen at some time
    """

    title: str
    skeleton: Any
    movements: list[Any]
    neck_neutral_rad: float
    neutral_said: str
    notes: tuple[str, ...] = ()
    walking: bool = False
    mark_names: tuple[str, ...] = ()
    seen_names: tuple[str, ...] = ()


def between(progress: Any, moments: tuple[float, float]) -> Any:
    """(N,) whether hands may be full: from one share to another; all before and after a mark that is not known."""
    start, end = moments
    return ~(progress < start) & ~(progress >= end)


def neutral_of(given_rad: float | None, told_rad: float | None, found_from: str) -> tuple[float, str]:
    """The neutral of necks and a sentence whence it is: as given, else as told, else 0."""

    if given_rad is not None:
        return given_rad, f"{np.rad2deg(given_rad):.1f} degrees, as given"
    if told_rad is None:
        return 0.0, f"0: not told by {found_from}, as most do not begin upright or have no head; see --neck-neutral"
    return told_rad, f"{np.rad2deg(told_rad):.1f} degrees forward of the trunk, from {found_from}"


def drawn(model: Any, n: int, seed: int, asked: Any) -> Source:
    """So many performances, with that seed, as ``motion_score_asked.Asked`` asks."""

    from opsim.ergonomics.measures import measures_of, n_cells
    from opsim.ergonomics.redraw import neck_neutral_told_rad
    from opsim.ergonomics.shift.movement import Movement
    from opsim.task_model import behind
    from opsim.threads import one_blas_thread

    with one_blas_thread():
        block = model.sample(n, np.random.default_rng(seed))
        neutral, said = neutral_of(asked.neck_neutral_rad, neck_neutral_told_rad(model), "how draws of the task begin")
        measures, cells = measures_of(block, range(n), asked.options, neutral), n_cells(block, asked.options)
    carrying = _loaded_in(block, n, cells, asked.loaded, tuple(getattr(model, "mark_names", ())))
    movements = [
        Movement(
            f"draw {k + 1}",
            np.full(cells, block.duration_s[k] / cells),
            measures[k],
            _body(block, k, cells),
            carrying[k],
        )
        for k in range(n)
    ]
    report, names = model.report, tuple(model.skeleton.names)
    title = f"{model.task}: {n} drawn ({behind(report.source, report.n_sequences, report.n_workers)}), seed {seed}"
    walking, marks = bool(getattr(model, "walks", False)), tuple(getattr(model, "mark_names", ()))
    return Source(title, model.skeleton, movements, neutral, said, (), walking, marks, names)


def _loaded_in(block: Any, n: int, cells: int, loaded: Any, mark_names: tuple[str, ...]) -> list[Any]:
    """Of each draw, in which of its parts hands may be full; None where nobody said when."""

    from opsim.ergonomics.shift.day import hands_full
    from opsim.subjects.exposure.plan import Handling

    if loaded is None:
        return [None] * n
    start, end = loaded.moments(mark_names)
    shares = zip(*hands_full(Handling(start=start, end=end), block, np.arange(n)))
    return [between((np.arange(cells) + 0.5) / cells, moments) for moments in shares]


def _body(block: Any, row: int, cells: int) -> Callable[[int], Any]:
    """The joints in the middle of a part of a performance, decoded when they are asked for."""

    def joints_m(cell: int) -> Any:
        at_s = np.array([[(cell + 0.5) / cells * float(block.duration_s[row])]])
        return block[row].positions_m(times_s=at_s)[0, 0]

    return joints_m


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
        takes = _takes_in(file, wrong)
        return Reader(lambda asked: _recorded(file, takes, asked), tuple(takes.takes[0].mark_frame))
    model = _model(source, task)
    return Reader(lambda asked: drawn(model, n or DRAWN, seed, asked), tuple(getattr(model, "mark_names", ())))


def _is_library(file: Path) -> bool:
    from opsim.cli.motion.files import _kind

    return file.suffix.lower() == ".npz" and _kind(file) == "library"


def _takes_in(file: Path, wrong: Sequence[str]) -> Any:
    """The takes of a recording, gaps and all."""
    from emulator.recordings.importing import imported, together
    from emulator.recordings.npz import read_recording

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
    from opsim.cli.motion.files import chosen, found, library_and_task

    library, task = library_and_task(source, task)
    try:
        found(library)
    except ValueError as error:
        expected = "a recording (.npz, .bvh, ...), or library/task such as public_movements/deep_squat"
        raise ValueError(f"{source}: found neither a file nor a library, expected {expected}\n{error}") from None
    return chosen(library, task)


def _recorded(file: Path, recording: Any, asked: Any) -> Source:

    from opsim.ergonomics.redraw import neutral_told_rad

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
