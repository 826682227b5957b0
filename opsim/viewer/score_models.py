"""Codec ``scores``: what an emulator decodes performances from, and their coefficients, for the page to do the same.

By duck typing of ``emulator.MotionEmulator`` and its performances.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.viewer.columns import Columns
from opsim.viewer.scene import Drawn
from opsim.viewer.skeletons import tree_of

OF_MODEL = ("posture", "root", "pace", "bones", "flatten", "scale", "dwells", "n_times", "warps", "dwell_s")
OF_BLOCK = ("scores", "body_scale", "duration_s", "skeleton")
SOFT_M = 0.01
"""Feet within about this height of the lowest share the support: the emulator's own; a test compares them."""
_FEET = ("left_ankle", "left_toe", "right_ankle", "right_toe")
_LEGS = ("left_knee", "left_ankle", "right_knee", "right_ankle")
BLOCKS = ("posture", "root", "pace", "bones")


def is_of_scores(block: Any) -> bool:
    """Whether performances are decoded from coefficients in the way that the page knows."""
    model = getattr(block, "model", None)
    return all(hasattr(block, name) for name in OF_BLOCK) and all(hasattr(model, name) for name in OF_MODEL)


def pack_scores(drawn: Drawn, skeleton: int, columns: Columns, prefix: str) -> dict[str, Any]:
    """The model's entry of the page's description; its columns are added under names that begin with ``prefix``."""
    model = drawn.blocks[0].model
    scores = np.concatenate([block.scores for block in drawn.blocks])
    raw = {name: model.scale.raw(scores, name) for name in BLOCKS}
    roles = {**_of_model(model), **_of_performances(drawn, model, scores, raw)}
    names, parents = tree_of(drawn.skeleton)
    bones = [names[joint] for joint, parent in enumerate(parents) if parent >= 0]
    legs = [bones.index(name) for name in _LEGS if name in bones]
    return {
        "codec": "scores",
        "name": drawn.name,
        "skeleton": skeleton,
        "n_times": model.n_times,
        "n_knots": int(model.pace.mean.size),
        "n": len(drawn),
        "sizes": {**{name: raw[name].shape[1] for name in BLOCKS}, "dwells": len(model.dwells)},
        "feet": [names.index(name) for name in _FEET if name in names],
        "legs": legs if len(legs) == 4 else [],
        "soft_m": SOFT_M,
        "columns": {role: columns.add(f"{prefix}{role}", *column) for role, column in roles.items()},
    }


def _of_model(model: Any) -> dict[str, tuple[str, np.ndarray]]:
    """What does not change from one performance to the next."""
    least, most = np.broadcast_to(model.slope_limits, (2, model.pace.mean.size))
    return {
        "posture_mean": ("f4", model.posture.mean),
        "posture_basis": ("f4", model.posture.basis),
        "frame": ("f4", _frame(model.flatten.reference)),
        "root_mean": ("f4", model.root.mean),
        "root_basis": ("f4", model.root.basis),
        "pace_mean": ("f4", model.pace.mean),
        "pace_basis": ("f4", model.pace.basis),
        "slope_least": ("f4", least),
        "slope_most": ("f4", most),
        "bones_mean": ("f4", model.bones.mean),
        "bones_basis": ("f4", model.bones.basis),
        "dwell_clock": ("f4", np.asarray(model.dwells.clock)),
    }


def _of_performances(
    drawn: Drawn, model: Any, scores: np.ndarray, raw: dict[str, np.ndarray]
) -> dict[str, tuple[str, np.ndarray]]:
    """Coefficients (n, K) as whole numbers, each with its own scale, and what else is of each performance."""
    found = {}
    for name, values in raw.items():
        scale = np.maximum(np.abs(values).max(axis=0, initial=0.0), 1e-30) / 32767
        found[name] = ("i2", np.rint(values / scale).T)
        found[f"{name}_scale"] = ("f4", scale)
    for name in ("duration_s", "body_scale"):
        found[name] = ("f4", np.concatenate([getattr(block, name) for block in drawn.blocks]))
    return {**found, "dwell_s": ("f4", np.asarray(model.dwell_s(scores)).T)}


def _frame(reference: np.ndarray) -> np.ndarray:
    """(B, 3, 3) the reference direction of each bone and two axes of its tangent plane (``emulator.sphere.basis``)."""
    helper = np.zeros_like(reference)
    np.put_along_axis(helper, np.abs(reference).argmin(-1)[..., None], 1.0, axis=-1)
    first = np.cross(reference, helper)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    return np.stack([reference, first, np.cross(reference, first)], axis=1)
