"""A MotionEmulator as plain values and arrays: what a library holds of one task. The way back is ``unpacking``."""

from __future__ import annotations

from typing import Any

import numpy as np

from emulator.covariates import stored
from emulator.density import LowRankNormal
from emulator.footing import PRINT
from emulator.model import MotionEmulator
from emulator.reduce import JointPCA
from emulator.storage import bits, encode

PCA = ("posture", "root", "pace", "bones")
DWELLS = ("clock", "zero_share", "mark_share")
POPULATION = ("rows", "drawn_in")
SMOOTHED = ("scores", "owner", "reach", "factor", "spread", "drawn_in", "partner", "tells")


def pack(model: Any) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model for the header, and its arrays by name; of a cyclic one: see ``cyclic.packing``."""
    from emulator.cyclic import packing as cyclic
    from emulator.cyclic.model import CyclicEmulator

    return cyclic.pack(model) if isinstance(model, CyclicEmulator) else _pack(model)


def _pack(model: MotionEmulator) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    plain: dict[str, Any] = {
        "rides": model.rides,
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
        "reference": model.flatten.reference,
        "centre": model.scale.centre,
        "spread": model.scale.spread,
        "effects": model.workforce.effects,
        "doubt": model.workforce.doubt,
    }
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
        plain |= {"floor": model.footing.floor, "print": PRINT}
        arrays["footing_floor"] = model.footing.foot_floor
        arrays["footing_postures"] = model.footing.postures
        arrays["footing_stands"] = np.packbits(model.footing.stands, axis=-1)
        arrays["footing_prints"] = np.rint(model.footing.prints / PRINT).astype(np.int16)
    if model.workforce.smoothed is not None:
        arrays |= {f"smoothed_{name}": getattr(model.workforce.smoothed, name) for name in SMOOTHED}
    return plain, arrays


def _steps(whole: np.ndarray, n_times: int) -> np.ndarray:
    """Whole (R, T * C) -> first values and steps along time (R, T, C), modulo 2^16 or 2^32: small, they pack well."""
    grid = whole.reshape(len(whole), n_times, -1)
    return np.concatenate([grid[:, :1], np.diff(grid, axis=1)], axis=1)
