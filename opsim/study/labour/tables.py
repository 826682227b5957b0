"""Answers as tables of workforces x replications, and which figures are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.kpi.better import read_asked
from opsim.kpi.names import EXPOSURE, POSTURE
from opsim.results import Key
from opsim.scenario.read import Loaded
from opsim.study.jobs import Answers, Job, Point
from opsim.study.labour.day_asked import day_asked
from opsim.study.labour.points import jobs_of

THROUGHPUT: Key = ("throughput_per_h", "", "", "1/h")
ALWAYS = (THROUGHPUT[0], "work_in_progress")
BY_THEMSELVES = {*POSTURE, *EXPOSURE, "fatigue_mean", "fatigue_most", "rest_taken_min_per_h"} - {
    "posture_measured_share"
}
"""Outputs that are figures of the budget where nobody names any: of all people, and of the one with most."""
NO_PARTS = ("", "worst")
MOST_FIGURES = 6
"""As many as a table of a page has room for."""


class Tables:
    """(W, R) tables of figures of points."""

    def __init__(self, answers: Answers, block: Any):
        self._answers, self._shape = answers, (block.workforces, block.replications)
        self._design = block.design

    def ask(self, points: Sequence[Point]) -> None:
        """Have all jobs of some points computed, in one go."""
        self._answers.ensure([job for point in points for job in self.jobs(point)])

    def jobs(self, point: Point) -> list[Job]:
        """Of a point, one workforce after the other."""
        return jobs_of(point, *self._shape, self._design)

    def of(self, point: Point, key: Key) -> np.ndarray:
        """(W, R) of one figure; nan where it was not observed."""
        return self._answers.values(self.jobs(point), [key]).reshape(self._shape)

    def keys(self, point: Point) -> list[Key]:
        """Of the figures that a point has."""
        return self._answers.keys(self.jobs(point))


def kept_figures(block: Any, loaded: Loaded) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    asked = block.figures or [name for name in loaded.scenario.outputs or () if name in BY_THEMSELVES]
    names = [*ALWAYS, *(read_asked(name).kpi for name in asked), day_asked(block.target, None).kpi]
    return tuple(dict.fromkeys(names))


def figures_of(block: Any, loaded: Loaded, known: Sequence[Key]) -> tuple[list[Key], list[str]]:
    """(keys of the figures that are split and budgeted, what is left out in words).

    Throughput, jobs inside, then what was asked for; else what the outputs say of bodies. Raises ValueError for a
    figure that these runs have not.
    """
    always = [key for name in ALWAYS for key in known if key[:3] == (name, "", "")]
    if block.figures:
        asked = [key for name in block.figures for key in _named(name, known)]
    else:
        outputs = BY_THEMSELVES.intersection(loaded.scenario.outputs or ())
        asked = [key for key in known if key[0] in outputs and not key[1] and key[2] in NO_PARTS]
    found = list(dict.fromkeys([*always, *asked]))
    left = ["/".join(key[:3]).rstrip("/") for key in found[MOST_FIGURES:]]
    words = [f"not told: {', '.join(left)}; name the figures that are wanted under 'figures'"] if left else []
    return found[:MOST_FIGURES], words


def _named(name: str, known: Sequence[Key]) -> list[Key]:
    one = read_asked(name)
    of = [key for key in known if key[:2] == (one.kpi, one.subject)]
    found = [key for key in of if (key[2] == one.part if one.part else key[2] in NO_PARTS)]
    if not found:
        there = sorted({"/".join(key[:3]).rstrip("/") for key in known if key[0] == one.kpi})
        hint = f"there are {', '.join(there[:8])}" if there else "these runs have none of it"
        raise ValueError(f"figures: no {one.name!r}; {hint}")
    return found
