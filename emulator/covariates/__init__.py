"""What a person's body says of his movements: bodies, their table, and a model of mean joint coordinates.

A table of contents: importing it does nothing; a name is loaded when it is asked for (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "Agreement": "validation",
    "Body": "body",
    "BodyError": "body",
    "CovariateModel": "model",
    "CovariateTable": "table",
    "CovariateUse": "model",
    "Prediction": "model",
    "Validation": "validation",
    "bone_lengths_m": "body",
    "icc_2_1": "validation",
    "leave_one_worker_out": "validation",
    "pls1": "regression",
    "stature_m": "body",
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
