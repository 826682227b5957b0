"""Parts of figures: in words, and those that tables leave out because there was nothing of them, or nothing new."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from opsim.report import exposure_words, strain_words

Row = Mapping[str, Any]
AT_MOST = "at_most"
WORDS = {
    "interruptions_per_h": {
        "resumed": "gone on with by the same one",
        "by_another": "gone on with by another",
        "handed_over": "handed over at once",
        "restarted": "begun anew",
        "open": "not gone on with",
    },
    "line_stopped_share": {
        "unfinished": "a job was not done",
        "full": "no room behind it",
        "down": "a station was down",
        "closed": "closed: a pause, not counted",
        "away": "nobody there: a pause, not counted",
    },
    **exposure_words.PARTS,
    **strain_words.PARTS,
    "fatigue_most": {
        **{f"{side}_{joint}": f"{side} {joint}" for joint in ("shoulder", "elbow") for side in ("left", "right")},
        **{"back": "low back", "hips": "hips", "knees": "knees"},
    },
}
SHOWN_WHERE_ANY = tuple(WORDS)
"""Figures of which only the total, and the parts that are there at all, are shown."""

BY_PART = (
    *("exposure_gini", "static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "en_1005_4_min_per_h"),
    *("movements_per_min", "rest_allowance_share"),
)
"""Those of them that have parts alone: nothing but their parts can say that there was nothing, and 0 is an answer."""


def part_name(kpi: str, part: str) -> str:
    """A part in words; as it is written where there are none."""
    return WORDS.get(kpi, {}).get(part, part)


def is_shown(kpi: str, part: str, rows: Iterable[Row]) -> bool:
    """Whether a part is shown; rows : of the summary, one a variant. No part of these figures is below 0."""
    if kpi in BY_PART:
        return any(row["mean"] is not None for row in rows)
    return kpi not in SHOWN_WHERE_ANY or not part or any((row["mean"] or 0) > 0 for row in rows)


def says_again(part: str, rows: Sequence[Row], beside: Mapping[str, Sequence[Row]]) -> bool:
    """Whether a part is how much there may be at most of another one, and no other in any variant.

    rows : of the part, one a variant; beside : those of all parts of the same subject
    """
    if not part.endswith(AT_MOST):
        return False
    least = beside.get(part.removesuffix(AT_MOST).removesuffix("_"))
    return least is not None and [_said(row) for row in least] == [_said(row) for row in rows]


def without_again(rows: Sequence[Row]) -> list[Row]:
    """The rows of one variant but those that ``says_again`` finds."""
    found: dict[tuple[str, str], dict[str, Sequence[Row]]] = {}
    for row in rows:
        found.setdefault((row["kpi"], row["subject"]), {})[row.get("part", "")] = [row]
    return [row for row in rows if not says_again(row.get("part", ""), [row], found[row["kpi"], row["subject"]])]


def _said(row: Row) -> tuple[Any, ...]:
    return tuple(row.get(key) for key in ("mean", "low", "high", "n"))
