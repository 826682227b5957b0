"""What each factor does by a fitted response, with the fit's own error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.study.sweep.beside_fit import BesideFit
from opsim.study.sweep.effects import Swing, ranked, swing
from opsim.study.sweep.factors import Factor
from opsim.study.sweep.response import Response
from opsim.study.sweep.terms import columns


def effects_by_fit(factors: Sequence[Factor], response: Response) -> list[Swing]:
    """Each factor at its ends and in its middle, the others in theirs; of categories, each against the mean of all.

    Intervals hold the luck of the replications and the misfit; nothing is clear by a fit that is not to be trusted.
    """
    each = response.per_replication if response.per_replication.size else response.coefficients[:, None]
    centre = columns(response.terms, _plain_centre(response), response.room)[0]
    found = []
    for column, factor in enumerate(factors):
        rows = {words: _row(response, column, number) for number, words in _levels(factor)}
        of = {words: row @ each for words, row in rows.items()}
        found.append(swing(factor.path, of, centre @ each, BesideFit(response, rows, centre)))
    return ranked(found, any_clear=response.trusted)


def _levels(factor: Factor) -> list[tuple[float, str]]:
    """(number, words) of the values, of a range with its middle."""
    values = list(factor.values)
    if not factor.categories and factor.is_range:
        values.insert(1, factor.at(0.5))
    return [(factor.number(value), factor.words(value)) for value in values]


def _plain_centre(response: Response) -> np.ndarray:
    """The middle of every factor; -1, which is no category, where it has no order: their mean."""
    categories = np.array(response.room.categories) > 0
    return np.where(categories, np.nan, 0.0)[None]


def _row(response: Response, column: int, number: float) -> np.ndarray:
    scaled = _plain_centre(response)
    room = response.room
    scaled[0, column] = number if room.categories[column] else (number - room.centre[column]) / room.half[column]
    return columns(response.terms, scaled, room)[0]
