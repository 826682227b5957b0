"""MotionLibrary: the emulators of several tasks in one file, with where they come from."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np

from emulator.archive import LibraryError, read_archive, read_header, write_archive
from emulator.density import LowRankNormal
from emulator.fit_report import FitReport
from emulator.flatten import SIEM
from emulator.joint import BLOCKS, JointScale
from emulator.margin import Margin
from emulator.model import MotionEmulator
from emulator.reduce import JointPCA
from emulator.skeleton import Skeleton
from emulator.storage import decode, encode
from emulator.workforce import Workforce

__all__ = ["LibraryError", "MotionLibrary", "file_sha256", "read_header"]


@dataclass(frozen=True, eq=False)
class MotionLibrary(Mapping[str, MotionEmulator]):
    """Emulators by task name, in natural reading order of insertion; ``command`` says what made the library.

    ``library["deep_squat"]``; an unknown task raises LibraryError with the nearest name.
    """

    emulators: Mapping[str, MotionEmulator]
    command: str = ""
    notes: tuple[str, ...] = field(default=())

    @classmethod
    def of(cls, *emulators: MotionEmulator, command: str = "", notes: tuple[str, ...] = ()) -> MotionLibrary:
        """A library of these emulators. Raises LibraryError where two have one task name."""
        library = cls({}, command, notes)
        for emulator in emulators:
            library = library.add(emulator)
        return library

    def add(self, emulator: MotionEmulator) -> MotionLibrary:
        """The library with one task more."""
        if emulator.task in self.emulators:
            raise LibraryError(f"task {emulator.task!r} is in the library already")
        return MotionLibrary({**self.emulators, emulator.task: emulator}, self.command, self.notes)

    def merge(self, other: MotionLibrary) -> MotionLibrary:
        """Both libraries' tasks; the commands are kept one after the other."""
        merged = self
        for emulator in other.values():
            merged = merged.add(emulator)
        command = "; ".join(c for c in (self.command, other.command) if c)
        return MotionLibrary(merged.emulators, command, self.notes + other.notes)

    def __getitem__(self, task: str) -> MotionEmulator:
        if task not in self.emulators:
            near = get_close_matches(str(task), self.emulators, n=1)
            raise LibraryError(
                f"no task {task!r} in the library; "
                + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.emulators)}")
            )
        return self.emulators[task]

    def __contains__(self, task: object) -> bool:
        return task in self.emulators

    def __iter__(self) -> Iterator[str]:
        return iter(self.emulators)

    def __len__(self) -> int:
        return len(self.emulators)

    @property
    def tasks(self) -> tuple[str, ...]:
        return tuple(self.emulators)

    def only(self) -> MotionEmulator:
        """The emulator of a library that has one task. Raises LibraryError if it has several or none."""
        if len(self) != 1:
            raise LibraryError(f"the library has {len(self)} tasks ({', '.join(self)}); name one")
        return next(iter(self.values()))

    def save(self, path: str | Path) -> None:
        """Write one .npz; the same library gives the same bytes."""
        arrays: dict[str, np.ndarray] = {}
        tasks = {}
        for task, emulator in self.emulators.items():
            tasks[task], parts = _pack(emulator)
            arrays |= {f"{task}/{name}": array for name, array in parts.items()}
        write_archive(Path(path), {"command": self.command, "notes": list(self.notes), "tasks": tasks}, arrays)

    @staticmethod
    def load(path: str | Path) -> MotionLibrary:
        """Read a library. Raises LibraryError for a foreign, broken or hostile file; nothing in it is ever executed."""
        header, arrays = read_archive(Path(path))
        try:
            emulators = {task: _unpack(task, plain, arrays) for task, plain in header["tasks"].items()}
            return MotionLibrary(emulators, str(header["command"]), tuple(str(n) for n in header["notes"]))
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as why:
            raise LibraryError(f"{path}: the library is incomplete or inconsistent ({why})") from None


