"""The repetitions of an ``.npz`` recording as a MotionSet; ``importing`` reads other files, a reader each form."""

from __future__ import annotations

from pathlib import Path

from emulator.motion import MotionSet
from emulator.recordings.formats import way_to_npz
from emulator.recordings.text import RecordingError


def read_motions(
    path: str | Path,
    where: str | None = "correct",
    *,
    task: str | None = None,
    glitches: str = "drop",
    mapping_file: str | Path | None = None,
) -> MotionSet:
    """The repetitions of one task, read from ``path``.

    where    : an expression over the covariates, e.g. ``"cov_correct==1"``; None takes all; "correct" (default) takes
               the correct executions where the file says which these are, else all, and the notes say so
    task     : the task's name; by default the file's name without the name of its collection
    glitches : "drop" leaves out repetitions that no body can do, "keep" keeps them; the notes name them either way
    mapping_file : lines 'name in the file: joint', for names that are not known
    Raises RecordingError for a file that is not a recording, and for a mistyped covariate with the nearest word.
    """
    path = Path(path)
    if not path.exists():
        raise RecordingError(f"{path}: no such file")
    if path.suffix.lower() != ".npz":
        raise RecordingError(f"{path}: recordings end in .npz, found {path.suffix or 'no ending'!r}{way_to_npz(path)}")
    from emulator.recordings.npz import read_npz

    return read_npz(
        path, where, task=task, glitches=glitches, mapping_file=None if mapping_file is None else Path(mapping_file)
    )


__all__ = ["RecordingError", "read_motions"]
