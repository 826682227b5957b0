"""What a picture needs that not everybody has installed."""

from __future__ import annotations

from importlib.util import find_spec


def need_matplotlib(what: str) -> None:
    """Raises ValueError, saying how to get it, where matplotlib is not installed."""
    if find_spec("matplotlib") is None:
        raise ValueError(f"{what} need matplotlib, which is not installed; 'pip install opsim[matplotlib]' brings it")
