"""A MotionEmulator as plain values and arrays, what a library holds of one task, and back.

On the way back every value and array is doubted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from emulator.byte_planes import from_planes, to_planes
from emulator.covariates import serialise as stored
from emulator.fitting.report import FitReport
from emulator.geometry.flattening import SIEM, Extrinsic, Flattening
from emulator.geometry.warps import through
from emulator.model.dwell_times import NONE, Dwells
from emulator.model.emulator import MotionEmulator
from emulator.model.feet import FIRST_PRINT, NO_FLOOR, PRINTS, STRAY, Footing
from emulator.model.gaussian import LowRankNormal
from emulator.model.joint_coordinates import BLOCKS, CURVES, JointScale, Margin, bits, decode, encode, within_worker
from emulator.model.reduction import JointPCA
from emulator.model.smoothed import SmoothedScores, less_told, room
from emulator.people.bone_turns import BoneTurns
from emulator.people.kinds import Kinds
from emulator.people.population import Population
from emulator.people.workers import Told, Workforce
from emulator.skeleton import Skeleton
from emulator.stored import StoredArrays, packed

PCA = ("posture", "root", "pace", "bones")
CURVE = {"mean": ("C",), "basis": ("R", "C")}
DWELLS = {"clock": ("S",), "zero_share": ("S",), "mark_share": ("E", "S")}
NORMAL = {"mean": ("K",), "factor": ("R", "K"), "spread": ("K",)}
POPULATION = {"rows": ("W", "K"), "drawn_in": ("K",), "fine": ("W", "K")}
KINDS = {"of": ("W",), "shift": ("W", "K")}
SMOOTHED = {
    "scores": ("N", "K"), "owner": ("N",), "reach": ("N",), "factor": ("R", "K"), "spread": ("K",),
    "left": ("N", "K"), "tells": ("curves", "others"),
}  # fmt: skip
"""Arrays of each record: K coordinates, W workers, N recordings, S sites of pauses, E marks."""


def pack(model: Any) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model for the header, and its arrays by name; of a cyclic one: see ``cyclic.serialise``."""
    from emulator.cyclic import serialise as cyclic
    from emulator.cyclic.model import CyclicEmulator

    if getattr(model, "targets", ()):
        raise ValueError(f"{model.task}: is given targets, which no library holds; save the emulator it was made of")
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
        arrays |= packed(model.dwells, DWELLS, "dwell_")
    for number, margin in enumerate(model.dwells.margins):
        arrays |= {f"dwell{number}_z": margin.z, f"dwell{number}_value": margin.value}
    for number, margin in enumerate((model.margin, *model.mark_margins)):
        arrays |= {f"margin{number}_z": margin.z, f"margin{number}_value": margin.value}
    for name in ("between", "within"):
        arrays |= packed(getattr(model.workforce, name), NORMAL, f"{name}_")
    for name in ("pace", "bones"):
        arrays |= packed(getattr(model, name), CURVE, f"{name}_")
    for name in ("posture", "root"):
        pca: JointPCA = getattr(model, name)
        whole, exponent = encode(np.concatenate([pca.mean[None], pca.basis]), bits(model.n_times))
        grid = whole.reshape(len(whole), model.n_times, -1).transpose(0, 2, 1)
        arrays |= {f"{name}_planes": to_planes(np.ascontiguousarray(grid)), f"{name}_exponent": exponent}
    if model.workforce.told is not None:
        plain["covariates"], told = stored.pack(model.workforce.told.model)
        arrays |= {f"covariates_{name}": value for name, value in told.items()}
        arrays["told_fitted"] = model.workforce.told.fitted
    if model.workforce.population is not None:
        plain["turns"] = asdict(model.workforce.population.turns)
        arrays |= packed(model.workforce.population, POPULATION, "population_")
    if model.workforce.kinds.several:
        arrays |= packed(model.workforce.kinds, KINDS, "kinds_")
    if model.footing is not None:
        prints = model.footing.prints
        plain["prints"] = PRINTS[: prints.shape[-1]].tolist()
        arrays["footing_lowest"] = np.column_stack(
            [model.footing.floor, model.footing.foot_floor.reshape(len(prints), -1)]
        )
        if np.isfinite(model.footing.strays).all():
            arrays["footing_strays"] = to_planes(np.rint(model.footing.strays / STRAY).astype(np.int16))
        if not np.array_equal(_recorded_postures(model.scale, model.workforce), model.footing.postures):
            arrays["footing_postures"] = model.footing.postures
        arrays["footing_stands"] = np.packbits(model.footing.stands, axis=-1)
        steps = np.rint(prints / PRINTS[: prints.shape[-1]]).astype(np.int32)
        arrays["footing_planes"] = to_planes(np.ascontiguousarray(np.moveaxis(steps, 2, 3)))
    if model.workforce.smoothed is not None:
        arrays |= packed(model.workforce.smoothed, SMOOTHED, "smoothed_")
    return plain, arrays


