"""All that ``opsim motion judge --paper`` makes, section by section; between them the names of the steps.

``opsim motion judge`` on held-out repetitions: table after table, each kept as soon as it is found.

``opsim motion judge``: schemes judged on held-out repetitions, or as Chen, Park & Srivastava judged theirs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import Mistake, mistakes

N_STEPS = 5
"""Steps of one class; one more for each body."""


def judged(sets: Sequence[Any], out: Path, seed: int) -> tuple[Path, dict[str, Any]]:
    """Write the tables, figures and the page into ``out``; the page, and the rows of each class.

    Classes are written as they are finished: a stop (Interrupted) or a failure (Mistake) names those that are there.
    """
    from opsim.cli.app import held, stopped, stops_once
    from opsim.cli.progress import progress

    made: list[Any] = []
    try:
        with stops_once(), mistakes(), progress("judge") as report:
            for section in _reported(sets, seed, report):
                made.append(section)
                _write(sets, made, out)
    except KeyboardInterrupt as stop:
        raise stopped(stop, held(out, [s.name for s in made], [m.task for m in sets])) from None
    except Mistake as mistake:
        kept = [held(out, [s.name for s in made], [m.task for m in sets])] if made else []
        raise Mistake("\n".join([mistake.message, *kept])) from None
    rows = {s.name: {f"table {t.number}": [list(row) for row in t.rows] for t in s.tables} for s in made}
    return out / "index.html", rows


def _write(sets: Sequence[Any], made: Sequence[Any], out: Path) -> None:
    from opsim.report.motion.emulator_paper import write_paper

    there = [m for m in sets if m.task in {section.name for section in made}]
    words = [f"{m.task}: {len(m)} repetitions of {len(m.workers)} people, {m.selection}; {m.source}" for m in there]
    write_paper(out, "Schemes of human motion, judged", words, made)


def _reported(sets: Sequence[Any], seed: int, report: Callable[..., None]) -> Iterator[Any]:
    """Sections as they come; each step is told by its name as it begins, after so many that are done."""
    total, done = N_STEPS * len(sets) + len({motions.skeleton for motions in sets}), 0
    for item in sections(sets, seed):
        if isinstance(item, str):
            report(done, total, item)
            done += 1
        else:
            yield item
    report(total, total, "done")


def sections(sets: Sequence[Any], seed: int) -> Iterator[Any]:
    """Sections as they are made, and before each step its name."""
    from emulator.judge.paper import prepared, quantized

    classes = []
    for motions in sets:
        yield f"{motions.task}: fitting"
        classes.append(prepared(motions, seed))
    postures = {}
    for body in dict.fromkeys(c.motions.skeleton for c in classes):
        yield "canonical postures"
        postures[body] = quantized([c for c in classes if c.motions.skeleton == body], seed)
    for c in classes:
        yield from _of_class(c, postures[c.motions.skeleton])


def _of_class(c: Any, postures: Any) -> Iterator[Any]:
    from emulator.judge.paper import draws_of, level_two, table_1, table_2, table_3, tables_4_and_5
    from opsim.report.motion.emulator_paper import Section, figure_19

    yield f"{c.task}: flattening and reduction"
    emulator_paper = list(_flattened(c))
    yield f"{c.task}: sub-sequences"
    tables = [table_1(c), table_2(c)]
    emulator_paper += _drawn(c, draws_of(c))
    yield f"{c.task}: two levels"
    rows = level_two(c)
    tables.append(table_3(rows))
    emulator_paper.append(figure_19(rows))
    yield f"{c.task}: quantization"
    tables += tables_4_and_5(c, postures)
    people = f"{len(c.motions)} repetitions of {len(c.motions.workers)} people on {c.aligned.shape[1]} points"
    yield Section(c.task, f"{people}; {postures.n_postures} canonical postures", tuple(tables), tuple(emulator_paper))


def _flattened(c: Any) -> Iterator[Any]:
    from emulator.judge import paper as found
    from opsim.report.motion import emulator_paper

    yield emulator_paper.figure_4(found.fields(c))
    yield emulator_paper.figure_5(found.round_trip_errors(c))
    yield emulator_paper.figure_7(found.spatial_shares(c))
    yield emulator_paper.figure_8(*found.first_score(c))
    yield emulator_paper.figure_9(found.errors_by_size(c))
    yield emulator_paper.figure_10(found.first_coefficients(c))
    yield emulator_paper.figure_13(*found.dimensions(c))


def _drawn(c: Any, draws: Any) -> Iterator[Any]:
    from emulator.judge import paper as found
    from opsim.report.motion import emulator_paper

    yield emulator_paper.figure_14(found.people(c, draws), c.motions.skeleton)
    yield emulator_paper.figure_15(found.scaled(draws))
    yield emulator_paper.figure_16(found.roughness_over_time(draws))


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
    from opsim.cli.app import held, stopped

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
    from opsim.cli.motion.judge_tables import print_judged, write_judged

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
    from opsim.cli.motion.judge_tables import in_real_time, print_real_time, write_page

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
    from opsim.cli.app import print_json
    from opsim.cli.motion.judge_tables import as_plain, print_meaning

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


FEWEST = 12
"""Repetitions below which sequences cannot be tested against one another."""
USUAL_SPLITS = 5


@click.command("judge")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option(
    "--scheme",
    "schemes",
    multiple=True,
    metavar="NAME",
    help="Which to judge; several may be given.  [default: Extrinsic/JointPCA/Smoothed and SIEM/SequentialPCA/MVG]",
)
@click.option("--paper", is_flag=True, help="Instead the paper's tables and figures, our scheme beside theirs.")
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), help="A .csv file or a folder; with --paper the folder to write."
)
@click.option(
    "--page", type=click.Path(path_type=Path), help="A page, FILE.html: recorded and drawn side by side in real time."
)
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option("--splits", type=click.IntRange(1, 100), help="How often to deal out the halves.  [default: 5]")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Decides the halves and the draws.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...],
    schemes: tuple[str, ...],
    paper: bool,
    out: Path | None,
    page: Path | None,
    where: str | None,
    splits: int | None,
    seed: int,
    as_json: bool,
) -> None:
    """Judge schemes on each recording FILE: fitted to half of everybody's repetitions, held against the other half.

    Emulators also in real time: speed, jerk, feet, balance, a classifier, and new people beside people left out.

    A name such as SIEM/JointPCA/MVG, for which there is an emulator, means the emulator; all others mean the scheme of
    the paper on aligned postures. Two controls, which copy, must be seen to fail.
    """
    from opsim.cli.motion.judge_tables import table_file

    with mistakes():
        sets = _read(files, where, paper, _misfits(schemes, paper, out, splits, page))
    target = out / "index.html" if paper and out is not None else table_file(out)
    with _written(target), _written(page):
        if paper and out is not None:
            _show_paper(sets, out, seed, as_json)
        else:
            show_held_out(sets, schemes, splits or USUAL_SPLITS, seed, target, as_json, page)


@contextmanager
def _written(target: Path | None) -> Iterator[None]:
    """The folder of this file is there, can be written, and is gone again if it stays empty."""
    from opsim.cli.motion.files import no_empty_folders, ready

    if target is None:
        yield
        return
    with no_empty_folders(target.parent):
        with mistakes():
            ready(target, ".csv", ".html")
        yield


def _misfits(schemes: Sequence[str], paper: bool, out: Path | None, splits: int | None, page: Path | None) -> list[str]:
    """Options that are wrong, or do not go together."""
    if not paper:
        from emulator.judge.held_out import unknown_names
        from opsim.cli.motion.judge_tables import wrong_table

        wrong_page = [f"{page}: expected a .html file for --page"] if page and page.suffix.lower() != ".html" else []
        return [*unknown_names(schemes), *wrong_table(out), *wrong_page]
    from opsim.cli.motion.files import wrong_folder

    wrong = ["--paper: expected a folder to write into, -o FOLDER"] if out is None else wrong_folder(out)
    given = {"--scheme": bool(schemes), "--splits": splits is not None, "--page": page is not None}
    return wrong + [f"{name}: does not go with --paper, which has schemes of its own" for name in given if given[name]]


def _read(files: Sequence[str], where: str | None, paper: bool, wrong: list[str]) -> list[Any]:
    """The repetitions of each file. Raises ValueError with all that speaks against judging, before anything is done."""
    from emulator import read_motions
    from emulator.judge.held_out_table import refuse

    chosen = {} if where is None else {"where": None if where == "all" else where}
    sets: list[Any] = []
    for file in files:
        try:
            motions = read_motions(file, **chosen)
            if not paper and len(motions) >= FEWEST:
                refuse(motions, ())
        except (ValueError, OSError) as error:
            wrong.append(str(error))
            continue
        if len(motions) < FEWEST:
            wrong.append(f"{file}: found {len(motions)} repetitions, expected {FEWEST} or more to be judged")
        if motions.task in [other.task for other in sets]:
            wrong.append(f"{file}: a second file of the task {motions.task!r}")
        sets.append(motions)
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return sets


def _show_paper(sets: Sequence[Any], out: Path, seed: int, as_json: bool) -> None:
    from opsim.cli.app import print_json

    page, tables = judged(sets, out, seed)
    if as_json:
        print_json({"page": str(page), "tables": tables})
        return
    click.echo(f"page: {page}")
