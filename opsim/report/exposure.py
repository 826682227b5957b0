"""What bodies went through, from the figures of the summary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.exposure_bars import legend, level_bars, said
from opsim.report.exposure_rows import REGION, Bar, bars_by, bars_of_regions, bars_of_workers
from opsim.report.exposure_sentences import exposure_sentences
from opsim.report.exposure_words import REGIONS
from opsim.report.section import Block, Chart, Legend, Panels, Words

Row = Mapping[str, Any]
MOST = 30
"""Workers shown: those with most, where there are more."""
TITLES = {
    "exposure_workers": "By worker, in an hour in which he is there, breaks included",
    "exposure_by_hour": "By the hour of the day, in an hour of who is there, breaks included",
    "exposure_by_task": "By task, in an hour of all workers' time",
    "exposure_by_station": "By station, in an hour of all workers' time",
    "exposure_by_region": "By what the score comes from, in an hour of all workers' time",
}


def exposure_blocks(rows: Sequence[Row], confidence: float) -> list[Block]:
    """Sentences and small charts of exposure; none where no RULA was asked for.

    rows : of the summary; each figure appears only where it tells of more than one
    """
    sentences = exposure_sentences(rows)
    if not sentences:
        return []
    bars = _bars(rows)
    panels = [_chart(name, of) for name, of in bars.items() if _tells(name, of)]
    note = (
        f"Minutes of an hour, means over the replications; the black line is the {100 * confidence:.0f} % interval of "
        "the minutes at RULA 5 or more."
    )
    key = Legend(legend([bar for of in bars.values() for bar in of]))
    return [*map(Words, sentences), key, Panels(panels), Words(note, muted=True)]


def has_regions(rows: Sequence[Row]) -> bool:
    """Whether the figures say from which regions of the body high scores come."""
    return bool(bars_of_regions(rows)) and bool(exposure_sentences(rows))


def _bars(rows: Sequence[Row]) -> dict[str, list[Bar]]:
    named = [
        Bar(
            REGIONS.get(bar.subject, bar.subject).removeprefix("the "), bar.seven, bar.five, bar.most, bar.low, bar.high
        )
        for bar in bars_of_regions(rows)
    ]
    by = {kpi: bars_by(rows, kpi) for kpi in ("exposure_by_hour", "exposure_by_task", "exposure_by_station")}
    by["exposure_by_task"].sort(key=lambda bar: -bar.most)
    return {"exposure_workers": _most_exposed(bars_of_workers(rows)), **by, REGION: named}


def _most_exposed(workers: list[Bar]) -> list[Bar]:
    """In their order; of more than ``MOST`` those with most."""
    least = sorted((bar.most for bar in workers), reverse=True)[MOST - 1] if len(workers) > MOST else 0.0
    return [bar for bar in workers if bar.most >= least][:MOST]


def _tells(name: str, bars: Sequence[Bar]) -> bool:
    return bool(bars) and (name == "exposure_workers" or len(bars) > 1)


def _chart(name: str, bars: Sequence[Bar]) -> Chart:
    return Chart(name, level_bars(bars, upright=name == "exposure_by_hour"), said(bars), TITLES[name])
