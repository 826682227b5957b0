"""From where a movement is looked at, and where its figures stand in the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

TRAVEL_M = 0.8
"""A pelvis that goes further than this is followed by the picture (walking)."""
NARROWEST_M = 0.95
"""Figures stand at least this far apart, else a slim movement would be drawn larger than others."""
THREE_QUARTER_RAD, FRONT_RAD = np.radians(28.0), np.radians(14.0)


@dataclass(frozen=True)
class Strip:
    """One row of figures: ``positions_m`` (T, J, 3) at T equal steps of ``duration_s``, marks in seconds, a label."""

    label: str
    positions_m: np.ndarray
    duration_s: float
    mark_s: np.ndarray


def _facing(positions: np.ndarray, skeleton: Any) -> tuple[np.ndarray, np.ndarray]:
    """Unit horizontal vectors (forward, left) of the person, from the mean hip line."""
    names = list(skeleton.names)
    across = (positions[:, names.index("left_hip")] - positions[:, names.index("right_hip")]).mean(axis=0)[:2]
    left = across / np.linalg.norm(across)
    return np.array([left[1], -left[0]]), left


def view_axes(positions: np.ndarray, skeleton: Any) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal unit vectors (picture's right, towards the viewer) from which the movement is seen best.

    The picture lies along the main horizontal direction of the movement, as far as the person still faces the viewer:
    a movement to the side is seen from the front, one forward and back from the side, turned by 28 degrees towards the
    front so that the far limbs are not hidden. positions: (T, J, 3) m.
    """
    forward, left = _facing(positions, skeleton)
    moving = (positions - positions[:, skeleton.parents.index(-1), None])[..., :2]
    moving = np.reshape((moving - moving.mean(axis=0)) @ np.stack([left, forward], axis=1), (-1, 2))
    (xx, xy), (_, yy) = moving.T @ moving
    main = np.arctan2(2 * xy, xx - yy) / 2  # of the covariance's ellipse, from the left-right line
    most = np.pi / 2 - THREE_QUARTER_RAD
    turn = most if abs(main) > most else np.sign(main or 1.0) * max(abs(main), FRONT_RAD)
    right = np.cos(turn) * left + np.sin(turn) * forward
    return right, np.cos(turn) * forward - np.sin(turn) * left


@dataclass(frozen=True)
class Stage:
    """What all rows share: view, metres of picture a second, seconds between figures, head and joint numbers."""

    right: np.ndarray
    viewer: np.ndarray
    m_per_s: float
    step_s: float
    skeleton: Any

    def flat(self, strip: Strip, at_s: float) -> tuple[np.ndarray, np.ndarray]:
        """The posture at ``at_s``: (J, 2) in the picture about the figure's place, and (J,) nearness to the viewer."""
        time = np.linspace(0.0, strip.duration_s, len(strip.positions_m))
        index = np.clip(np.searchsorted(time, at_s), 1, len(time) - 1)
        share = np.clip((at_s - time[index - 1]) / (time[index] - time[index - 1]), 0.0, 1.0)
        posture = (1 - share) * strip.positions_m[index - 1] + share * strip.positions_m[index]
        root = strip.positions_m[:, self.skeleton.parents.index(-1), :2]
        travels = np.linalg.norm(np.ptp(root, axis=0)) > TRAVEL_M
        centre = posture[self.skeleton.parents.index(-1), :2] if travels else root.mean(axis=0)
        around = posture[:, :2] - centre
        return np.stack([around @ self.right, posture[:, 2]], axis=-1), around @ self.viewer


def stage_of(strips: Sequence[Strip], skeleton: Any, n_figures: int) -> Stage:
    right, viewer = view_axes(strips[0].positions_m, skeleton)
    step_s = _round_step_s(max(strip.duration_s for strip in strips) / n_figures)
    unit = Stage(right, viewer, 1.0, step_s, skeleton)
    widths = [
        np.ptp(unit.flat(strip, at_s)[0][:, 0]) for strip in strips for at_s in np.linspace(0, strip.duration_s, 7)
    ]
    return Stage(right, viewer, max(max(widths) + 0.12, NARROWEST_M) / step_s, step_s, skeleton)


def _round_step_s(least_s: float) -> float:
    """The next number of seconds that a person would choose for an axis."""
    power = 10.0 ** np.floor(np.log10(least_s))
    return float(
        next(power * digit for digit in (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if power * digit >= least_s - 1e-12)
    )
