"""What ``opsim motion judge`` found on held-out repetitions: as a table with the meaning of its columns, and as CSV."""

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

    from opsim.cli.console import print_table, printable

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
        from opsim.cli.judged_real_time import meaning

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
