"""What bodies went through: the section of the report, from the figures of the summary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.exposure_bars import legend, level_bars, said
from opsim.report.exposure_rows import REGION, Bar, bars_by, bars_of_regions, bars_of_workers
from opsim.report.exposure_sentences import exposure_sentences
from opsim.report.exposure_words import REGIONS

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


def exposure_section(rows: Sequence[Row], drawn: dict[str, Any]) -> dict[str, Any] | None:
    """What the page says of exposure, its figures added to ``drawn``; None where no RULA was asked for.

    rows : of the summary; each figure appears only where it tells of more than one
    """
    sentences = exposure_sentences(rows)
    if not sentences:
        return None
    shown = [_figure(name, bars, drawn) for name, bars in _bars(rows).items() if _tells(name, bars)]
    everything = [bar for bars in _bars(rows).values() for bar in bars]
    return {
        "sentences": sentences,
        "figures": shown,
        "legend": legend(everything),
        "regions": bool(_bars(rows)[REGION]),
    }


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


def _figure(name: str, bars: Sequence[Bar], drawn: dict[str, Any]) -> dict[str, str]:
    drawn[name] = level_bars(bars, upright=name == "exposure_by_hour")
    return {"id": name, "title": TITLES[name], "words": said(bars)}
