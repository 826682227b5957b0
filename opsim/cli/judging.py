"""All that ``opsim motion judge --paper`` makes, section by section; between them the names of the steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from opsim.cli.verbs import Mistake, mistakes

N_STEPS = 5
"""Steps of one class; one more for each body."""


def judged(sets: Sequence[Any], out: Path, seed: int) -> tuple[Path, dict[str, Any]]:
    """Write the tables, figures and the page into ``out``; the page, and the rows of each class.

    Classes are written as they are finished: a stop (Interrupted) or a failure (Mistake) names those that are there.
    """
    from opsim.cli.progress import progress
    from opsim.cli.stopping import held, stopped, stops_once

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
    from opsim.report.paper.write import write_paper

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
    from opsim.report.paper.drawn import figure_19
    from opsim.report.paper.write import Section

    yield f"{c.task}: flattening and reduction"
    pictures = list(_flattened(c))
    yield f"{c.task}: sub-sequences"
    tables = [table_1(c), table_2(c)]
    pictures += _drawn(c, draws_of(c))
    yield f"{c.task}: two levels"
    rows = level_two(c)
    tables.append(table_3(rows))
    pictures.append(figure_19(rows))
    yield f"{c.task}: quantization"
    tables += tables_4_and_5(c, postures)
    people = f"{len(c.motions)} repetitions of {len(c.motions.workers)} people on {c.aligned.shape[1]} points"
    yield Section(c.task, f"{people}; {postures.n_postures} canonical postures", tuple(tables), tuple(pictures))


def _flattened(c: Any) -> Iterator[Any]:
    from emulator.judge import paper as found
    from opsim.report.paper import flattening as pictures

    yield pictures.figure_4(found.fields(c))
    yield pictures.figure_5(found.round_trip_errors(c))
    yield pictures.figure_7(found.spatial_shares(c))
    yield pictures.figure_8(*found.first_score(c))
    yield pictures.figure_9(found.errors_by_size(c))
    yield pictures.figure_10(found.first_coefficients(c))
    yield pictures.figure_13(*found.dimensions(c))


def _drawn(c: Any, draws: Any) -> Iterator[Any]:
    from emulator.judge import paper as found
    from opsim.report.paper import drawn as pictures

    yield pictures.figure_14(found.people(c, draws), c.motions.skeleton)
    yield pictures.figure_15(found.scaled(draws))
    yield pictures.figure_16(found.roughness_over_time(draws))
