"""A MotionEmulator as plain values and arrays, and back: what a library holds of one task."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

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

_PCA = ("posture", "root", "pace", "bones")


def pack(model: MotionEmulator) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model for the header, and its arrays by name."""
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


def unpack(task: str, plain: dict[str, Any], arrays: dict[str, np.ndarray]) -> MotionEmulator:
    """The way back; ``arrays`` are named task/name. Raises KeyError, TypeError or ValueError for no model."""

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
        if not np.allclose(np.sum(parts[1] ** 2, axis=0), parts[2] ** 2, rtol=1e-6, atol=1e-12):
            raise ValueError(
                f"{task}/{name}_factor: the squares of its {len(parts[1])} rows do not add to the spread's"
            )
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

    reference = array("reference", skeleton.n_bones, 3)
    if not np.allclose(np.linalg.norm(reference, axis=-1), 1.0, atol=1e-6):
        raise ValueError(f"{task}/reference: found vectors of another length than 1")

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
        SIEM(reference),
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
