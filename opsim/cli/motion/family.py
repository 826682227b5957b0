"""``opsim motion fit --family``: what speaks against it, and what it shows: recordings by height of the hands at marks.

Columns of recordings that are asked for by name.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

BAND_M, WIDEST = 0.1, 30
"""A line for each 10 cm; the longest bar has so many signs."""


def no_name(word: str) -> bool:
    """Whether a word cannot be the name of a task."""
    return not word.strip() or not word.isprintable() or "/" in word


def wrong_family(family: str | None, files: Sequence[str], task: str | None, cyclic: bool) -> list[str]:
    """What speaks against fitting all files as one task of this name."""
    if family is None:
        return []
    wrong = [] if len(files) > 1 else ["--family: found one file, expected two or more"]
    wrong += [] if task is None else ["--task: found together with --family, expected one of them: both name the task"]
    wrong += ["--cyclic: found together with --family, expected one of them: cycles have no marks"] if cyclic else []
    if no_name(family):
        wrong.append(f"--family: found {family!r}, expected a name without '/'")
    return wrong


def pooled(name: str, files: Sequence[str], sets: Sequence[Any], wrong: Sequence[str]) -> tuple[list[str], list[Any]]:
    """What is wrong, in the files' names, and all sets as one."""
    from emulator.recordings.family import family

    try:
        return [*wrong], [family(name, sets)]
    except ValueError as error:
        file_of = {f"{motions.task}": file for motions, file in zip(sets, files)}
        lines = [line.partition(": ") for line in str(error).splitlines()]
        return [*wrong, *(f"{file_of.get(place, place)}: {said}" for place, _, said in lines)], []


def wrong_covariates(file: str, motions: Any, asked: Sequence[str]) -> list[str]:
    """Columns asked for that are not there or can tell nothing."""
    from emulator.covariates.table import asked_table

    if asked:
        try:
            asked_table(motions, asked)
        except ValueError as error:
            return [f"{file}: {line.removeprefix(f'{motions.task}: ')}" for line in str(error).splitlines()]
    return []


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