def file_sha256(path: str | Path) -> str:
    """Hash of a file's bytes, for manifests."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


_PCA = ("posture", "root", "pace", "bones")


def _pack(model: MotionEmulator) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    plain = {
        "skeleton": {"names": list(model.skeleton.names), "parents": list(model.skeleton.parents)},
        "mark_names": list(model.mark_names),
        "n_times": model.n_times,
        "sizes": list(model.scale.sizes),
        "explained_variance": {name: getattr(model, name).explained_variance for name in _PCA},
        "margin_slopes": [margin.slope for margin in (model.margin, *model.mark_margins)],
        "rho": {"between": model.workforce.between.rho, "within": model.workforce.within.rho},
        "workers": list(model.workforce.names),
        "report": model.report.as_dict(),
    }
    arrays = {
        "reference": model.flatten.reference,
        "centre": model.scale.centre,
        "spread": model.scale.spread,
        "effects": model.workforce.effects,
    }
    for number, margin in enumerate((model.margin, *model.mark_margins)):
        arrays |= {f"margin{number}_z": margin.z, f"margin{number}_value": margin.value}
    for name in ("between", "within"):
        normal: LowRankNormal = getattr(model.workforce, name)
        arrays |= {f"{name}_mean": normal.mean, f"{name}_factor": normal.factor, f"{name}_spread": normal.spread}
    for name in ("pace", "bones"):
        arrays |= {f"{name}_mean": getattr(model, name).mean, f"{name}_basis": getattr(model, name).basis}
    for name in ("posture", "root"):
        pca: JointPCA = getattr(model, name)
        whole, exponent = encode(np.concatenate([pca.mean[None], pca.basis]))
        arrays |= {f"{name}_whole": _steps(whole, model.n_times), f"{name}_exponent": exponent}
    return plain, arrays


def _unpack(task: str, plain: dict[str, Any], arrays: dict[str, np.ndarray]) -> MotionEmulator:
    def array(name: str, *shape: int) -> np.ndarray:
        """The array of this task; -1 in shape takes any length."""
        found = arrays[f"{task}/{name}"]
        if found.ndim != len(shape) or any(want not in (-1, have) for want, have in zip(shape, found.shape)):
            raise ValueError(f"{task}/{name} has shape {found.shape}, expected {shape}")
        return found

    skeleton = Skeleton(tuple(plain["skeleton"]["names"]), tuple(plain["skeleton"]["parents"]))
    n_times, sizes = int(plain["n_times"]), tuple(int(size) for size in plain["sizes"])
    if len(sizes) != len(BLOCKS) or min(sizes) < 0 or n_times < 2:
        raise ValueError(f"{task}: sizes {sizes} and n_times {n_times} make no sense")
    size, k = dict(zip(BLOCKS, sizes)), sum(sizes)
    mark_names = tuple(str(name) for name in plain["mark_names"])
    if (size["duration"], size["marks"]) != (1, len(mark_names)):
        raise ValueError(f"{task}: {size['marks']} mark coordinates for {len(mark_names)} marks")
    share = {name: _number(plain["explained_variance"][name]) for name in _PCA}

    def normal(name: str) -> LowRankNormal:
        parts = array(f"{name}_mean", k), array(f"{name}_factor", -1, k), array(f"{name}_spread", k)
        rho = _number(plain["rho"][name])
        if not 0 <= rho <= 1:
            raise ValueError(f"{task}: rho {rho} is not a share")
        return LowRankNormal(*parts, rho)

    def long_pca(name: str, channels: int) -> JointPCA:
        whole = array(f"{name}_whole", size[name] + 1, n_times, channels)
        rows = decode(_sums(whole), array(f"{name}_exponent", size[name] + 1))
        return JointPCA(rows[0], rows[1:], share[name])

    def short_pca(name: str, length: int) -> JointPCA:
        mean = array(f"{name}_mean", length)
        return JointPCA(mean, array(f"{name}_basis", size[name], len(mean)), share[name])

    workers = tuple(str(name) for name in plain["workers"])
    spread = array("spread", k)
    if np.any(spread <= 0):
        raise ValueError(f"{task}: a spread is not positive")

    def margin(number: int) -> Margin:
        z = array(f"margin{number}_z", -1)
        value, slope = array(f"margin{number}_value", len(z)), _number(plain["margin_slopes"][number])
        if len(z) == 0 or slope <= 0 or np.any(np.diff(z) <= 0) or np.any(np.diff(value) <= 0):
            raise ValueError(f"{task}: margin {number} does not increase")
        return Margin(z, value, slope)

    return MotionEmulator(
        task,
        skeleton,
        mark_names,
        n_times,
        SIEM(array("reference", skeleton.n_bones, 3)),
        long_pca("posture", 2 * skeleton.n_bones),
        long_pca("root", 4),
        short_pca("pace", -1),
        short_pca("bones", skeleton.n_bones),
        margin(0),
        tuple(margin(1 + e) for e in range(len(mark_names))),
        JointScale(sizes, array("centre", k), spread),
        Workforce(normal("between"), normal("within"), workers, array("effects", len(workers), k)),
        FitReport.of_dict(plain["report"]),
    )


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"found {value!r}, expected a number")
    return float(value)


def _steps(whole: np.ndarray, n_times: int) -> np.ndarray:
    """int16 (R, T * C) -> first values and steps along time (R, T, C), modulo 2^16: small numbers, that pack well."""
    grid = whole.reshape(len(whole), n_times, -1)
    return np.concatenate([grid[:, :1], np.diff(grid, axis=1)], axis=1)


def _sums(steps: np.ndarray) -> np.ndarray:
    """The way back: (R, T, C) -> int16 (R, T * C)."""
    if steps.dtype != np.int16:
        raise ValueError(f"steps are {steps.dtype}, expected int16")
    return np.cumsum(steps, axis=1, dtype=np.int16).reshape(len(steps), -1)
