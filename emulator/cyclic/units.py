"""Units of cyclic motion: how it starts from standing, and how it ends; kept as latents, joined at a beat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

JOIN_FRAMES = 8
"""Within so many frames what is left of a difference at a join has gone."""


@dataclass(frozen=True, eq=False)
class Unit:
    """A stretch from standing to a beat (start), or from a beat to standing (stop).

    z : (F, d) latents without the worker's own offset, contact : (F, 2), control : as of the dynamics
    foot : 0 or 1, which comes down at the beat; -1 where no foot does
    """

    z: np.ndarray
    contact: np.ndarray
    control: float
    foot: int

    @property
    def n_steps(self) -> int:
        """Frames from its first to its last."""
        return len(self.z) - 1


def chosen(units: Sequence[Unit], foot: int, control: float, z: np.ndarray | None = None) -> Unit:
    """The unit at this foot whose control is nearest, and, among those about as near, the one that begins nearest to z.

    Units of the other foot only where there is none of this.
    """
    fitting = [unit for unit in units if unit.foot == foot] or list(units)
    away = np.array([abs(unit.control - control) for unit in fitting])
    if z is None:
        return fitting[int(away.argmin())]
    apart = np.array([np.linalg.norm(unit.z[0] - z) for unit in fitting])
    return fitting[int((away + 0.5 * apart).argmin())]


def joined(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Latents before (F, d) and after (G, d), whose first frame is the last one of before -> (F + G - 1, d).

    What differs at the join, in place and in rate, goes away within JOIN_FRAMES of ``after``: the speed has no jump.
    """
    span = min(JOIN_FRAMES, len(after) - 1)
    if span < 1 or len(before) < 2:
        return np.concatenate([before[:-1], after])
    gap = before[-1] - after[0]
    rate = ((before[-1] - before[-2]) - (after[1] - after[0])) * span
    u = np.clip(np.arange(len(after)) / span, 0.0, 1.0)[:, None]
    eased = after + gap * (1 + 2 * u) * (1 - u) ** 2 + np.clip(rate, -2.0, 2.0) * u * (1 - u) ** 2
    return np.concatenate([before[:-1], eased])


def spread_out(units: Sequence[Unit], at_most: int) -> tuple[Unit, ...]:
    """At most so many of the units, of both feet and evenly over their controls."""
    kept: list[Unit] = []
    feet = sorted({unit.foot for unit in units})
    for foot in feet:
        own = sorted((unit for unit in units if unit.foot == foot), key=lambda unit: unit.control)
        places = np.unique(np.linspace(0, len(own) - 1, max(at_most // len(feet), 1)).round().astype(int))
        kept += [own[int(i)] for i in places]
    return tuple(kept)
