"""A CovariateModel as plain values and arrays and back, for a library file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from emulator.covariates.distribution import CovariateGaussian
from emulator.covariates.model import CovariateModel

ARRAYS = (
    *("low", "high", "centre", "slope", "level_effect", "n_components", "noise_p", "category_p"),
    *("r2", "error_spread"),
)
P_VALUES, NOT_TESTED = ("noise_p", "category_p"), -1.0
"""A library holds finite numbers only, so a p that could not be had is this."""
WORDS = ("names", "levels", "left_out", "category", "n_people")


def pack(model: CovariateModel) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model, and its arrays by name."""
    plain = {
        "names": list(model.names),
        "levels": list(model.levels),
        "left_out": [list(pair) for pair in model.left_out],
        "category": model.category,
        "n_people": model.n_people,
    }
    arrays = {name: getattr(model, name) for name in ARRAYS}
    arrays |= {name: np.where(np.isnan(arrays[name]), NOT_TESTED, arrays[name]) for name in P_VALUES}
    return plain, arrays | {"mean": model.gaussian.mean, "covariance": model.gaussian.covariance}


def unpack(plain: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> CovariateModel:
    """The model again, bit for bit. Raises ValueError that names all that is missing or has another shape."""
    missing = [name for name in WORDS if name not in plain]
    missing += [name for name in (*ARRAYS, "mean", "covariance") if name not in arrays]
    if missing:
        raise ValueError(f"covariates: a stored model has no {', '.join(missing)}")
    names, levels = tuple(str(name) for name in plain["names"]), tuple(str(level) for level in plain["levels"])
    wrong = _misshapen(len(names), len(levels), arrays)
    if wrong:
        raise ValueError("\n".join(wrong))
    return CovariateModel(
        names=names,
        levels=levels,
        left_out=tuple((str(name), str(why)) for name, why in plain["left_out"]),
        category=str(plain["category"]),
        n_people=int(plain["n_people"]),
        gaussian=CovariateGaussian(arrays["mean"], arrays["covariance"]),
        **{name: arrays[name] for name in ARRAYS if name not in P_VALUES},
        **{name: np.where(arrays[name] == NOT_TESTED, np.nan, arrays[name]) for name in P_VALUES},
    )


def _misshapen(p: int, c: int, arrays: Mapping[str, np.ndarray]) -> list[str]:
    k, v = np.shape(arrays["r2"])[-1:], (p + max(c - 1, 0),)
    expected: dict[str, tuple[int, ...]] = dict.fromkeys(ARRAYS, k)
    expected |= {"low": (p,), "high": (p,), "centre": (p,), "slope": (p, *k), "level_effect": (c, *k)}
    expected |= {"mean": v, "covariance": v * 2}
    return [
        f"covariates: stored {name}: found {np.shape(arrays[name])}, expected {shape}"
        for name, shape in expected.items()
        if np.shape(arrays[name]) != shape
    ]