def _recorded_postures(scale: JointScale, workforce: Workforce) -> np.ndarray:
    """(N, P) posture coefficients of the recordings, where the workforce has them; else (0, P)."""
    known = workforce.smoothed
    return scale.raw(np.zeros((0, sum(scale.sizes))) if known is None else known.scores, "posture")


NEW = ("left", "tells")
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
    skeleton = Skeleton(tuple(plain["skeleton"]["names"]), tuple(plain["skeleton"]["parents"]))
    mark_names = tuple(str(name) for name in plain["mark_names"])
    size, n_times = _sizes(task, plain["sizes"]), int(plain["n_times"])
    if n_times < 2:
        raise ValueError(f"{task}: n_times {n_times} makes no sense")
    if (size["duration"], size["marks"]) != (1, len(mark_names)):
        raise ValueError(f"{task}: {size['marks']} mark coordinates for {len(mark_names)} marks")
    n_curves, k = sum(size[name] for name in CURVES), sum(size.values())
    letters = {"curves": n_curves, "others": k - n_curves, "K": k, "W": len(plain["workers"]), "T": n_times}
    own = StoredArrays.of(task, arrays, **letters, S=size["dwells"], E=size["marks"])
    parts = _Parts(plain, own, size)
    flatten = parts.flatten(skeleton.n_bones)
    scale, workforce = JointScale(tuple(size.values()), own.array("centre", "K"), parts.spread()), parts.workforce()
    return MotionEmulator(
        task,
        skeleton,
        mark_names,
        n_times,
        flatten,
        parts.long_pca("posture", flatten.n_channels),
        parts.long_pca("root", 4),
        parts.pace(),
        parts.short_pca("bones", skeleton.n_bones),
        parts.margin("margin", 0),
        tuple(parts.margin("margin", 1 + e) for e in range(len(mark_names))),
        scale,
        workforce,
        FitReport.of_dict(plain["report"]),
        parts.dwells(),
        parts.footing(_recorded_postures(scale, workforce)),
        bool(plain.get("rides", True)),  # a library of before says nothing of it
    )


def _sizes(task: str, said: Any) -> dict[str, int]:
    """Of the blocks of z; where nothing pauses, the file has no block of dwells."""
    sizes = tuple(int(size) for size in said)
    sizes += (0,) * (len(sizes) == len(BLOCKS) - 1)
    if len(sizes) != len(BLOCKS) or min(sizes) < 0:
        raise ValueError(f"{task}: sizes {sizes} make no sense")
    return dict(zip(BLOCKS, sizes))


