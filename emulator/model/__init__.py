"""The joint law of posture, root, pace, duration, marks and bones: how it is held, drawn from, decoded and stored."""

from __future__ import annotations

from typing import Any

__all__ = ["LibraryError", "MotionEmulator", "MotionLibrary", "MotionPerformances"]


def __getattr__(name: str) -> Any:
    """Names of the front door, loaded when asked for."""
    if name not in __all__:
        raise AttributeError(f"emulator.model has no {name!r}; it has {', '.join(__all__)}")
    import emulator

    return getattr(emulator, name)
