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
    "family": "recordings.family",
    "Alignment": "geometry.alignment",
    "align_to": "geometry.alignment",
    "resample": "geometry.flattening",
    "pair_warp": "geometry.elastic",
    "tsrvf": "geometry.elastic",
    "MotionEmulator": "model.emulator",
    "MotionPerformances": "model.performances",
    "MotionLibrary": "model.library",
    "Target": "model.targets",
    "LibraryError": "model.library",
    "FitReport": "fitting.report",
    "Truth": "synthetic",
    "CompositeEmulator": "composite.task",
    "Part": "composite.task",
}
_MODULES = {
    "align": "geometry.alignment",
    "clean": "motion",
    "elastic": "geometry.elastic",
    "joined": "composite.joining",
    "recordings": "recordings",
    "skeleton": "skeleton",
    "sphere": "geometry.sphere",
    "synthetic": "synthetic",
    "warp": "geometry.warps",
}
"""Modules by the names that they are asked for by."""

__all__ = sorted([*_HOME, *_MODULES])


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"emulator.{_HOME[name]}"), name)
    if name in _MODULES:
        return import_module(f"emulator.{_MODULES[name]}")
    raise AttributeError(f"emulator has no {name!r}; it has {', '.join(__all__)}")


def __dir__() -> list[str]:
    return __all__
