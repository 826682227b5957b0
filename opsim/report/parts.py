"""Parts of figures: in words, and those that are left out of tables because there was nothing of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from opsim.report import exposure_words, strain_words

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


def part_name(kpi: str, part: str) -> str:
    """A part in words; as it is written where there are none."""
    return WORDS.get(kpi, {}).get(part, part)


def is_shown(kpi: str, part: str, rows: Iterable[Mapping[str, Any]]) -> bool:
    """Whether a part is shown; rows : of the summary, one a variant. No part of these figures is below 0."""
    return kpi not in SHOWN_WHERE_ANY or not part or any((row["mean"] or 0) > 0 for row in rows)
