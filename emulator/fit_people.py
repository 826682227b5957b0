"""What the bodies of the recorded people say of how they move: the covariates' part of a fit."""

from __future__ import annotations

import numpy as np

from emulator.covariates.model import CovariateModel
from emulator.covariates.table import table_of
from emulator.fit_parts import Parts
from emulator.motion import MotionSet
from emulator.workforce import Explained

FEWEST_PEOPLE = 4
"""With fewer, one left out leaves two: any line goes through them."""


def covariate_model(parts: Parts, motions: MotionSet) -> tuple[CovariateModel, np.ndarray] | None:
    """The covariates' model of people's mean coordinates and its shifts (W, K) of them; None where nothing is known."""
    table = table_of(motions).of_people()
    if len(motions.workers) < FEWEST_PEOPLE or not (table.names or any(table.category)):
        return None
    index = motions.worker_index
    means = np.stack([parts.z[index == w].mean(axis=0) for w in range(len(motions.workers))])
    families = np.repeat(np.arange(len(parts.scale.sizes)), parts.scale.sizes)
    model = CovariateModel.fit(means, table.numeric, table.names, table.category, families=families)
    at = [table.names.index(name) for name in model.names]
    return model, model.shifts(table.numeric[:, at], table.category)


def explained(parts: Parts, motions: MotionSet) -> Explained | None:
    """The same, None where the covariates say nothing."""
    found = covariate_model(parts, motions)
    return None if found is None or not found[0].explained.any() else Explained(*found)


def said(parts: Parts, motions: MotionSet) -> dict[str, str]:
    """How the fit report tells of it."""
    found = covariate_model(parts, motions)
    return {} if found is None else {"covariates": "; ".join(found[0].lines)}
