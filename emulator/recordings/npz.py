"""The ``.npz`` form: ``positions`` (sum of T, J, 3) in metres, z up, cut into repetitions by ``offsets``.

Recordings in the ``.npz`` form, gaps and all: read for cleaning and cutting, written for the next step.
"""

from __future__ import annotations

import io
import json
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from emulator.archive import MemberError, open_members, read_member
from emulator.motion import Motion, MotionSet, glitch, motion_from_positions
from emulator.recordings.body_size import MOST_NAMED, first_of, wrong_size
from emulator.recordings.formats import way_to_npz
from emulator.recordings.joint_names import joints_of
from emulator.recordings.npz_form import expected_of, form_mistakes, is_mark, mark_mistakes
from emulator.recordings.selection import rows_where
from emulator.recordings.take import Recording, Take
from emulator.recordings.text import RecordingError, said_twice
from emulator.skeleton import CANONICAL, EXTRA, Skeleton, canonical_names

MAX_BYTES = 4 * 2**30
MAX_ARRAYS = 1000
COLLECTIONS = ("uiprmd_", "hdm05_", "bandai2_")


def read_npz(
    path: Path,
    where: str | None,
    *,
    task: str | None = None,
    glitches: str = "drop",
    mapping_file: Path | None = None,
) -> MotionSet:
    """Repetition i is ``positions[offsets[i]:offsets[i + 1]]``; ``cov_*`` and ``ann_*_frame`` have one value each.

    Only the joints of ``core`` are read where the file has it. ``ann_turn_frame`` becomes the mark "turn".
    mapping_file : see ``body_of``
    """
    if glitches not in ("drop", "keep"):
        raise ValueError(f"glitches: 'drop' or 'keep', found {glitches!r}")
    arrays, meta, unread = load_arrays(path)
    columns = _columns_of(arrays)
    keep, selection, notes = _chosen(columns, where)
    _refuse(path, mark_mistakes(arrays, keep))
    skeleton, places, said = body_of(path, arrays, mapping_file)
    notes += said
    marks = {key.removeprefix("ann_").removesuffix("_frame"): arrays[key] for key in arrays if is_mark(key)}
    rate_hz = float(arrays["fps"])
    motions: list[Motion] = []
    glitched: dict[str, np.ndarray] = {}
    for i in np.flatnonzero(keep):
        frames = slice(int(arrays["offsets"][i]), int(arrays["offsets"][i + 1]))
        positions = arrays["positions"][frames].astype(float)
        name = f"{columns['worker'][i]}/{columns['trial'][i]}"
        wrong = glitch(positions, rate_hz, names=arrays["names"].tolist())
        if wrong:
            notes.append(f"{'left out' if glitches == 'drop' else 'kept'} {name}: {wrong}")
            if np.isfinite(positions).any():
                glitched[name] = positions
        if wrong and glitches == "drop":
            continue
        try:
            motions.append(
                motion_from_positions(
                    skeleton,
                    places[frames],
                    rate_hz,
                    worker=columns["worker"][i],
                    trial=columns["trial"][i],
                    mark_s=[float(frame[i]) / rate_hz for frame in marks.values()],
                    covariates={key: column[i] for key, column in columns.items() if key.startswith("cov_")},
                )
            )
        except ValueError as error:
            raise RecordingError(f"{path}: repetition {name}: {error}") from None
    if not motions:
        sizes = [wrong_size(name, positions) for name, positions in glitched.items()]
        _refuse(path, first_of(list(filter(None, sizes)), len(keep)))
        raise RecordingError(_none_left(path, selection, notes))
    notes += _breathing(motions) + unread
    return MotionSet(
        task=task or _task(path),
        motions=tuple(motions),
        mark_names=tuple(marks),
        source=str(meta.get("source", path.name)),
        licence=str(meta.get("licence", "not stated")),
        notes=tuple(notes),
        selection=selection,
    )


def _breathing(motions: list[Motion]) -> list[str]:
    """A note where bones change their length by more than 1 % (standard deviation within a repetition)."""
    spread = np.max([np.std(motion.stretch, axis=0) for motion in motions if motion.stretch is not None], axis=0)
    bone = int(spread.argmax())
    if spread[bone] < 0.01:
        return []
    name = motions[0].skeleton.bone_names[bone]
    return [
        f"bones breathe, most the one to {name} (sd up to {spread[bone]:.1%}); the median of each repetition is used"
    ]


