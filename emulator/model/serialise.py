"""A MotionEmulator as plain values and arrays: what a library holds of one task. The way back is ``unpacking``.

The way back from ``packing``: a MotionEmulator out of plain values and arrays, every one of them doubted.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.covariates import serialise as stored
from emulator.fitting.report import FitReport
from emulator.geometry.flattening import SIEM, Extrinsic, Flattening
from emulator.geometry.warps import through
from emulator.model.dwell_times import NONE, Dwells
from emulator.model.emulator import MotionEmulator
from emulator.model.feet import FIRST_PRINT, NO_FLOOR_M, PRINTS, Footing
from emulator.model.gaussian import LowRankNormal
from emulator.model.joint_coordinates import BLOCKS, CURVES, JointScale, Margin, bits, decode, encode, within_worker
from emulator.model.reduction import JointPCA
from emulator.model.smoothed import SmoothedScores, room
from emulator.people.population import Population
from emulator.people.workers import Told, Workforce
from emulator.skeleton import Skeleton

PCA = ("posture", "root", "pace", "bones")
DWELLS = ("clock", "zero_share", "mark_share")
POPULATION = ("rows", "drawn_in")
SMOOTHED = ("scores", "owner", "reach", "factor", "spread", "drawn_in", "tells")


def pack(model: Any) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model for the header, and its arrays by name; of a cyclic one: see ``cyclic.packing``."""
    from emulator.cyclic import serialise as cyclic
    from emulator.cyclic.model import CyclicEmulator

    return cyclic.pack(model) if isinstance(model, CyclicEmulator) else _pack(model)


def _pack(model: MotionEmulator) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    plain: dict[str, Any] = {
        "rides": model.rides,
        "spline_pace": True,
        "skeleton": {"names": list(model.skeleton.names), "parents": list(model.skeleton.parents)},
        "mark_names": list(model.mark_names),
        "n_times": model.n_times,
        "sizes": list(model.scale.sizes[: None if len(model.dwells) else -1]),
        "explained_variance": {name: getattr(model, name).explained_variance for name in PCA},
        "margin_slopes": [margin.slope for margin in (model.margin, *model.mark_margins)],
        "rho": {"between": model.workforce.between.rho, "within": model.workforce.within.rho},
        "workers": list(model.workforce.names),
        "group": model.workforce.group,
        "report": model.report.as_dict(),
    }
    arrays = {
        "centre": model.scale.centre,
        "spread": model.scale.spread,
        "effects": model.workforce.effects,
        "doubt": model.workforce.doubt,
    }
    if isinstance(model.flatten, SIEM):
        arrays["reference"] = model.flatten.reference
    if len(model.dwells):
        plain["dwell_slopes"] = [margin.slope for margin in model.dwells.margins]
        arrays |= {f"dwell_{name}": getattr(model.dwells, name) for name in DWELLS}
    for number, margin in enumerate(model.dwells.margins):
        arrays |= {f"dwell{number}_z": margin.z, f"dwell{number}_value": margin.value}
    for number, margin in enumerate((model.margin, *model.mark_margins)):
        arrays |= {f"margin{number}_z": margin.z, f"margin{number}_value": margin.value}
    for name in ("between", "within"):
        normal: LowRankNormal = getattr(model.workforce, name)
        arrays |= {f"{name}_mean": normal.mean, f"{name}_factor": normal.factor, f"{name}_spread": normal.spread}
    for name in ("pace", "bones"):
        arrays |= {f"{name}_mean": getattr(model, name).mean, f"{name}_basis": getattr(model, name).basis}
    for name in ("posture", "root"):
        pca: JointPCA = getattr(model, name)
        whole, exponent = encode(np.concatenate([pca.mean[None], pca.basis]), bits(model.n_times))
        arrays |= {f"{name}_whole": _steps(whole, model.n_times), f"{name}_exponent": exponent}
    if model.workforce.told is not None:
        plain["covariates"], told = stored.pack(model.workforce.told.model)
        arrays |= {f"covariates_{name}": value for name, value in told.items()}
        arrays["told_fitted"] = model.workforce.told.fitted
    if model.workforce.population is not None:
        arrays |= {f"population_{name}": getattr(model.workforce.population, name) for name in POPULATION}
    if model.footing is not None:
        prints = model.footing.prints
        plain |= {"floor": model.footing.floor, "prints": PRINTS[: prints.shape[-1]].tolist()}
        arrays["footing_floor"] = model.footing.foot_floor
        if not np.array_equal(_recorded_postures(model.scale, model.workforce), model.footing.postures):
            arrays["footing_postures"] = model.footing.postures
        arrays["footing_stands"] = np.packbits(model.footing.stands, axis=-1)
        arrays["footing_steps"] = _halves(np.rint(prints / PRINTS[: prints.shape[-1]]).astype(np.int16))
    if model.workforce.smoothed is not None:
        arrays |= {f"smoothed_{name}": getattr(model.workforce.smoothed, name) for name in SMOOTHED}
    return plain, arrays


