"""The neutral of necks: how far forward of the trunk the head of somebody stands who looks ahead.

Heads stand 10 to 25 degrees forward of the trunk, depending on where the markers are. Nobody recorded that posture for
its own sake, so it is taken from how performances begin: the median over those that begin upright. Where somebody
begins with the head turned down to the work, or holds a bar overhead, the median of one task is off by that; so tasks
of the same recordings share the median of theirs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.measures import first_measures, has_body
from opsim.one_thread import one_blas_thread
from opsim.streams import BLOCK, stream

UPRIGHT_DEG = 15.0
"""A trunk within this of upright, forward and to the side, stands."""
WALKS = 8
"""They are drawn step by step, a hundred times as slowly as other work, and all begin in one posture."""
ENOUGH = 0.5
"""Of the performances this share must begin upright, else they do not tell."""


def neck_neutral_rad(performances: Any) -> float:
    """The neutral of a task model, or of a block of performances, in radians; 0 where it cannot be told.

    Of a model 64 performances of anybody are drawn (8 walks), always the same: stream ``neutral`` of seed 0.
    """
    told = neck_neutral_told_rad(performances)
    return 0.0 if told is None else told


def neck_neutral_told_rad(performances: Any) -> float | None:
    """The same, None where it cannot be told."""
    with one_blas_thread():
        return _told_rad(_drawn(performances))


def neck_neutrals_rad(models: Mapping[str, Any]) -> dict[str, float]:
    """The neutral of each task by its name, in radians: the median over the tasks of the same recordings and skeleton.

    A task that cannot tell takes that of the others; where none can it is 0. Times without a body have 0.
    """
    with one_blas_thread():
        drawn = {task: _drawn(model) for task, model in models.items()}
        told = {task: _told_rad(block) for task, block in drawn.items()}
    kin = {task: _kin(model, drawn[task]) for task, model in models.items()}
    return {task: _median([told[other] for other in models if kin[other] == kin[task]]) for task in models}


def _drawn(performances: Any) -> Any:
    """A block of a model; a block is one already."""
    if not hasattr(performances, "sample"):
        return performances
    n = WALKS if getattr(performances, "walks", False) else BLOCK
    return performances.sample(n, stream(0, 0, "neutral", 0))


def neutral_told_rad(first: np.ndarray) -> float | None:
    """From measures (n, COLUMNS) of postures in which performances begin, necks against the trunk; None: not told."""
    lean = np.maximum(np.abs(first[:, AT["trunk_flexion"]]), np.abs(first[:, AT["trunk_side"]]))
    neck = first[lean <= UPRIGHT_DEG, AT["neck_flexion"]]
    neck = neck[np.isfinite(neck)]
    return float(np.deg2rad(np.median(neck))) if neck.size and neck.size >= ENOUGH * len(first) else None


def _told_rad(block: Any) -> float | None:
    return neutral_told_rad(first_measures(block)) if has_body(block) else None


def _median(told_rad: list[float | None]) -> float:
    found = [angle for angle in told_rad if angle is not None]
    return float(np.median(found)) if found else 0.0


def _kin(model: Any, block: Any) -> tuple[Any, ...]:
    """Tasks of which this is the same have heads with the same markers."""
    if not has_body(block):
        return ("no body",)
    return tuple(block.skeleton.names), str(getattr(getattr(model, "report", None), "source", ""))