def _none_left(path: Path, selection: str, notes: list[str]) -> str:
    """That nothing is left to read, of many reasons the first five."""
    more = [f"and {len(notes) - MOST_NAMED} more"] if len(notes) > MOST_NAMED else []
    why = "".join(f"\n  {note}" for note in [*notes[:MOST_NAMED], *more])
    return f"{path}: no repetition is left" + (f" of those with {selection}" if selection != "all" else "") + why


def load_arrays(path: Path) -> tuple[dict[str, np.ndarray], dict[str, Any], list[str]]:
    """The arrays that are read, each of the form that is expected, whole numbers as such; what meta says; notes.

    Raises RecordingError with every array that is not as expected.
    """
    try:
        with open_members(path, MAX_BYTES, MAX_ARRAYS) as file:
            keys = [name.removesuffix(".npy") for name in file.namelist()]
            wanted = [key for key in keys if key == "meta" or expected_of(key)]
            arrays = {key: read_member(file, f"{key}.npy") for key in wanted}
    except (MemberError, OSError, KeyError) as error:
        raise RecordingError(f"{path}: not a recording in .npz form ({error}){way_to_npz(path)}") from None
    _refuse(path, form_mistakes(arrays))
    whole = [key for key in ("offsets", "parents", "core", "core_parents") if key in arrays]
    arrays |= {key: arrays[key].astype(np.int64) for key in whole} | {"fps": arrays["fps"].reshape(())}
    return arrays, *_meta(arrays)


def _refuse(path: Path, mistakes: list[str]) -> None:
    if mistakes:
        raise RecordingError("\n".join(f"{path}: {mistake}" for mistake in mistakes))


def _columns_of(arrays: dict[str, np.ndarray]) -> dict[str, list[Any]]:
    columns = {key: array.tolist() for key, array in arrays.items() if key.startswith("cov_")}
    columns["worker"] = [str(worker) for worker in arrays["subject"]]
    columns["trial"] = [str(trial) for trial in arrays["trial"]]
    columns["duration_s"] = ((np.diff(arrays["offsets"]) - 1) / float(arrays["fps"])).tolist()
    return columns


def _chosen(columns: dict[str, list[Any]], where: str | None) -> tuple[np.ndarray, str, list[str]]:
    everything = np.ones(len(columns["worker"]), bool)
    if where is None:
        return everything, "all", []
    if where == "correct":
        if "cov_correct" not in columns:
            return everything, "all", ["the recording does not say which executions are correct; all are used"]
        where = "cov_correct==1"
    return rows_where(where, columns), where, []


def body_of(
    path: Path, arrays: dict[str, np.ndarray], mapping_file: Path | None = None
) -> tuple[Skeleton, np.ndarray, list[str]]:
    """The skeleton with canonical names, the positions of its joints (frames, J, 3), and notes on other joints.

    mapping_file : names that the rules do not know; see ``read_mapping``. With it all joints are looked at, else those
                   of ``core``, where the file has it
    Names that stand for canonical joints are taken as they are; those of a capture system (Kinect, ...), or two for one
    joint, as an import takes them. Raises RecordingError for an unknown name, or one that is there twice.
    """
    names, parents = [str(name) for name in arrays["names"]], tuple(arrays["parents"].tolist())
    joints = list(range(len(names)))
    cored = "core" in arrays and "core_parents" in arrays and mapping_file is None
    if cored:
        joints, parents = arrays["core"].tolist(), tuple(arrays["core_parents"].tolist())
    here = [names[j] for j in joints]
    remedy = "give each joint a name of its own" + (", or take one out of 'core' and 'core_parents'" if cored else "")
    wrong = [f"names: {each}" for each in said_twice(here, "joint", joints, remedy)]
    positions = arrays["positions"][:, joints].astype(float)
    if mapping_file is None:
        try:
            return Skeleton(canonical_names(here), parents), positions, []
        except ValueError as error:
            if not wrong and (set(here) <= {*CANONICAL, *EXTRA}):
                raise RecordingError(f"{path}: {error}") from None
            if not all(joints_of(here)):
                wrong.append(f"{error}; name it with --map")
    _refuse(path, wrong)
    from emulator.recordings.mapping import mapped

    take = Take(tuple(here), parents, positions, float(arrays["fps"]))
    body, report = mapped(take, mapping_file, where=str(path))
    notes = [f"joints: {report.summary()}", *(f"made {row.joint} ({row.why})" for row in report.of("made"))]
    return Skeleton(body.names, body.parents or ()), body.positions_m, notes


