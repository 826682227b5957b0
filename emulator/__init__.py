"""A statistical motion emulator: from recordings to performances (posture, pace and duration in one draw).

A table of contents: importing it does nothing; a name is loaded when it is asked for (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "CANONICAL": "skeleton",
    "Skeleton": "skeleton",
    "canonical_name": "skeleton",
    "Motion": "motion",
    "MotionSet": "motion",
    "motion_from_positions": "motion",
    "RecordingError": "recordings",
    "read_motions": "recordings",
    "Alignment": "align",
    "align_to": "align",
    "resample": "align",
    "pair_warp": "elastic",
    "tsrvf": "elastic",
    "MotionEmulator": "model",
    "MotionPerformances": "performances",
    "MotionLibrary": "library",
    "LibraryError": "library",
    "FitReport": "fit_report",
    "Truth": "synthetic",
    "CompositeEmulator": "composite",
    "Part": "composite",
}
_MODULES = ("align", "clean", "elastic", "joined", "recordings", "skeleton", "sphere", "synthetic", "warp")

__all__ = sorted([*_HOME, *_MODULES])


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"emulator.{_HOME[name]}"), name)
    if name in _MODULES:
        return import_module(f"emulator.{name}")
    raise AttributeError(f"emulator has no {name!r}; it has {', '.join(__all__)}")


def __dir__() -> list[str]:
    return __all__
