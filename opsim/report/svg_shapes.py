"""Outlines of round shapes as the ``d`` of an SVG path, all the same way round: several make one filled area."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.body_parts import outer_tangents


def path_of(kind: str, what: Any) -> str:
    """Of a shape of ``body_parts``: taper, disc or inside."""
    if kind == "inside":
        return polygon(what)
    if kind == "disc":
        return disc(*what)
    return taper(*what)


def taper(a: np.ndarray, b: np.ndarray, a_px: float, b_px: float) -> str:
    """Two discs and what lies between their outer tangents."""
    corners = outer_tangents(a, b, a_px, b_px)
    if not len(corners):
        return disc(a, a_px) if a_px >= b_px else disc(b, b_px)
    on_a, on_b, from_b, back = map(_point, corners)
    round_b, round_a = (
        f"A{r:.1f} {r:.1f} 0 {int(large)} 0 " for r, large in ((b_px, b_px > a_px), (a_px, a_px > b_px))
    )
    return f"M{on_a}L{on_b}{round_b}{from_b}L{back}{round_a}{on_a}Z"


def disc(middle: np.ndarray, radius_px: float) -> str:
    """A whole circle, as two arcs."""
    left, right = (_point(np.array([middle[0] + way * radius_px, middle[1]])) for way in (-1, 1))
    half = f"A{radius_px:.1f} {radius_px:.1f} 0 0 0 "
    return f"M{right}{half}{left}{half}{right}Z"


def polygon(corners: np.ndarray) -> str:
    """Corners (n, 2), turned round where they run the other way."""
    x, y = corners[:, 0], corners[:, 1]
    clockwise = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) > 0  # as seen, since y points down
    return f"M{'L'.join(map(_point, corners[::-1] if clockwise else corners))}Z"


def _point(at: np.ndarray) -> str:
    return f"{at[0]:.1f} {at[1]:.1f}"
