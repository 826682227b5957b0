"""Limits of lifting, holding, reaching and rest that people are beyond, as the figures that were asked for tell it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.words import is_number

MOST = 4
"""Of each kind: lifting, holding, rest."""


def limit_sentences(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sentences of lifting indices, holds and angles beyond standards, and rest, by the means over replications.

    rows : of the summary; at most ``MOST`` sentences of each kind, and how many more there would be
    """
    from opsim.kpi import energy, holds, lifting

    figures = {(row["kpi"], row["subject"], row["part"]): float(row["mean"]) for row in rows if is_number(row["mean"])}
    kinds = [list(kind.sentences(figures)) for kind in (lifting, holds, energy)]
    left = sum(max(0, len(said) - MOST) for said in kinds)
    more = [f"And {left} more: see the table of figures."] if left else []
    return [*(text for said in kinds for text in said[:MOST]), *more]
