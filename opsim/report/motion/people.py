"""What ``opsim motion people`` found: as lines and tables for people, CSV for programs, a picture and a page.

The picture of ``opsim motion people``: how much lies between people, and what their own draws are worth.

The CSV files of ``opsim motion people``: a row for each worker, repetition, quantity, and covariate of each.

What was found of each task in one compact table, and of all tasks in a line.

The folder of ``opsim motion people``: CSV files, a picture, and a page that shows tables and picture offline.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import write_text
from opsim.report.motion.emulator_paper import COLOURS, GRID, INK, MARKERS, figure, said, svg
from opsim.report.page import asset, template

ROOM = 0.75
"""Share of a quantity's row that its tasks take."""


def picture(found: Sequence[Any]) -> str:
    """SVG: ICC intervals by quantity and task; of each repetition the score of pooled draws against the own."""
    quantities = list(dict.fromkeys(icc.quantity for one in found for icc in one.iccs))
    tall = max(4.0, 0.35 + 0.09 * len(found) * len(quantities))
    drawn, (left, right) = figure(2, 1, 5.6, tall)
    _intervals(left, found, quantities)
    _pairs(right, found)
    handles, names = right.get_legend_handles_labels()
    legend = drawn.legend(handles, names, loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    for text in legend.get_texts():
        text.set_parse_math(False)
    return svg(drawn)


def _intervals(axes: Any, found: Sequence[Any], quantities: Sequence[str]) -> None:
    for i, one in enumerate(found):
        at = (i + 0.5) / len(found) * ROOM - ROOM / 2
        for icc in one.iccs:
            y = quantities.index(icc.quantity) + at
            axes.plot([icc.low, icc.high], [y, y], color=_look(i)["color"], lw=1.6)
            axes.scatter([icc.icc], [y], s=20, lw=0, zorder=3, **_look(i))
    axes.set_yticks(range(len(quantities)), quantities)
    axes.set_ylim(len(quantities) - 0.5, -0.5)
    axes.axvline(0, color=INK, lw=1)
    axes.grid(visible=False, axis="y")
    for y in range(1, len(quantities), 2):
        axes.axhspan(y - 0.5, y + 0.5, color=GRID, alpha=0.5, lw=0, zorder=0)
    axes.set_xlim(right=1.02)
    said(axes, "what lies between people", "ICC(1,1) and its 95 % interval", "")


def _pairs(axes: Any, found: Sequence[Any]) -> None:
    for i, one in enumerate(found):
        axes.scatter(one.pooled.sum(axis=1), one.known.sum(axis=1), s=22, alpha=0.75, lw=0, label=one.task, **_look(i))
    ends = _ends(np.concatenate([one.pooled.sum(axis=1) + 0 * one.known.sum(axis=1) for one in found]))
    axes.plot(ends, ends, color=INK, lw=1)
    axes.set_aspect("equal", adjustable="datalim")
    title = "each repetition left out: below the line the own worker's draws are closer"
    said(axes, title, "energy score of pooled draws", "energy score of draws of the own worker")


def _ends(values: np.ndarray) -> tuple[float, float]:
    finite = values[np.isfinite(values)]
    return (float(min(finite.min(), 0)), float(finite.max())) if len(finite) else (0.0, 1.0)


def _look(i: int) -> dict[str, str]:
    """Colour and marker of the i-th task; no pair comes twice among the first 36."""
    return {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[(i + i // len(COLOURS)) % len(MARKERS)]}


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


NOTHING, BOTH = "-", "posture + duration"
MOST_COVARIATES = 3
MEANING = {
    "ICC": "share of the variance that lies between people, with its 95 % interval (Shrout & Fleiss 1979, case 1; "
    "interval by Thomas & Hultquist 1978)",
    "known": "energy score of draws of the repetition's own worker, that repetition left out: small is good",
    "pooled": "of draws of that same fit which ask for nobody",
    "new": "of draws of new people, the repetition's worker left out whole",
    "R2 (p)": "what a covariate alone foretells of a person left out, below 0: worse than the others' mean does; "
    "how often noise does as well, * for less than 5 % with all quantities corrected for one another",
}
UNITS = (
    "Energy scores are over the mean distance of two repetitions, so that postures and log duration can be added; "
    "draws that know the task but not the worker come to about a half of each."
)


def title(one: Any) -> str:
    """Who was recorded."""
    return f"{one.task}: {len(one.names)} repetitions of {len(one.persons)} people ({one.selection})"


def compact(one: Any) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of a task: scores of posture, duration and both; ICC and R2 of each quantity."""
    covariates = list(dict.fromkeys(told.covariate for told in one.told.told))[:MOST_COVARIATES]
    told = {(told.covariate, told.quantity): told for told in one.told.told}
    iccs = {found.quantity: found for found in one.iccs}
    scores = _person_scores(one.over_all)
    rows = []
    for quantity in dict.fromkeys([*scores, *iccs]):
        r2 = [_r2(told.get((name, quantity))) for name in covariates]
        rows.append([quantity, *scores.get(quantity, [NOTHING] * len(KINDS)), *_icc(iccs.get(quantity)), *r2])
    return ["", *KINDS, "ICC", "95 %", *(f"R2 {name} (p)" for name in covariates)], rows


def notes(one: Any) -> list[str]:
    """For whom knowing him did not help, and which covariates tell nothing."""
    judged = [person for person in one.persons if person.closer is not None]
    closer, unseen = [p.name for p in judged if p.closer], len(one.persons) - len(judged)
    if judged:
        others = [person.name for person in judged if not person.closer]
        found = [f"own draws are closer than pooled ones for {len(closer)} of {len(judged)} people"]
        found[0] += f", not for {', '.join(others)}" if others else ""
    else:
        found = ["nobody could be foretold by his own draws"]
    if unseen:
        found[0] += f"; {unseen} {'has' if unseen == 1 else 'have'} too few repetitions to be judged by"
    more = len({told.covariate for told in one.told.told}) - MOST_COVARIATES
    found += [f"{more} more covariates in covariates.csv"] if more > 0 else []
    return found + [f"covariate {note}" for note in one.told.notes]


def pairs(found: Sequence[Any]) -> tuple[int, int]:
    """(task, worker) pairs whose own draws are closer than pooled ones, of how many that were judged."""
    closer = [person.closer for one in found for person in one.persons if person.closer is not None]
    return sum(closer), len(closer)


def total(found: Sequence[Any]) -> str:
    """The line over all tasks."""
    closer, judged = pairs(found)
    if not judged:
        return "no (task, worker) pair could be judged"
    share = f"{100 * closer / judged:.0f} %"
    return f"own draws are closer than pooled ones for {closer} of {judged} (task, worker) pairs: {share}"


def overview(found: Sequence[Any]) -> tuple[list[str], list[list[str]]]:
    """A row for each task."""
    rows = []
    for one in found:
        closer, judged = pairs([one])
        both = _person_scores(one.over_all)[BOTH]
        icc = one.iccs[0]
        rows.append([one.task, str(len(one.persons)), str(len(one.names)), *_icc(icc), *both, f"{closer} of {judged}"])
    return ["task", "people", "repetitions", "ICC of log duration", "95 %", *KINDS, "own closer"], rows


def persons(one: Any) -> tuple[list[str], list[list[str]]]:
    """A row for each worker: scores of both together."""
    rows = [
        [p.name, str(p.n_repetitions), str(p.n_judged), *_person_scores(p)[BOTH], _yes(p.closer)] for p in one.persons
    ]
    return ["worker", "repetitions", "judged", *KINDS, "own closer"], rows


def _person_scores(person: Any) -> dict[str, list[str]]:
    kinds = [getattr(person, kind) for kind in KINDS]
    return {
        BOTH: [_number(float(kind.sum())) for kind in kinds],
        "posture": [_number(float(kind[0])) for kind in kinds],
        "log duration": [_number(float(kind[1])) for kind in kinds],
    }


def _icc(found: Any) -> list[str]:
    if found is None or math.isnan(found.icc):
        return [NOTHING, NOTHING]
    return [_number(found.icc), f"{found.low:.2f} to {found.high:.2f}"]


def _r2(told: Any) -> str:
    return NOTHING if told is None else f"{told.r2:.2f} ({_number(told.p)}{'*' if told.kept else ''})"


def _yes(closer: bool | None) -> str:
    return NOTHING if closer is None else "yes" if closer else "no"


def _number(value: float) -> str:
    return NOTHING if math.isnan(value) else f"{value:.2f}"


PAGE, PICTURE = "index.html", "people.svg"


def write_people(folder: Path, found: Sequence[Any], seed: int) -> Path:
    """Write all of the tasks found so far (``emulator.judge.people.People``); returns where the page is."""
    drawn = picture(found)
    write_tables(folder, found)
    write_text(folder / PICTURE, drawn)
    page = template("people/index.html.jinja").render(
        style=asset("report.css"),
        total=total(found),
        overview=overview(found),
        picture=drawn,
        picture_file=PICTURE,
        files=list(FILES),
        sections=[_section(one) for one in found],
        meaning=MEANING,
        words=[
            "Each repetition was left out of the fit in turn, and each person; draws of the rest then foretell it.",
            "Repetitions were registered once, all together: the common clock has seen what is left out.",
            UNITS,
            f"Seed {seed}.",
        ],
    )
    write_text(folder / PAGE, page)
    return folder / PAGE


def _section(one: Any) -> dict[str, Any]:
    source = f"{one.source}; {one.licence}"
    return {"title": title(one), "source": source, "tables": [compact(one), persons(one)], "notes": notes(one)}
