"""Recordings in the ``.npz`` form, gaps and all: read for cleaning and cutting, written for the next step."""

from __future__ import annotations

import io
import json
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.form import is_mark
from emulator.recordings.npz import body_of, load_arrays
from emulator.recordings.take import Recording, Take


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