def _meta(arrays: dict[str, np.ndarray]) -> tuple[dict[str, Any], list[str]]:
    """What ``meta`` says, and a note where it cannot be read."""
    try:
        meta = json.loads(str(arrays.get("meta", "{}")))
    except (ValueError, RecursionError):
        meta = None
    return (meta, []) if isinstance(meta, dict) else ({}, ["meta is no JSON object: source and licence are not known"])


def _task(path: Path) -> str:
    for collection in COLLECTIONS:
        if path.stem.startswith(collection):
            return path.stem.removeprefix(collection)
    return path.stem


def read_recording(path: str | Path, *, mapping_file: Path | None = None) -> Recording:
    """The takes of an ``.npz`` recording with canonical joints, those of ``core`` where the file has it; nan are gaps.

    mapping_file : names of joints that the rules do not know; see ``npz.body_of``
    Raises RecordingError for what is no recording, all mistakes at once.
    """
    path = Path(path)
    if not path.exists():
        raise RecordingError(f"{path}: no such file")
    arrays, meta, notes = load_arrays(path)
    skeleton, positions, of_joints = body_of(path, arrays, mapping_file)
    columns = {key: array.tolist() for key, array in arrays.items() if key.startswith("cov_")}
    takes = []
    for i, (start, stop) in enumerate(zip(arrays["offsets"][:-1].tolist(), arrays["offsets"][1:].tolist())):
        takes.append(
            Take(
                skeleton.names,
                skeleton.parents,
                positions[start:stop],
                float(arrays["fps"]),
                worker=str(arrays["subject"][i]),
                trial=str(arrays["trial"][i]),
                mark_frame={_mark(key): float(arrays[key][i]) for key in arrays if is_mark(key)},
                covariates={key: column[i] for key, column in columns.items()},
                contact=arrays["contact_feet"][start:stop] if "contact_feet" in arrays else None,
                notes=tuple(of_joints),
            )
        )
    source, licence = (str(meta.get(key, "not stated")) for key in ("source", "licence"))
    said = meta.get("notes", [])
    return Recording(tuple(takes), source, licence, (*map(str, said if isinstance(said, list) else []), *notes))


def write_recording(recording: Recording, path: str | Path) -> None:
    """Write an ``.npz`` recording; the same takes give the same bytes. Raises ValueError for takes of markers.

    Positions are kept in double precision, so that nothing is lost between the steps.
    """
    if recording.parents is None:
        raise ValueError("markers are no joints; map them to joints before they are written as a recording")
    takes, path = recording.takes, Path(path)
    arrays: dict[str, np.ndarray] = {
        "positions": np.concatenate([take.positions_m for take in takes]),
        "offsets": np.cumsum([0, *(take.n_frames for take in takes)]),
        "fps": np.array(float(recording.rate_hz)),
        "names": np.array(recording.names),
        "parents": np.array(recording.parents),
        "subject": np.array([take.worker for take in takes]),
        "trial": np.array([take.trial for take in takes]),
        "duration": np.array([take.duration_s for take in takes]),
    }
    for name in sorted(takes[0].mark_frame):
        arrays[f"ann_{name}_frame"] = np.array([take.mark_frame[name] for take in takes])
    for key in sorted(set.intersection(*(set(take.covariates) for take in takes))):
        arrays[key] = np.array([take.covariates[key] for take in takes])
    if all(take.contact is not None for take in takes):
        arrays["contact_feet"] = np.concatenate([np.asarray(take.contact, bool) for take in takes])
    meta = {"source": recording.source, "licence": recording.licence, "notes": list(recording.notes)}
    _write(path, arrays | {"meta": np.array(json.dumps(meta, ensure_ascii=False))})


def _write(path: Path, arrays: dict[str, np.ndarray]) -> None:
    part = path.with_name(path.name + ".part")
    try:
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as file:
            for name, array in arrays.items():
                stream = io.BytesIO()
                np.lib.format.write_array(stream, np.asarray(array, order="C"), allow_pickle=False)
                entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
                entry.compress_type = zipfile.ZIP_DEFLATED
                file.writestr(entry, stream.getvalue())
        part.replace(path)
    except BaseException as error:  # also Ctrl-C: nothing half written stays behind
        with suppress(OSError):
            part.unlink()
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror, str(path)) from None
        raise


def _mark(key: str) -> str:
    return key.removeprefix("ann_").removesuffix("_frame")
