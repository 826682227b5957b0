"""The error of a fit itself, beside the luck of its replications: where levels are read from a fit, not run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from opsim.study.sweep.response import Response


@dataclass(frozen=True, slots=True)
class BesideFit:
    """Standard errors that the misfit gives levels of a factor, with ``degrees`` of freedom.

    rows : by level, (C,) what multiplies the coefficients there; reference : the same where changes are against
    """

    response: Response
    rows: Mapping[str, np.ndarray]
    reference: np.ndarray

    @property
    def degrees(self) -> int:
        """Points beyond the terms, from which the misfit is known."""
        return self.response.spare

    def of(self, level: str) -> float:
        """Of the mean at a level."""
        return self.response.misfit_of(self.rows[level], 1)

    def against_reference(self, level: str) -> float:
        """Of a level's change; nothing where it is the reference."""
        return self._of_difference(self.rows[level] - self.reference)

    def between(self, one: str, other: str) -> float:
        """Of the difference of two levels."""
        return self._of_difference(self.rows[one] - self.rows[other])

    def _of_difference(self, row: np.ndarray) -> float:
        return self.response.misfit_of(row, 2) if row.any() else 0.0
