"""What ``opsim export`` says when it is done."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Told:
    """lines : for people; plain : for machines"""

    lines: tuple[str, ...]
    plain: dict[str, Any]


def size(n_bytes: int) -> str:
    """A file's size in words."""
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e5 else f"{n_bytes / 1e3:.1f} kB"