def _steps(whole: np.ndarray, n_times: int) -> np.ndarray:
    """Whole (R, T * C) -> first values and steps along time (R, T, C), modulo 2^16 or 2^32: small, they pack well."""
    grid = whole.reshape(len(whole), n_times, -1)
    return np.concatenate([grid[:, :1], np.diff(grid, axis=1)], axis=1)


def _halves(whole: np.ndarray) -> np.ndarray:
    """Whole (N, 2, T, C) of 16 bits -> low and high bytes (2, N, 2, C, T) of first values and steps: they pack well."""
    steps = np.concatenate([whole[:, :, :1], np.diff(whole, axis=2)], axis=2).transpose(0, 1, 3, 2).astype("<u2")
    return np.stack([steps & 255, steps >> 8]).astype(np.uint8)


def _whole(halves: np.ndarray) -> np.ndarray:
    """The way back from ``_halves``."""
    steps = halves[0].astype(np.uint16) | (halves[1].astype(np.uint16) << 8)
    return np.cumsum(steps, axis=-1, dtype=np.uint16).view(np.int16).transpose(0, 1, 3, 2)


def _recorded_postures(scale: JointScale, workforce: Workforce) -> np.ndarray:
    """(N, P) posture coefficients of the recordings, where the workforce has them; else (0, P)."""
    known = workforce.smoothed
    return scale.raw(np.zeros((0, sum(scale.sizes))) if known is None else known.scores, "posture")


NEW = ("drawn_in", "tells")
"""Of smoothed scores, what libraries of before do not have."""


