"""What ``opsim motion judge`` found on held-out repetitions: as a table with the meaning of its columns, and as CSV.

What ``opsim motion judge`` found in real time: a table on the terminal, and the rows of the page.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

COLUMNS = {
    "energy": ("energy", "{:.2f}"),
    "p": ("p", "{:.3f}"),
    "novelty": ("novelty", "{:.2f}"),
    "temporal_roughness": ("rough", "{:.2f}"),
    "roughness": ("2nd diff", "{:.2f}"),
    "error": ("lost", "{:.2f}"),
    "log_likelihood": ("log lik", "{:.4g}"),
    "duration_p": ("time p", "{:.3f}"),
    "marks_p": ("marks p", "{:.3f}"),
    "outside_percent": ("limits %", "{:.1f}"),
    "top_speed_m_per_s": ("m/s", "{:.1f}"),
    "skate_cm": ("skate cm", "{:.1f}"),
}
"""Figure -> its heading and form; the CSV and the JSON hold the others, too."""
NOTHING = "-"
ABSENT = "a scheme of the paper has no durations and no bodies, ours no likelihood; controls only copy"


def print_judged(judged: Any, title: str) -> None:
    """The table, what is missing from it and why, and whether the controls were seen through."""
    import click

    from opsim.cli.app import print_table, printable

    rows = [[name, *_cells(figures)] for name, figures in judged.rows.items()]
    print_table(title, ("", *(heading for heading, _ in COLUMNS.values())), rows)
    for note in [*judged.notes, *_on_controls(judged)]:
        click.echo(printable(note))


def print_meaning(real_time: bool = False) -> None:
    """One line a column; of the table in real time, too, if one was shown."""
    import click

    from emulator.judge.held_out_table import MEANING

    click.echo()
    for name, (heading, _) in COLUMNS.items():
        click.echo(f"{heading:9} {MEANING[name]}")
    click.echo(f"{NOTHING:9} {ABSENT}")
    if real_time:
        click.echo("\nin real time")
        for heading, words in meaning().items():
            click.echo(f"{heading:10} {words}")


def wrong_table(out: Path | None) -> list[str]:
    """What speaks against this name for the table: it is neither a .csv file nor a folder."""
    if out is None or out.suffix.lower() == ".csv" or out.is_dir() or not (out.is_file() or out.suffix):
        return []
    found = "a file" if out.is_file() else f"the ending {out.suffix!r}"
    return [f"{out}: found {found}, expected a folder or a .csv file to write"]


def table_file(out: Path | None) -> Path | None:
    """The .csv file to write, or the one in this folder."""
    return out if out is None or out.suffix.lower() == ".csv" else out / "judged.csv"


def write_judged(path: Path, judged: Sequence[Any]) -> None:
    """A row for each drawer of each task over all splits, and one for each split; empty where there is no figure."""
    from emulator.judge.held_out import kind

    rows = [
        {"task": one.task, "name": name, "kind": kind(name), "split": split}
        | {figure: "" if math.isnan(value) else repr(value) for figure, value in asdict(figures).items()}
        for one in judged
        for name in one.rows
        for split, figures in _over_and_of_each(one, name)
    ]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def as_plain(judged: Any) -> dict[str, Any]:
    """For JSON."""
    from emulator.judge.held_out import kind

    rows = [{"name": name, "kind": kind(name), **asdict(figures)} for name, figures in judged.rows.items()]
    passing = judged.passing_controls
    return {"n_splits": len(judged.splits), "rows": rows, "notes": list(judged.notes), "passing_controls": passing}


def _over_and_of_each(judged: Any, name: str) -> Iterator[tuple[str, Any]]:
    yield "all", judged.rows[name]
    for number, split in enumerate(judged.splits):
        yield str(number), split[name]


def _cells(figures: Any) -> list[str]:
    values = asdict(figures)
    return [NOTHING if math.isnan(values[n]) else form.format(values[n]) for n, (_, form) in COLUMNS.items()]


def _on_controls(judged: Any) -> list[str]:
    from emulator.judge.held_out_table import HONEST

    passing = judged.passing_controls
    if passing:
        found = ", ".join(f"{name} ({judged.rows[name].novelty:.2f})" for name in passing)
        return [f"WARNING: novelty does not see through {found}: on these recordings it says nothing"]
    return [f"both controls fail novelty (below {HONEST:g}), as copiers must"]


REAL_TIME_COLUMNS = {
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

    from opsim.cli.app import print_table, printable

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
    return ("", *(heading for heading, *_ in REAL_TIME_COLUMNS.values()))


def rows(found: Sequence[Any]) -> list[list[str]]:
    """The recordings of the fitted half, and each emulator."""
    first = [["recordings: fitted half", *_real_time_cells(found[0].recorded)]]
    return first + [[one.scheme, *_real_time_cells(one.drawn)] for one in found]


def meaning() -> dict[str, str]:
    """Heading -> what it says."""
    return {heading: words for heading, _, _, words in REAL_TIME_COLUMNS.values()}


def write_page(path: Path, found: Sequence[Sequence[Any]], seed: int) -> None:
    """The page of all tasks judged so far."""
    from emulator.judge.real_time_halves import foot_paths_m, profiles
    from opsim.report.motion.real_time import Movements, Task, write_real_time

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


def _real_time_cells(figures: Any) -> list[str]:
    values = {name: getattr(figures, name) for name in REAL_TIME_COLUMNS}
    return [
        NOTHING if math.isnan(values[name]) else form.format(factor * values[name])
        for name, (_, factor, form, _) in REAL_TIME_COLUMNS.items()
    ]
