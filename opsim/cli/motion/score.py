"""``opsim motion score``: RULA, REBA and OWAS of a recording, or of performances drawn from a library.

What ``opsim motion score`` says beside its figures: what is missing, what is open, what was assumed.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


@click.command("score")
@click.argument("source", metavar="FILE|LIBRARY/TASK")
@click.argument("task", required=False)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="An .html page: the worst postures drawn, and when.")
@click.option("-n", "n", type=click.IntRange(1, 500), help="Performances to draw from a library.  [default: 10]")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option("--load", metavar="MASS", help="What is in both hands together, such as '8 kg'; '0 kg' for nothing.")
@click.option("--loaded", metavar="FROM..TO", help="When it is in the hands: marks or shares, such as 'grasp..1.0'.")
@click.option("--grip", metavar="WORD", help="good, fair, poor or unacceptable (REBA's coupling).")
@click.option("--force", metavar="WORD", help="intermittent, repeated, static or shock (RULA, REBA).")
@click.option("--forearm", metavar="WORD", help="mid or end: how far the forearm is twisted (RULA).")
@click.option("--arms-supported", metavar="yes|no", help="Whether something carries the arms (RULA, REBA).")
@click.option("--sitting", metavar="yes|no", help="Whether he sits (REBA, OWAS).")
@click.option("--legs", metavar="WORD", help="balanced or unbalanced: whether both feet carry (RULA, REBA, OWAS).")
@click.option("--rapid", metavar="yes|no", help="Whether posture changes quickly and far (REBA's activity).")
@click.option("--repeated", is_flag=True, help="Done four times a minute or more (RULA's muscle use, REBA's activity).")
@click.option("--arm-reference", metavar="WORD", help="trunk or gravity.  [default: trunk]")
@click.option("--rula-table", "rula_table_a", metavar="WORD", help="published or worksheet2000.  [default: published]")
@click.option("--rula-force", metavar="WORD", help="paper or worksheet.  [default: paper]")
@click.option("--owas-disputed", multiple=True, metavar="CODE", help="Take the other category of this code.")
@click.option("--threshold", multiple=True, metavar="NAME=ANGLE", help="Such as 'twist=15 deg'; may be said again.")
@click.option("--spread", is_flag=True, help="Look at twist and side bends from 5 to 20 degrees on: wider intervals.")
@click.option("--neck-neutral", metavar="ANGLE", help="How far forward heads stand that look ahead.  [default: found]")
@click.option("--rate", type=float, metavar="HZ", help="Postures looked at a second.  [default: 12]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(source: str, task: str | None, out: Path | None, as_json: bool, **given: Any) -> None:
    """Score the takes of a recording FILE (.npz, .bvh, ...), or performances drawn from LIBRARY/TASK.

    What is not said of load, grip, force and support makes scores intervals: at least, at most.
    """
    with mistakes():
        asked, found = _read(source, task, out, given)
        scored = _scored(found, asked)
        if out is not None:
            _write(found, scored, asked, out)
    if as_json:
        from opsim.cli.app import print_json

        print_json(_told(found, scored, asked, out))
    else:
        _print(found, scored, asked, out)


def _read(source: str, task: str | None, out: Path | None, given: dict[str, Any]) -> tuple[Any, Any]:
    """What is asked, and the movements, measured. Raises ValueError with every mistake of options and files."""
    from opsim.cli.motion.files import ready
    from opsim.cli.motion.score_input import reader_of
    from opsim.cli.motion.score_options import asked_of, wrong_out

    asked, wrong = asked_of(given)
    wrong += wrong_out(out, source)
    read = None
    try:
        read = reader_of(source, task, given["n"], given["seed"])
    except (ValueError, OSError) as error:
        wrong.append(str(error))
    if asked.loaded is not None and read is not None:
        wrong += asked.loaded.unknown(read.mark_names)
    if out is not None and not wrong:
        ready(out, ".html")
    if wrong or read is None:
        raise ValueError("\n".join(wrong))
    found = read.measured(asked)
    if asked.loaded is not None and not any(movement.loaded_s > 0 for movement in found.movements):
        raise ValueError(f"--loaded: found hands full at no time {asked.loaded.words}, expected a later end")
    return asked, found


def _scored(found: Any, asked: Any) -> list[Any]:
    from opsim.ergonomics.scores.scoring import bounds_of
    from opsim.ergonomics.shift.movement import scored_movements

    bounds = bounds_of(asked.handling, walking=found.walking)
    return scored_movements(found.movements, bounds, asked.options, repeated=asked.repeated)


def _write(found: Any, scored: list[Any], asked: Any, out: Path) -> None:
    from opsim.report.motion.scoring import Said, write_scored

    notes = assumptions(found, scored, asked)
    said = Said(found.title, found.skeleton, asked.handling, asked.options, asked.repeated, notes, found.walking)
    write_scored(out, said, scored)


def _told(found: Any, scored: list[Any], asked: Any, out: Path | None) -> dict[str, Any]:
    from opsim.ergonomics.shift.movement import movement_figures

    figures = {row.name: {"unit": row.unit, "low": row.low, "high": row.high} for row in movement_figures(scored)}
    seconds = sum(movement.duration_s for movement in found.movements)
    return {
        "source": found.title,
        "movements": len(found.movements),
        "seconds": round(seconds, 6),
        "figures": figures,
        "notes": assumptions(found, scored, asked),
        "page": None if out is None else str(out),
    }


def _print(found: Any, scored: list[Any], asked: Any, out: Path | None) -> None:
    from opsim.cli.app import print_table, printable
    from opsim.ergonomics.shift.movement import movement_figures

    rows = [figure.row for figure in movement_figures(scored)]
    click.echo(printable(found.title))
    print_table("", ["share of time, score", "at least", "at most"], rows)
    notes = assumptions(found, scored, asked)
    assumed = [note for note in notes if note.startswith(ASSUMED)]
    for note in notes[: len(notes) - len(assumed)]:
        click.echo(printable(note))
    more = "what no skeleton shows, and how the methods were read"
    click.echo(f"{len(assumed)} more assumptions, {more}, are in the page (-o) and with --json")
    if out is not None:
        click.echo(f"page: {out}")


OPEN = {
    "load_kg": "the load (--load)",
    "grip": "the grip (--grip)",
    "force": "how force comes (--force)",
    "forearm": "twist of the forearm (--forearm)",
    "arms_supported": "support of the arms (--arms-supported)",
    "sitting": "whether he sits (--sitting)",
    "legs": "whether both feet carry (--legs)",
    "rapid": "whether posture changes quickly (--rapid)",
}
SETTLED_BY_WALKING = ("arms_supported", "sitting", "legs")
ASSUMED = ("not seen: ", "by rule: ")
"""Beginnings of what holds of every movement."""


def assumptions(found: Any, scored: list[Any], asked: Any) -> list[str]:
    """Sentences: what the skeleton lacks, what nobody said, whence the neck's neutral, what no skeleton shows."""
    from opsim.ergonomics.measures import missing_scores
    from opsim.ergonomics.options import NOT_SEEN, RULES
    from opsim.ergonomics.shift.movement import in_words, unknown_share

    said = [f"missing: {sentence}" for sentence in missing_scores(found.seen_names)]
    said += found.notes
    unknown = unknown_share(scored)
    if unknown > 0:
        share = in_words(unknown, "share")
        said.append(f"missing: nothing is known of the posture for {share} of the time, which no share counts")
    open_words = _open(asked.handling, found.walking)
    if open_words:
        said.append(f"not said, so scores are intervals: {', '.join(open_words)}")
    if asked.handling.load_kg != 0:
        said.append(_loaded(found, scored, asked))
    if not asked.repeated:
        said.append("taken as done less than four times a minute (--repeated)")
    if "head" in found.skeleton.names:
        said.append(f"neutral of the neck: {found.neutral_said}")
    return said + [f"{begins}{each}" for begins, all_of in zip(ASSUMED, (NOT_SEEN, RULES)) for each in all_of]


def _loaded(found: Any, scored: list[Any], asked: Any) -> str:
    """When the hands are full."""
    from opsim.ergonomics.shift.movement import in_words, loaded_share

    load = "something" if asked.handling.load_kg is None else f"{asked.handling.load_kg:g} kg"
    if asked.loaded is None:
        marks = f"; marks: {', '.join(found.mark_names)}" if found.mark_names else ""
        return f"{load} in the hands all the time, as nobody said when (--loaded FROM..TO{marks})"
    share = in_words(loaded_share(scored), "share")
    return f"{load} in the hands {asked.loaded.words}, {share} of the time; empty hands before and after"


def _open(handling: Any, walking: bool) -> list[str]:
    """What is not said and matters: of a load of nothing, neither grip nor force; of walking, nothing that carries."""
    nothing = (*(("grip", "force") if handling.load_kg == 0 else ()), *(SETTLED_BY_WALKING if walking else ()))
    return [words for name, words in OPEN.items() if getattr(handling, name) is None and name not in nothing]
