"""What ``opsim motion fit --family`` shows: how many recordings had a hand at each height, at each mark."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

BAND_M, WIDEST = 0.1, 30
"""A line for each 10 cm; the longest bar has so many signs."""


def reaches(model: Any) -> Iterator[tuple[str, list[Any]]]:
    """Each mark, and where the hands and each wrist were at it; nothing of bodies without wrists."""
    from emulator.model.targets import HANDS, WRISTS

    if set(WRISTS) <= set(model.skeleton.names):
        for mark in model.mark_names:
            yield mark, [model.reach(joint, mark) for joint in (HANDS, *WRISTS)]


def print_heights(model: Any) -> None:
    """A picture for each mark, highest height first, and a sentence for each gap."""
    import click

    from opsim.cli.app import print_table

    for mark, known in reaches(model):
        columns = ("height, m", *(reach.joint for reach in known))
        print_table(f"{model.task}: recordings by height at {mark}", columns, _rows(known), words=len(columns))
        for reach in known:
            for sentence in reach.gap_sentences():
                click.echo(f"{reach.joint} at {mark}: {sentence}")


def heights_plain(model: Any) -> dict[str, Any]:
    """By mark and joint: recorded heights from below, and gaps (low, high), in metres."""
    return {
        mark: {
            reach.joint: {"recorded_m": np.sort(reach.places_m[:, 2]).tolist(), "gaps_m": reach.gaps_m}
            for reach in known
        }
        for mark, known in reaches(model)
    }


def _rows(known: list[Any]) -> list[tuple[str, ...]]:
    """A row a band of heights, from the highest: a bar and a number for each joint."""
    bands = [np.floor(reach.places_m[:, 2] / BAND_M + 1e-9).astype(int) for reach in known]
    low, high = min(int(band.min()) for band in bands), max(int(band.max()) for band in bands)
    most = max(int(np.bincount(band - low).max()) for band in bands)
    counts = [np.bincount(band - low, minlength=high - low + 1).tolist() for band in bands]
    return [
        (f"{at * BAND_M:.1f} to {(at + 1) * BAND_M:.1f}", *(_bar(count[at - low], most) for count in counts))
        for at in range(high, low - 1, -1)
    ]


def _bar(n: int, most: int) -> str:
    return f"{'#' * max(1, round(n / most * min(WIDEST, most)))} {n}" if n else ""
