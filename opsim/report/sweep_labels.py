"""Paths and values as the pictures of a sweep have room for."""

from __future__ import annotations


def shortened(words: str, most: int) -> str:
    """The beginning, of values."""
    return words if len(words) <= most else words[: most - 1] + "…"


def fitting(path: str, most: int = 40) -> str:
    """The end, which says more of a path than its beginning."""
    return path if len(path) <= most else "…" + path[-(most - 1) :]


def tick_words(at: float) -> str:
    """A round number on an axis."""
    return f"{at:,.10g}".replace("-", "\N{MINUS SIGN}")