@dataclass(frozen=True)
class _Parts:
    """What a file says of one task. Each part raises ValueError where it makes no sense."""

    plain: Mapping[str, Any]
    own: StoredArrays
    size: Mapping[str, int]

    @property
    def task(self) -> str:
        return self.own.task

    def flatten(self, n_bones: int) -> Flattening:
        """Tangent coordinates where a reference is there, as in all libraries of before."""
        if "reference" not in self.own:
            return Extrinsic(n_bones)
        reference = self.own.array("reference", n_bones, 3)
        if not np.allclose(np.linalg.norm(reference, axis=-1), 1.0, atol=1e-6):
            raise ValueError(f"{self.task}/reference: found vectors of another length than 1")
        return SIEM(reference)

    def spread(self) -> np.ndarray:
        spread = self.own.array("spread", "K")
        if np.any(spread <= 0):
            raise ValueError(f"{self.task}: a spread is not positive")
        return spread

    def long_pca(self, name: str, channels: int) -> JointPCA:
        n = self.size[name] + 1
        if f"{name}_planes" in self.own:
            grid = from_planes(self.own.array(f"{name}_planes", -1, n, channels, "T")).transpose(0, 2, 1)
            whole = grid.reshape(n, -1)
        else:  # a library of before
            whole = _sums(self.own.array(f"{name}_whole", n, "T", channels))
        rows = decode(whole, self.own.array(f"{name}_exponent", n))
        return JointPCA(rows[0], rows[1:], self._explained(name))

    def short_pca(self, name: str, length: int) -> JointPCA:
        mean = self.own.array(f"{name}_mean", length)
        return JointPCA(mean, self.own.array(f"{name}_basis", self.size[name], len(mean)), self._explained(name))

    def pace(self) -> JointPCA:
        pca = self.short_pca("pace", -1)
        if self.plain.get("spline_pace"):
            return pca
        return JointPCA(through(pca.mean), through(pca.basis), pca.explained_variance)

    def margin(self, kind: str, number: int) -> Margin:
        z = self.own.array(f"{kind}{number}_z", -1)
        value = self.own.array(f"{kind}{number}_value", len(z))
        slope = self.own.number(f"{kind}_slopes", self.plain[f"{kind}_slopes"][number])
        if len(z) == 0 or slope <= 0 or np.any(np.diff(z) <= 0) or np.any(np.diff(value) <= 0):
            raise ValueError(f"{self.task}: {kind} {number} does not increase")
        return Margin(z, value, slope)

    def dwells(self) -> Dwells:
        if self.size["dwells"] == 0:
            return NONE
        found = self.own.record(DWELLS, "dwell_", low=0.0, high=1.0)
        if np.any(found["zero_share"] == 1) or np.any(np.diff(found["clock"]) <= 0):
            raise ValueError(f"{self.task}: its sites of pauses make no sense")
        return Dwells(**found, margins=tuple(self.margin("dwell", j) for j in range(self.size["dwells"])))

    def footing(self, recorded: np.ndarray) -> Footing | None:
        """recorded : (N, P) posture coefficients, which a library of before says once more."""
        own, known = "footing_postures" in self.own, "footing_lowest" in self.own
        if not known and "floor" not in self.plain:
            return None
        postures = self.own.array("footing_postures", -1, self.size["posture"]) if own else recorded
        n, n_times = len(postures), self.own.letters["T"]
        stands = self.own.array("footing_stands", n, 2, -(-n_times // 8))
        lowest = self.own.array("footing_lowest", n, -1) if known else np.tile(self._one_floor(), (n, 1))
        if n == 0 or stands.dtype != np.uint8 or np.any(lowest[:, 0] > 0) or lowest.shape[1] not in range(5, 99, 2):
            raise ValueError(f"{self.task}: its footing makes no sense")
        stands = np.unpackbits(stands, axis=-1, count=n_times).astype(bool)
        strays = np.full((n, n_times), np.inf)
        if "footing_strays" in self.own:
            strays = from_planes(self.own.array("footing_strays", 2, n, "T")) * STRAY
        return Footing(postures, stands, self._prints(n), lowest[:, 0], lowest[:, 1:].reshape(n, 2, -1), strays)

    def _one_floor(self) -> np.ndarray:
        """(5,) heights of the lowest joint and of the feet in a library of before, which has one floor for all."""
        feet = self.own.array("footing_floor", 2, 2) if "footing_floor" in self.own else np.full((2, 2), NO_FLOOR)
        return np.append(self.own.number("floor", self.plain["floor"]), feet)

    def _prints(self, n: int) -> np.ndarray:
        """(n, 2, T, 5), or (n, 2, T, 3) of a library of before, where feet have no direction."""
        if "footing_planes" in self.own:
            steps = np.array([self.own.number("prints", step) for step in self.plain["prints"]])
            if len(steps) not in (3, 5) or np.any(steps <= 0):
                raise ValueError(f"{self.task}: prints: found {self.plain['prints']}, expected 3 or 5 positive numbers")
            whole = from_planes(self.own.array("footing_planes", -1, n, 2, len(steps), "T"))
            return np.moveaxis(whole, 3, 2) * steps
        whole = self.own.array("footing_prints", n, 2, "T", 3)
        if whole.dtype != np.int16:
            raise ValueError(f"{self.task}/footing_prints: found {whole.dtype}, expected int16")
        return np.asarray(whole * self.own.number("print", self.plain.get("print", FIRST_PRINT)))

    def workforce(self) -> Workforce:
        effects = self.own.array("effects", "W", "K")
        known = "doubt" in self.own  # a library of before says nothing of it
        doubt = self.own.array("doubt", "W", "K", low=0.0) if known else np.zeros_like(effects)
        kinds = self._kinds()
        return Workforce(
            self._normal("between"),
            self._normal("within"),
            tuple(str(name) for name in self.plain["workers"]),
            effects,
            doubt,
            kinds,
            self._smoothed() if "smoothed_scores" in self.own else None,
            str(self.plain.get("group", self.plain["report"]["source"])),
            self._told() if "covariates" in self.plain else None,
            self._population(kinds) if "population_rows" in self.own else None,
        )

    def _kinds(self) -> Kinds:
        """All of one kind in a library that says nothing of kinds."""
        if "kinds_of" not in self.own:
            return Kinds.one(self.own.letters["W"], self.own.letters["K"])
        found = Kinds(**self.own.record(KINDS, "kinds_"), differ=self._among(CURVES))
        numbers = found.of.tolist()
        if found.of.dtype.kind != "i" or set(numbers) != set(range(max(numbers) + 1)) or found.alone.all():
            wrong = f"found {numbers}, expected whole numbers from 0, none left out and one of them twice"
            raise ValueError(f"{self.task}/kinds_of: {wrong}")
        return found

    def _told(self) -> Told:
        head = "covariates_"
        arrays = {name.removeprefix(head): a for name, a in self.own.arrays.items() if name.startswith(head)}
        model = stored.unpack(self.plain["covariates"], arrays)
        if model.r2.shape != (self.own.letters["K"],):
            raise ValueError(
                f"{self.task}: covariates of {model.r2.size} coordinates, expected {self.own.letters['K']}"
            )
        return Told(model, self.own.array("told_fitted", "W", "K"))

    def _population(self, kinds: Kinds) -> Population:
        curves, bones = self._among(CURVES), self._among(("bones",))
        table = {name: shape for name, shape in POPULATION.items() if name != "fine" or "population_fine" in self.own}
        found = self.own.record(table, "population_")
        fine = found.get("fine", np.zeros_like(found["rows"]))  # libraries of before have none
        drawn_in = self.own.shares("population_drawn_in", "K")
        return Population(found["rows"], drawn_in, fine, curves, bones, kinds, self._turns())

    def _turns(self) -> BoneTurns:
        """Of libraries of before none."""
        said = self.plain.get("turns", {})
        turns = BoneTurns(**{name: self.own.number(f"turns.{name}", value) for name, value in said.items()})
        if turns.spread_rad < 0 or not (0 <= turns.alike <= 1 and 0 <= turns.upright <= 1):
            raise ValueError(f"{self.task}: {turns} makes no sense")
        return turns

    def _among(self, blocks: Sequence[str]) -> np.ndarray:
        """(K,) which coordinates are of these blocks."""
        return np.concatenate([np.full(n, block in blocks) for block, n in self.size.items()])

    def _normal(self, name: str) -> LowRankNormal:
        found, rho = self.own.record(NORMAL, f"{name}_"), self.own.number("rho", self.plain["rho"][name])
        if not 0 <= rho <= 1:
            raise ValueError(f"{self.task}: rho {rho} is not a share")
        if not np.allclose(np.sum(found["factor"] ** 2, axis=0), found["spread"] ** 2, rtol=1e-6, atol=1e-12):
            rows = f"the squares of its {len(found['factor'])} rows do not add to the spread's"
            raise ValueError(f"{self.task}/{name}_factor: {rows}")
        return LowRankNormal(**found, rho=rho)

    def _smoothed(self) -> SmoothedScores:
        table = {name: shape for name, shape in SMOOTHED.items() if f"smoothed_{name}" in self.own or name not in NEW}
        parts = self.own.record(table, "smoothed_")
        n_workers = self.own.letters["W"]
        parts.setdefault("tells", np.zeros((self.own.letters["curves"], self.own.letters["others"])))
        if "left" not in parts:
            own = within_worker(parts["scores"], parts["owner"])
            parts["left"] = less_told(own, parts["tells"]) * self._drawn_in(parts, np.mean(own**2, axis=0))
        found = SmoothedScores(**parts)
        if found.owner.dtype.kind != "i" or set(found.owner.tolist()) != set(range(n_workers)):
            raise ValueError(f"{self.task}/smoothed_owner: expected numbers of all {n_workers} workers")
        if any(np.any(part < 0) for part in (found.reach, found.spread)):
            raise ValueError(f"{self.task}: a reach or a spread of the smoothed scores makes no sense")
        return found

    def _drawn_in(self, parts: Mapping[str, np.ndarray], variance: np.ndarray) -> np.ndarray:
        """(K,) what deviations of this variance (K,) are drawn in by in libraries of before, one by one."""
        if "smoothed_drawn_in" in self.own:
            return self.own.array("smoothed_drawn_in", "K", low=0.0)
        noise, reach = np.sum(parts["factor"] ** 2, axis=0), np.mean(parts["reach"] ** 2)
        return room(parts["spread"] ** 2 - reach * noise, variance)

    def _explained(self, name: str) -> float:
        return self.own.number("explained_variance", self.plain["explained_variance"][name])


def _sums(steps: np.ndarray) -> np.ndarray:
    """The way back from steps along time: (R, T, C) -> (R, T * C)."""
    if steps.dtype not in (np.int16, np.int32):
        raise ValueError(f"steps are {steps.dtype}, expected int16 or int32")
    return np.cumsum(steps, axis=1, dtype=steps.dtype).reshape(len(steps), -1)
