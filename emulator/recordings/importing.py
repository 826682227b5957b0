"""Any file of a capture system, told by its ending: each format has its reader, and takes the options it can use.

From a file of a capture system to a take with canonical joints: read, mapped, sides checked, named.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from emulator.recordings.columns import refuse_short
from emulator.recordings.formats import FORMATS, OPTIONS, Format
from emulator.recordings.joint_names import MappingReport
from emulator.recordings.keypoints import KEYPOINT_FILES, is_keypoint_folder
from emulator.recordings.mapping import mapped
from emulator.recordings.orientation import body_size
from emulator.recordings.plausibility import SidesFound, checked_body, checked_sides, mirrored, swapped_names
from emulator.recordings.take import Recording, Take, named
from emulator.recordings.text import RecordingError
from emulator.skeleton import Skeleton

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
        near = get_close_matches(ending[1:], [one[1:] for one in known], n=1)
        hint = f"did you mean {'.' + near[0]!r}?" if near else f"known: {', '.join(known)}"
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
        from emulator.recordings.npz import read_recording

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


SIDES = ("swap", "mirror", "keep")
"""What to do where the whole body has left and right exchanged: exchange the names, the y axis, or nothing."""
PINNED_M, MOVED_M = 0.001, 0.05
"""A pelvis that moves less while feet move more is the origin of the file, not a place in the room."""


@dataclass(frozen=True)
class Imported:
    """A take and what was found on the way: ``gap_share`` (J,) of the frames, ``bone_m`` (B,) and ``spread_m`` (B,).

    spread_m : standard deviation of each bone's length over the frames
    body_m   : from head to feet in the median frame, along the joints; nan where these are not known
    """

    file: str
    format: str
    take: Take
    mapping: MappingReport
    sides: SidesFound
    gap_share: np.ndarray
    bone_m: np.ndarray
    spread_m: np.ndarray
    notes: tuple[str, ...]
    body_m: float = float("nan")
    source: str = ""
    licence: str = ""


def imported(
    path: str | Path,
    *,
    mapping_file: Path | None = None,
    sides: str | None = None,
    worker: str | None = None,
    trial: str | None = None,
    names_as: str | None = None,
    **options: Any,
) -> tuple[Imported, ...]:
    """The takes of a file with canonical joints, in metres, z up, named by worker and trial or by the file's name.

    mapping_file : names that the rules do not know; see ``read_mapping``
    sides        : one of ``SIDES``, for a body whose left and right are exchanged
    names_as     : how file names say worker and trial, such as ``HDM_{worker}_*_{trial}_*``
    options      : of ``read_take``
    Raises RecordingError for what cannot be read or mapped, and for exchanged sides where ``sides`` does not say what
    to do about them.
    """
    path = Path(path)
    if format_of(path) == "npz" and mapping_file is not None:
        options, mapping_file = {**options, "mapping_file": mapping_file}, None
    takes = read_takes(path, **options)
    source, licence = _provenance(path)
    done = []
    for take in takes:
        take = replace(take, notes=(*take.notes, *checked_body(take, str(path), _again(path, options), options)))
        joints, report = mapped(take, mapping_file, where=str(path))
        joints, found = _sided(joints, sides, path)
        if format_of(path) != "npz" or worker or trial:
            joints = named(joints, path, worker, trial, names_as, len(takes))
        done.append(replace(_looked_at(path, joints, report, found), source=source, licence=licence))
    return tuple(done)


def _again(path: Path, options: dict[str, Any]) -> Callable[..., Take]:
    """The same file once more, with other options."""
    return lambda **other: read_takes(path, **{**options, **other})[0]


def together(found: Sequence[Imported], source: str | None = None, licence: str | None = None) -> Recording:
    """One recording of all takes, with source and licence as given, else as the files state them.

    Raises RecordingError, all at once, where joints, rates or names do not fit.
    """
    source = source or "; ".join(dict.fromkeys(each.source for each in found))
    licence = licence or "; ".join(dict.fromkeys(each.licence or "not stated" for each in found))
    wrong, first = [], found[0]
    for each in found[1:]:
        wrong += _unlike(first, each)
    seen: dict[str, str] = {}
    for each in found:
        if each.take.name in seen:
            wrong.append(_called_alike(seen[each.take.name], each))
        seen[each.take.name] = each.file
    if wrong:
        raise RecordingError("\n".join(dict.fromkeys(wrong)))
    shared = set.intersection(*(set(each.take.mark_frame) for each in found))
    takes = [replace(e.take, mark_frame={k: v for k, v in e.take.mark_frame.items() if k in shared}) for e in found]
    notes = [f"{Path(each.file).name}: {note}" for each in found for note in each.notes]
    return Recording(tuple(takes), source, licence, tuple(dict.fromkeys(notes)))


def _called_alike(file: str, other: Imported) -> str:
    if file == other.file:
        return f"{file}: found two takes called {other.take.name}, expected names of their own, and each file once"
    both = f"{file} and {other.file}"
    return f"{both}: both are called {other.take.name}, expected names of their own; see --worker, --trial, --names"


def _unlike(first: Imported, other: Imported) -> list[str]:
    wrong = []
    here, there = set(first.take.names), set(other.take.names)
    if here != there:
        less, more = sorted(here - there), sorted(there - here)
        words = ([f"no {', '.join(less)}"] if less else []) + ([f"{', '.join(more)} besides"] if more else [])
        wrong.append(f"{other.file}: found {' and '.join(words)}, expected the joints of {first.file}; see --map")
    elif first.take.parents != other.take.parents:
        wrong.append(f"{other.file}: joints hang otherwise than those of {first.file}; import them apart")
    if first.take.rate_hz != other.take.rate_hz:
        wrong.append(
            f"{other.file}: found {other.take.rate_hz:g} frames a second, expected {first.take.rate_hz:g} as in "
            f"{first.file}; import them apart"
        )
    return wrong


def _sided(take: Take, sides: str | None, path: Path) -> tuple[Take, SidesFound]:
    take, found = checked_sides(take)
    if found.verdict != "swapped":
        return take, found
    if sides is None:
        by = ", ".join(name for name, value in found.witnesses.items() if value < 0)
        raise RecordingError(
            f"{path}: left and right are exchanged: by its {by} the body faces backwards. Names may be swapped or the "
            "axes left-handed, and no posture tells which; say --sides swap, --sides mirror, or --sides keep"
        )
    change = {"swap": swapped_names, "mirror": mirrored}.get(sides)
    if change is None:
        return take, found
    word = "names exchanged" if sides == "swap" else "mirrored"
    return change(take), replace(found, verdict=f"were exchanged; {word} as asked")


def _provenance(path: Path) -> tuple[str, str]:
    """Source and licence that the file itself states; a file of a capture system is its own source."""
    if format_of(path) != "npz":
        return path.name, ""
    from emulator.recordings.npz import load_arrays

    meta = load_arrays(path)[1]
    licence = str(meta.get("licence", "not stated"))
    return str(meta.get("source", "not stated")), "" if licence == "not stated" else licence


def _looked_at(path: Path, take: Take, report: MappingReport, sides: SidesFound) -> Imported:
    if take.parents is None:
        raise RecordingError(f"{path}: the joints hang on nothing")
    skeleton = Skeleton(take.names, take.parents)
    lengths = skeleton.bone_lengths(take.positions_m)
    seen = np.isfinite(lengths)
    bone_m, spread_m = np.full(skeleton.n_bones, np.nan), np.full(skeleton.n_bones, np.nan)
    for bone in np.flatnonzero(seen.any(axis=0)):
        own = lengths[seen[:, bone], bone]
        bone_m[bone], spread_m[bone] = np.median(own), np.std(own)
    gaps = ~np.isfinite(take.positions_m).all(axis=-1)
    unknown = [row.name for row in report.of("unknown")]
    notes = [*take.notes, f"joints: {report.summary()}"]
    notes += [f"made {row.joint} ({row.why})" for row in report.of("made") if len(report.of("made")) <= 6]
    notes += [f"not known and left out: {', '.join(unknown)}"] if unknown else []
    if _is_pinned(take):
        notes.append("the pelvis stays where it is while the feet move: way and height above the floor are not known")
    notes.append(f"sides: {sides.words()}")
    share, body_m = gaps.mean(axis=0), body_size(take.positions_m, take.names)[0]
    return Imported(str(path), format_of(path), take, report, sides, share, bone_m, spread_m, tuple(notes), body_m)


def _is_pinned(take: Take) -> bool:
    """Whether places are relative to the pelvis, as some trackers give them."""
    root = take.positions_m[:, take.names.index("pelvis")]
    feet = [i for i, name in enumerate(take.names) if name.endswith(("_ankle", "_toe"))]
    if not feet or not np.isfinite(root).all(axis=-1).any():
        return False
    return bool(_range_m(root) < PINNED_M and max(_range_m(take.positions_m[:, i]) for i in feet) > MOVED_M)


def _range_m(places: np.ndarray) -> float:
    """How far a point (T, 3) moves along the axis of most movement; 0 where it is never seen."""
    seen = places[np.isfinite(places).all(axis=-1)]
    return float(np.ptp(seen, axis=0).max()) if len(seen) else 0.0
