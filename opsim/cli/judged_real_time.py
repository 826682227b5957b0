"""What ``opsim motion judge`` found in real time: a table on the terminal, and the rows of the page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

COLUMNS = {
    "too_fast": ("too fast %", 100, "{:.0f}", "movements with a joint faster than 1.1 x the fastest recorded"),
    "speed_ratio": ("speed", 1, "{:.2f}", "median peak speed over that of the unseen half"),
    "jerk_ratio": ("jerk", 1, "{:.2f}", "peak jerk of a joint over that of the unseen half, medians"),
    "places_mm": ("places", 1, "{:.0f}", "energy distance of places to the unseen half, mm"),
    "speeds_mm_per_s": ("speeds", 1, "{:.0f}", "the same of joint speeds, mm/s"),
    "wander_cm": ("wander cm", 1, "{:.1f}", "how far a planted foot strays from its place, 90 % quantile"),
    "slide_cm": ("slide cm", 1, "{:.1f}", "way of a planted foot's joint over the floor in a stance"),
    "sunk_mm": ("sunk mm", 1, "{:.0f}", "depth of the deepest joint below where it stands in recordings"),
    "unsupported": ("off feet %", 100, "{:.0f}", "time with the centre of mass outside the planted feet"),
    "outside": ("angles %", 100, "{:.0f}", "frames with a joint angle beyond the recorded range"),
    "auc": ("told", 1, "{:.2f}", "how well a classifier tells them from the unseen half; .5 not at all, 1 always"),
}
"""Figure of ``emulator.judge.real_time.RealTime`` -> heading, factor, form, meaning."""
NOTHING = "-"


def in_real_time(motions: Any, schemes: Sequence[str], n_splits: int, seed: int) -> list[Any]:
    """One ``RealTimeHalves`` for each emulator among the schemes. Raises ValueError where it cannot be fitted."""
    from emulator.judge.held_out import USUAL, kind
    from emulator.judge.real_time_halves import judge_real_time
    from opsim.cli.progress import progress

    names = [name for name in dict.fromkeys(schemes or USUAL) if kind(name) == "emulator"]
    with progress("real time") as report:
        return [judge_real_time(motions, name, n_splits, seed, report) for name in names]


def print_real_time(found: Sequence[Any]) -> None:
    """The table, and in a sentence each what the emulator is good for and what not."""
    import click

    from opsim.cli.console import print_table, printable

    if not found:
        return
    print_table(f"{found[0].task}: movements in real time, against the unseen half", heads(), rows(found))
    for one in found:
        prefix = f"{one.scheme}: " if len(found) > 1 else ""
        for words in (one.sentence, one.of_new_people, *one.drawn.notes):
            if words:
                click.echo(printable(f"{prefix}{words}"))


def heads() -> tuple[str, ...]:
    """The headings, the first empty."""
    return ("", *(heading for heading, *_ in COLUMNS.values()))


def rows(found: Sequence[Any]) -> list[list[str]]:
    """The recordings of the fitted half, and each emulator."""
    first = [["recordings: fitted half", *_cells(found[0].recorded)]]
    return first + [[one.scheme, *_cells(one.drawn)] for one in found]


def meaning() -> dict[str, str]:
    """Heading -> what it says."""
    return {heading: words for heading, _, _, words in COLUMNS.values()}


def write_page(path: Path, found: Sequence[Sequence[Any]], seed: int) -> None:
    """The page of all tasks judged so far."""
    from emulator.judge.real_time_halves import foot_paths_m, profiles
    from opsim.report.real_time import Movements, Task, write_real_time

    def movements(clips: Any) -> Any:
        rates = {order: profiles(clips, order) for order in (1, 3)}
        return Movements(clips.positions_m, clips.duration_s, rates, foot_paths_m(clips))

    tasks = [
        Task(
            one.task,
            one.scheme,
            [words for words in (one.sentence, one.of_new_people, *one.drawn.notes) if words],
            (heads(), rows([one])),
            one.held.skeleton,
            movements(one.held),
            movements(one.draws),
        )
        for of_task in found
        for one in of_task
    ]
    write_real_time(path, tasks, meaning(), seed)


def _cells(figures: Any) -> list[str]:
    values = {name: getattr(figures, name) for name in COLUMNS}
    return [
        NOTHING if math.isnan(values[name]) else form.format(factor * values[name])
        for name, (_, factor, form, _) in COLUMNS.items()
    ]
