"""The CSV files of ``opsim motion people``: a row for each worker, repetition, quantity, and covariate of each."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from opsim.whole import write_text

KINDS = ("known", "pooled", "new")
PARTS = ("posture", "duration", "sum")
SCORES = tuple(f"{kind}_{part}" for kind in KINDS for part in PARTS)
Row = tuple[str | int | float, ...]


def _people(one: Any) -> Iterator[Row]:
    for person in one.persons:
        closer = "" if person.closer is None else "yes" if person.closer else "no"
        scores = _scores([getattr(person, kind) for kind in KINDS])
        yield (one.task, person.name, person.n_repetitions, person.n_judged, *scores, closer)


def _left_out(one: Any) -> Iterator[Row]:
    for row in zip(one.names.tolist(), one.trials.tolist(), one.known, one.pooled, one.new):
        yield (one.task, *row[:2], *_scores(row[2:]))


def _iccs(one: Any) -> Iterator[Row]:
    for found in one.iccs:
        yield (one.task, found.quantity, found.icc, found.low, found.high)


def _covariates(one: Any) -> Iterator[Row]:
    for told in one.told.told:
        yield (one.task, told.covariate, told.quantity, told.r2, told.p, "yes" if told.kept else "no", "")
    for note in one.told.notes:
        covariate, why = note.split(": ", 1)
        yield (one.task, covariate, "", math.nan, math.nan, "", why)


FILES: dict[str, tuple[Sequence[str], Callable[[Any], Iterator[Row]]]] = {
    "people.csv": (("task", "worker", "repetitions", "judged", *SCORES, "own_closer"), _people),
    "left_out.csv": (("task", "worker", "trial", *SCORES), _left_out),
    "icc.csv": (("task", "quantity", "icc", "low_95", "high_95"), _iccs),
    "covariates.csv": (("task", "covariate", "quantity", "r2", "p", "kept", "note"), _covariates),
}


def write_tables(folder: Path, found: Sequence[Any]) -> None:
    """Write each of ``FILES`` for all tasks (``emulator.judge.people.People``); what is NaN stays empty."""
    for name, (columns, rows) in FILES.items():
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([_plain(value) for value in row] for one in found for row in rows(one))
        write_text(folder / name, out.getvalue())


def as_plain(one: Any) -> dict[str, list[dict[str, Any]]]:
    """The same rows of one task for JSON: name of the table -> its rows by column."""
    return {
        name.removesuffix(".csv"): [dict(zip(columns, row)) for row in rows(one)]
        for name, (columns, rows) in FILES.items()
    }


def _scores(kinds: Sequence[Any]) -> list[float]:
    """Posture, duration and their sum of each kind (2,)."""
    return [float(value) for both in kinds for value in (*both, both.sum())]


def _plain(value: str | int | float) -> str | int:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    return value