def unpack(task: str, plain: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Any:
    """The model; ``arrays`` are named task/name. Raises KeyError, TypeError or ValueError for what is no model.

    The header says of what kind it is; one that says nothing is a MotionEmulator, as in libraries of before.
    """
    kind = plain.get("kind", "repetitions")
    if kind == "repetitions":
        return _unpack(task, plain, arrays)
    if kind == "cyclic":
        from emulator.cyclic.serialise import unpack as cyclic

        return cyclic(task, plain, arrays)
    raise ValueError(f"{task}: is of kind {kind!r}, expected repetitions or cyclic; is the library newer than opsim?")


def _unpack(task: str, plain: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> MotionEmulator:
    parts = _Parts(task, plain, arrays)
    skeleton = Skeleton(tuple(plain["skeleton"]["names"]), tuple(plain["skeleton"]["parents"]))
    n_times, size = parts.n_times, dict(zip(BLOCKS, parts.sizes))
    mark_names = tuple(str(name) for name in plain["mark_names"])
    if (size["duration"], size["marks"]) != (1, len(mark_names)):
        raise ValueError(f"{task}: {size['marks']} mark coordinates for {len(mark_names)} marks")
    flatten = parts.flatten(skeleton.n_bones)
    scale, workforce = JointScale(parts.sizes, parts.array("centre", parts.k), parts.spread()), parts.workforce()
    return MotionEmulator(
        task,
        skeleton,
        mark_names,
        n_times,
        flatten,
        parts.long_pca("posture", size["posture"], flatten.n_channels),
        parts.long_pca("root", size["root"], 4),
        parts.pace(size["pace"]),
        parts.short_pca("bones", size["bones"], skeleton.n_bones),
        parts.margin("margin", 0),
        tuple(parts.margin("margin", 1 + e) for e in range(len(mark_names))),
        scale,
        workforce,
        FitReport.of_dict(plain["report"]),
        parts.dwells(size["dwells"], len(mark_names)),
        parts.footing(_recorded_postures(scale, workforce)),
        bool(plain.get("rides", True)),  # a library of before says nothing of it
    )


@dataclass(frozen=True)
class _Parts:
    """What a file says of one task. Each part raises ValueError where it makes no sense."""

    task: str
    plain: Mapping[str, Any]
    arrays: Mapping[str, np.ndarray]

    @property
    def n_times(self) -> int:
        n_times = int(self.plain["n_times"])
        if n_times < 2:
            raise ValueError(f"{self.task}: n_times {n_times} makes no sense")
        return n_times

    @property
    def sizes(self) -> tuple[int, ...]:
        """Of the blocks of z; where nothing pauses, the file has no block of dwells."""
        sizes = tuple(int(size) for size in self.plain["sizes"])
        sizes += (0,) * (len(sizes) == len(BLOCKS) - 1)
        if len(sizes) != len(BLOCKS) or min(sizes) < 0:
            raise ValueError(f"{self.task}: sizes {sizes} make no sense")
        return sizes

    @property
    def k(self) -> int:
        return sum(self.sizes)

    def array(self, name: str, *shape: int) -> np.ndarray:
        """The array of this name; -1 in shape takes any length."""
        found = self.arrays[f"{self.task}/{name}"]
        if found.ndim != len(shape) or any(want not in (-1, have) for want, have in zip(shape, found.shape)):
            raise ValueError(f"{self.task}/{name} has shape {found.shape}, expected {shape}")
        return found

    def flatten(self, n_bones: int) -> Flattening:
        """Tangent coordinates where a reference is there, as in all libraries of before."""
        if f"{self.task}/reference" not in self.arrays:
            return Extrinsic(n_bones)
        reference = self.array("reference", n_bones, 3)
        if not np.allclose(np.linalg.norm(reference, axis=-1), 1.0, atol=1e-6):
            raise ValueError(f"{self.task}/reference: found vectors of another length than 1")
        return SIEM(reference)

    def spread(self) -> np.ndarray:
        spread = self.array("spread", self.k)
        if np.any(spread <= 0):
            raise ValueError(f"{self.task}: a spread is not positive")
        return spread

    def long_pca(self, name: str, size: int, channels: int) -> JointPCA:
        whole = self.array(f"{name}_whole", size + 1, self.n_times, channels)
        rows = decode(_sums(whole), self.array(f"{name}_exponent", size + 1))
        return JointPCA(rows[0], rows[1:], self._share(name))

    def short_pca(self, name: str, size: int, length: int) -> JointPCA:
        mean = self.array(f"{name}_mean", length)
        return JointPCA(mean, self.array(f"{name}_basis", size, len(mean)), self._share(name))

    def pace(self, size: int) -> JointPCA:
        pca = self.short_pca("pace", size, -1)
        if self.plain.get("spline_pace"):
            return pca
        return JointPCA(through(pca.mean), through(pca.basis), pca.explained_variance)

    def margin(self, kind: str, number: int) -> Margin:
        z = self.array(f"{kind}{number}_z", -1)
        value, slope = self.array(f"{kind}{number}_value", len(z)), _number(self.plain[f"{kind}_slopes"][number])
        if len(z) == 0 or slope <= 0 or np.any(np.diff(z) <= 0) or np.any(np.diff(value) <= 0):
            raise ValueError(f"{self.task}: {kind} {number} does not increase")
        return Margin(z, value, slope)

    def dwells(self, n_sites: int, n_marks: int) -> Dwells:
        if n_sites == 0:
            return NONE
        clock, zero = self._shares("dwell_clock", n_sites), self._shares("dwell_zero_share", n_sites)
        mark = self._shares("dwell_mark_share", n_marks, n_sites)
        if np.any(zero == 1) or np.any(np.diff(clock) <= 0):
            raise ValueError(f"{self.task}: its sites of pauses make no sense")
        return Dwells(clock, zero, tuple(self.margin("dwell", j) for j in range(n_sites)), mark)

    def footing(self, recorded: np.ndarray) -> Footing | None:
        """recorded : (N, P) posture coefficients, which a library of before says once more."""
        if "floor" not in self.plain:
            return None
        own = f"{self.task}/footing_postures" in self.arrays
        postures = self.array("footing_postures", -1, recorded.shape[1]) if own else recorded
        packed = self.array("footing_stands", len(postures), 2, -(-self.n_times // 8))
        prints, floor = self._prints(len(postures)), _number(self.plain["floor"])
        if len(postures) == 0 or packed.dtype != np.uint8 or floor > 0:
            raise ValueError(f"{self.task}: its footing makes no sense")
        stands = np.unpackbits(packed, axis=-1, count=self.n_times).astype(bool)
        at = f"{self.task}/footing_floor"
        foot_floor = self.array("footing_floor", 2, 2) if at in self.arrays else np.full((2, 2), NO_FLOOR_M)
        return Footing(postures, stands, prints, floor, foot_floor)

    def _prints(self, n: int) -> np.ndarray:
        """(n, 2, T, 5), or (n, 2, T, 3) of a library of before, where feet have no direction."""
        if f"{self.task}/footing_steps" in self.arrays:
            steps = np.array([_number(step) for step in self.plain["prints"]])
            halves = self.array("footing_steps", 2, n, 2, len(steps), self.n_times)
            if halves.dtype != np.uint8 or len(steps) not in (3, 5) or np.any(steps <= 0):
                raise ValueError(f"{self.task}/footing_steps makes no sense")
            return _whole(halves) * steps
        whole = self.array("footing_prints", n, 2, self.n_times, 3)
        if whole.dtype != np.int16:
            raise ValueError(f"{self.task}/footing_prints: found {whole.dtype}, expected int16")
        return np.asarray(whole * _number(self.plain.get("print", FIRST_PRINT)))

    def workforce(self) -> Workforce:
        names = tuple(str(name) for name in self.plain["workers"])
        effects = self.array("effects", len(names), self.k)
        smoothed = self._smoothed(len(names)) if f"{self.task}/smoothed_scores" in self.arrays else None
        group = str(self.plain.get("group", self.plain["report"]["source"]))
        between, within = self._normal("between"), self._normal("within")
        there = f"{self.task}/doubt" in self.arrays  # a library of before says nothing of it
        doubt = self.array("doubt", len(names), self.k) if there else np.zeros_like(effects)
        if np.any(doubt < 0):
            raise ValueError(f"{self.task}/doubt: found a negative standard deviation")
        return Workforce(
            between,
            within,
            names,
            effects,
            doubt,
            smoothed,
            group,
            self._told(len(names)),
            self._population(len(names)),
        )

    def _told(self, n_workers: int) -> Told | None:
        if "covariates" not in self.plain:
            return None
        head = f"{self.task}/covariates_"
        arrays = {name.removeprefix(head): value for name, value in self.arrays.items() if name.startswith(head)}
        model = stored.unpack(self.plain["covariates"], arrays)
        if model.r2.shape != (self.k,):
            raise ValueError(f"{self.task}: covariates of {model.r2.size} coordinates, expected {self.k}")
        return Told(model, self.array("told_fitted", n_workers, self.k))

    def _population(self, n_workers: int) -> Population | None:
        if f"{self.task}/population_rows" not in self.arrays:
            return None
        sizes = dict(zip(BLOCKS, self.sizes))
        curves, bones = (
            np.concatenate([np.full(sizes[name], name in names) for name in BLOCKS]) for names in (CURVES, ("bones",))
        )
        drawn_in = self._shares("population_drawn_in", self.k)
        return Population(self.array("population_rows", n_workers, self.k), drawn_in, curves, bones)

    def _normal(self, name: str) -> LowRankNormal:
        factor, spread = self.array(f"{name}_factor", -1, self.k), self.array(f"{name}_spread", self.k)
        rho = _number(self.plain["rho"][name])
        if not 0 <= rho <= 1:
            raise ValueError(f"{self.task}: rho {rho} is not a share")
        if not np.allclose(np.sum(factor**2, axis=0), spread**2, rtol=1e-6, atol=1e-12):
            rows = f"the squares of its {len(factor)} rows do not add to the spread's"
            raise ValueError(f"{self.task}/{name}_factor: {rows}")
        return LowRankNormal(self.array(f"{name}_mean", self.k), factor, spread, rho)

    def _smoothed(self, n_workers: int) -> SmoothedScores:
        n, size = len(self.array("smoothed_scores", -1, self.k)), dict(zip(BLOCKS, self.sizes))
        n_curves = sum(size[name] for name in CURVES)
        told = (n_curves, self.k - n_curves)
        shapes = dict(zip(SMOOTHED, ((n, self.k), (n,), (n,), (-1, self.k), (self.k,), (self.k,), told)))
        there = f"{self.task}/smoothed_drawn_in" in self.arrays
        parts = {
            name: self.array(f"smoothed_{name}", *shape) for name, shape in shapes.items() if name not in NEW or there
        }
        if not there:  # a library of before: coordinate by coordinate
            noise, reach = np.sum(parts["factor"] ** 2, axis=0), np.mean(parts["reach"] ** 2)
            variance = np.mean(within_worker(parts["scores"], parts["owner"]) ** 2, axis=0)
            parts["tells"] = np.zeros(told)
            parts["drawn_in"] = room(parts["spread"] ** 2 - reach * noise, variance)
        found = SmoothedScores(**parts)
        if found.owner.dtype.kind != "i" or set(found.owner.tolist()) != set(range(n_workers)):
            raise ValueError(f"{self.task}/smoothed_owner: expected numbers of all {n_workers} workers")
        if any(np.any(part < 0) for part in (found.reach, found.spread, found.drawn_in)):
            raise ValueError(f"{self.task}: a reach, a spread or a share of the smoothed scores makes no sense")
        return found

    def _shares(self, name: str, *shape: int) -> np.ndarray:
        found = self.array(name, *shape)
        if np.any((found < 0) | (found > 1)):
            raise ValueError(f"{self.task}/{name}: found a value outside 0 to 1")
        return found

    def _share(self, name: str) -> float:
        assert name in PCA
        return _number(self.plain["explained_variance"][name])


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"found {value!r}, expected a number")
    return float(value)


def _sums(steps: np.ndarray) -> np.ndarray:
    """The way back from steps along time: (R, T, C) -> (R, T * C)."""
    if steps.dtype not in (np.int16, np.int32):
        raise ValueError(f"steps are {steps.dtype}, expected int16 or int32")
    return np.cumsum(steps, axis=1, dtype=steps.dtype).reshape(len(steps), -1)
