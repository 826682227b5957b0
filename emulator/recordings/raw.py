"""Any file of a capture system, told by its ending: each format has its reader, and takes the options it can use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from emulator.recordings import RecordingError
from emulator.recordings.keypoint_folder import KEYPOINT_FILES, is_keypoint_folder
from emulator.recordings.take import Take
from emulator.recordings.timing import refuse_short


@dataclass(frozen=True)
class Format:
    """A format's name, the module and function that read it, and the options of ``read_take`` that it takes."""

    name: str
    module: str
    reader: str
    options: tuple[str, ...] = ("unit_m", "up")


FORMATS = {
    ".bvh": Format("BVH", "bvh", "read_bvh"),
    ".amc": Format("ASF/AMC", "asf_amc", "read_amc", ("unit_m", "up", "rate_hz", "asf")),
    ".c3d": Format("C3D", "c3d", "read_c3d"),
    ".trc": Format("TRC", "trc", "read_trc"),
    ".csv": Format("CSV", "marker_csv", "read_csv", ("unit_m", "up", "rate_hz", "columns", "min_score")),
    ".tsv": Format("TSV", "marker_csv", "read_csv", ("unit_m", "up", "rate_hz", "columns", "min_score")),
    ".json": Format("keypoint JSON", "keypoints", "read_json", ("unit_m", "up", "rate_hz", "columns", "min_score")),
}
"""Formats by the ending of their files; ``.npz`` besides, which can hold many takes."""
OPTIONS = {
    "unit_m": "the unit",
    "up": "the axis that points up",
    "rate_hz": "the frame rate",
    "columns": "names of the columns",
    "asf": "a skeleton file",
    "min_score": "a least confidence",
    "mapping_file": "a mapping file",
}


_FOLDER = f"found a folder, expected a file, or a folder of {KEYPOINT_FILES} with points in space, a file a frame"


def format_of(path: Path) -> str:
    """The name of the format, by the file's ending. Raises RecordingError for an ending that no reader knows."""
    if is_keypoint_folder(path):
        return FORMATS[".json"].name
    ending = path.suffix.lower()
    if ending == ".npz":
        return "npz"
    if ending == ".asf":
        raise RecordingError(f"{path}: found a skeleton (.asf) without motion, expected the .amc that goes with it")
    if ending not in FORMATS:
        known = [*FORMATS, ".npz"]
        near = get_close_matches(ending, known, n=1, cutoff=0.6)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
        raise RecordingError(f"{path}: found {path.suffix or 'no ending'!r}, expected a recording's ending; {hint}")
    return FORMATS[ending].name


def read_take(path: str | Path, **options: Any) -> Take:
    """The one take of a file, joints or markers named as in the file, in metres, z up, right-handed; nan are gaps.

    options : those that are not None must suit the format:
        unit_m (metres of one unit of the file) and up ("x", "-x", ... "-z"), else said by the file or found from the
        body; rate_hz; columns (a file that names the columns of a CSV or JSON without names); asf (the skeleton of an
        AMC); min_score (points of less confidence become gaps)
    Raises RecordingError for an unknown ending, an option that the format cannot use, and a file that cannot be read.
    """
    takes = read_takes(path, **options)
    if len(takes) > 1:
        raise RecordingError(f"{path}: found {len(takes)} takes, expected one")
    return takes[0]


def read_takes(path: str | Path, **options: Any) -> Sequence[Take]:
    """The takes of a file, as ``read_take``: one but for ``.npz``."""
    path = Path(path)
    given = {name: value for name, value in options.items() if value is not None}
    folder = "\0" not in str(path) and path.is_dir()
    if folder and not is_keypoint_folder(path):
        raise RecordingError(f"{path}: {_FOLDER}")
    name = format_of(path)
    if not folder and not path.is_file():
        raise RecordingError(f"{path}: no such file")
    _refuse_useless(path, name, given)
    takes: Sequence[Take]
    if name == "npz":
        from emulator.recordings.takes_npz import read_recording

        takes = read_recording(path, **given).takes
    else:
        takes = (_reader(_form(path))(path, **given),)
    for take in takes:
        refuse_short(path, take.n_frames)
    return takes


def _form(path: Path) -> Format:
    """A folder of keypoints is a JSON in parts."""
    return FORMATS[".json" if is_keypoint_folder(path) else path.suffix.lower()]


def _refuse_useless(path: Path, name: str, given: dict[str, Any]) -> None:
    usable = _form(path).options if name != "npz" else ("mapping_file",)
    useless = [option for option in given if option not in usable]
    unknown = [option for option in useless if option not in OPTIONS]
    if unknown:
        raise TypeError(f"read_take has no option {unknown[0]!r}; known: {', '.join(OPTIONS)}")
    if useless:
        said = " and ".join(OPTIONS[option] for option in useless)
        raise RecordingError(f"{path}: found {said} given, expected none: a {name} file says this itself")


def _reader(form: Format) -> Callable[..., Take]:
    reader: Callable[..., Take] = getattr(import_module(f"emulator.recordings.{form.module}"), form.reader)
    return reader
