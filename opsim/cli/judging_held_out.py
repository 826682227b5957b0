"""``opsim motion judge`` on held-out repetitions: table after table, each kept as soon as it is found."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import Mistake, mistakes


def show_held_out(
    sets: Sequence[Any],
    schemes: Sequence[str],
    n_splits: int,
    seed: int,
    target: Path | None,
    as_json: bool,
    page: Path | None = None,
) -> None:
    """Print the tables, and write them into ``target``; what was found before a stop or a failure is told all the same.

    Raises Mistake with every file that cannot be judged, Interrupted after Ctrl-C.
    """
    from opsim.cli.stopping import held, stopped

    judged: list[Any] = []
    timed: list[Any] = []
    failed: list[str] = []
    try:
        for motions in sets:
            _judge(motions, schemes, n_splits, seed, judged, failed, target, as_json)
            _judge_in_real_time(motions, schemes, n_splits, seed, timed, failed, page, as_json)
    except KeyboardInterrupt as stop:
        _end(judged, timed, target, as_json, page)
        done = [one.task for one in judged]
        kept = "" if target is None and done else held(target or Path(), done, [motions.task for motions in sets])
        raise stopped(stop, kept or f"judged: {', '.join(done)}") from None
    _end(judged, timed, target, as_json, page)
    if failed:
        raise Mistake("\n".join(failed))


def _judge(
    motions: Any,
    schemes: Sequence[str],
    n_splits: int,
    seed: int,
    judged: list[Any],
    failed: list[str],
    target: Path | None,
    as_json: bool,
) -> None:
    """One file, added to ``judged`` or to ``failed``: it takes nothing from the others."""
    from opsim.cli.judged_table import print_judged, write_judged

    try:
        with mistakes():
            judged.append(_held_out(motions, schemes, n_splits, seed))
            if not as_json:
                print_judged(judged[-1], f"{_who(motions)}, halves dealt out {_times(n_splits)}")
            if target is not None:
                write_judged(target, judged)
    except Mistake as mistake:
        failed.append(f"{motions.task}: {mistake.message.removeprefix(f'{motions.task}: ')}")


def _judge_in_real_time(
    motions: Any,
    schemes: Sequence[str],
    n_splits: int,
    seed: int,
    timed: list[Any],
    failed: list[str],
    page: Path | None,
    as_json: bool,
) -> None:
    """Emulators of one file in their own seconds, added to ``timed``; a file that failed before is not asked again."""
    from opsim.cli.judged_real_time import in_real_time, print_real_time, write_page

    if any(words.startswith(f"{motions.task}: ") for words in failed):
        return
    try:
        with mistakes():
            timed.append(in_real_time(motions, schemes, n_splits, seed))
            if not as_json:
                print_real_time(timed[-1])
            if page is not None:
                write_page(page, timed, seed)
    except Mistake as mistake:
        failed.append(f"{motions.task}: in real time: {mistake.message.removeprefix(f'{motions.task}: ')}")


def _end(
    judged: Sequence[Any], timed: Sequence[Sequence[Any]], target: Path | None, as_json: bool, page: Path | None
) -> None:
    from opsim.cli.console import print_json
    from opsim.cli.judged_table import as_plain, print_meaning

    if as_json:
        real_time = {of_task[0].task: [one.as_plain() for one in of_task] for of_task in timed if of_task}
        tasks = {j.task: as_plain(j) | {"real_time": real_time.get(j.task, [])} for j in judged}
        written = {name: None if path is None else str(path) for name, path in (("out", target), ("page", page))}
        print_json({**written, "tasks": tasks})
    elif judged:
        print_meaning(real_time=any(timed))
        if page is not None:
            click.echo(f"page: {page}")
        if target is not None:
            click.echo(f"table: {target}")


def _held_out(motions: Any, schemes: Sequence[str], n_splits: int, seed: int) -> Any:
    from emulator.judge.held_out_table import USUAL, judge_held_out
    from opsim.cli.progress import progress

    with progress("judge") as report:
        return judge_held_out(motions, schemes or USUAL, n_splits, seed, report)


def _times(n: int) -> str:
    return "once" if n == 1 else f"{n} times"


def _who(motions: Any) -> str:
    n_people = len(motions.workers)
    people = "one person" if n_people == 1 else f"{n_people} people"
    return f"{motions.task}: {len(motions)} repetitions of {people} ({motions.selection})"
