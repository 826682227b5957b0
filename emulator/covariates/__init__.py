"""What a person's body says of his movements: bodies, their table, and a model of mean joint coordinates.

A table of contents: importing it does nothing; a name is loaded when it is asked for (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "Agreement": "validated",
    "Body": "body",
    "BodyError": "body",
    "CovariateModel": "model",
    "CovariateTable": "table",
    "CovariateUse": "explained",
    "Prediction": "explained",
    "Validation": "validated",
    "bone_lengths_m": "bones",
    "icc_2_1": "agreement",
    "leave_one_worker_out": "validation",
    "pls1": "pls",
    "stature_m": "bones",
    "table_of": "table",
    "validate": "validation",
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"emulator.covariates.{_HOME[name]}"), name)
    raise AttributeError(f"emulator.covariates has no {name!r}; it has {', '.join(__all__)}")


def __dir__() -> list[str]:
    return __all__
