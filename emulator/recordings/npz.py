"""The ``.npz`` form: ``positions`` (sum of T, J, 3) in metres, z up, cut into repetitions by ``offsets``."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from emulator.clean import glitch
from emulator.motion import Motion, MotionSet, motion_from_positions
from emulator.recordings import RecordingError
from emulator.recordings.where import rows_where
from emulator.skeleton import Skeleton, canonical_names

NEEDED = ("positions", "offsets", "fps", "names", "parents", "subject", "trial")
COLLECTIONS = ("uiprmd_", "hdm05_", "bandai2_")


def read_npz(path: Path, where: str | None, *, task: str | None = None, glitches: str = "drop") -> MotionSet:
    """Repetition i is ``positions[offsets[i]:offsets[i + 1]]``; ``cov_*`` and ``ann_*_frame`` have one value each.

    Only the joints of ``core`` are read where the file has it. ``ann_turn_frame`` becomes the mark "turn".
    """
    if glitches not in ("drop", "keep"):
        raise ValueError(f"glitches: 'drop' or 'keep', found {glitches!r}")
    arrays = _load(path)
    columns = _columns(arrays)
    keep, selection, notes = _chosen(columns, where)
    skeleton, joints = _skeleton(path, arrays)
    marks = {key.removeprefix("ann_").removesuffix("_frame"): arrays[key] for key in arrays if _is_mark(key)}
    rate_hz = float(arrays["fps"])
    motions: list[Motion] = []
    for i in np.flatnonzero(keep):
        frames = slice(int(arrays["offsets"][i]), int(arrays["offsets"][i + 1]))
        positions = arrays["positions"][frames].astype(float)
        name = f"{columns['worker'][i]}/{columns['trial'][i]}"
        wrong = glitch(positions, rate_hz)
        if wrong:
            notes.append(f"{'left out' if glitches == 'drop' else 'kept'} {name}: {wrong}")
        if wrong and glitches == "drop":
            continue
        try:
            motions.append(
                motion_from_positions(
                    skeleton,
                    positions[:, joints],
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
        raise RecordingError(f"{path}: no repetition is left (where: {where}; {'; '.join(notes) or 'no notes'})")
    notes += _breathing(motions)
    meta = _meta(arrays)
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


def _load(path: Path) -> dict[str, np.ndarray]:
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
    except (ValueError, OSError, EOFError, KeyError, AttributeError, zipfile.BadZipFile) as error:
        raise RecordingError(f"{path}: not a recording in .npz form ({error})") from None
    missing = [key for key in NEEDED if key not in arrays]
    if missing:
        raise RecordingError(f"{path}: not a recording: no {', '.join(missing)}; found {', '.join(sorted(arrays))}")
    positions, offsets = arrays["positions"], arrays["offsets"]
    if positions.ndim != 3 or positions.shape[1:] != (len(arrays["names"]), 3):
        raise RecordingError(f"{path}: positions must be (frames, {len(arrays['names'])}, 3), found {positions.shape}")
    if offsets[0] != 0 or offsets[-1] != len(positions) or np.any(np.diff(offsets) < 2):
        raise RecordingError(f"{path}: offsets must rise from 0 to {len(positions)} by two frames or more")
    if not float(arrays["fps"]) > 0:
        raise RecordingError(f"{path}: fps must be positive, found {arrays['fps']}")
    for key, column in arrays.items():
        if (key in ("subject", "trial") or key.startswith("cov_") or _is_mark(key)) and len(column) != len(offsets) - 1:
            raise RecordingError(f"{path}: {key} has {len(column)} values for {len(offsets) - 1} repetitions")
    return arrays


def _is_mark(key: str) -> bool:
    return key.startswith("ann_") and key.endswith("_frame")


def _columns(arrays: dict[str, np.ndarray]) -> dict[str, list[Any]]:
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


def _skeleton(path: Path, arrays: dict[str, np.ndarray]) -> tuple[Skeleton, list[int]]:
    names, parents = arrays["names"], arrays["parents"]
    joints = list(range(len(names)))
    if "core" in arrays and "core_parents" in arrays:
        joints, parents = [int(j) for j in arrays["core"]], arrays["core_parents"]
    try:
        return Skeleton(canonical_names([str(names[j]) for j in joints]), tuple(parents)), joints
    except ValueError as error:
        raise RecordingError(f"{path}: {error}") from None


def _meta(arrays: dict[str, np.ndarray]) -> dict[str, Any]:
    try:
        meta = json.loads(str(arrays.get("meta", "{}")))
    except json.JSONDecodeError:
        return {}
    return meta if isinstance(meta, dict) else {}


def _task(path: Path) -> str:
    for collection in COLLECTIONS:
        if path.stem.startswith(collection):
            return path.stem.removeprefix(collection)
    return path.stem
