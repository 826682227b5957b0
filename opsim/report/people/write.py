"""The folder of ``opsim motion people``: CSV files, a picture, and a page that shows tables and picture offline."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from opsim.report.offline import asset, template
from opsim.report.people.lines import MEANING, UNITS, compact, notes, overview, persons, title, total
from opsim.report.people.picture import picture
from opsim.report.people.tables import FILES, write_tables
from opsim.whole import write_text

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
