"""How far people come on the floor: a first picture that shows all of it leaves nobody out."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.viewer.played import FAR_M
from opsim.viewer.scene import Performed, Segments, Ways
from opsim.viewer.skeletons import path_of

LOOKED_AT, SHARES = 4, np.linspace(0.0, 1.0, 9)
"""How many performances stand for all of a model, and when in them they are looked at."""

Box = tuple[float, float, float, float]
"""West, south, east and north end, in metres."""


def reach_m(segments: Segments, ways: Ways, performed: Performed, there: np.ndarray) -> Box | None:
    """The box round all ways, and round all places of those who are ``there`` (R,), a task's own walks included."""
    stays = there & (segments.way < 0)
    x, y = (np.concatenate(pair) for pair in ((segments.x_m[stays], ways.x_m), (segments.y_m[stays], ways.y_m)))
    doing = np.flatnonzero(stays & (segments.performance >= 0))
    model = performed.model[segments.performance[doing]]
    for number in np.unique(model).tolist():
        own = _own_m(performed.drawn[number].blocks[0])
        if np.abs(own).max() > FAR_M:
            rows = doing[model == number]
            c, s = np.cos(segments.yaw_rad[rows])[:, None], np.sin(segments.yaw_rad[rows])[:, None]
            x = np.r_[x, (segments.x_m[rows, None] + c * own[:, 0] - s * own[:, 1]).ravel()]
            y = np.r_[y, (segments.y_m[rows, None] + s * own[:, 0] + c * own[:, 1]).ravel()]
    if not x.size:
        return None
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _own_m(block: Any) -> np.ndarray:
    """(points, 2) where roots of a few performances of a model are, in their own frame."""
    some = block[np.arange(min(len(block.duration_s), LOOKED_AT))]
    path = np.asarray(path_of(some, np.asarray(some.duration_s)[:, None] * SHARES))
    return path[..., :2].reshape(-1, 2)
