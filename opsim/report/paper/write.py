"""Tables as CSV, figures as SVG, and an index page that shows them all."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from opsim.report.offline import asset, template
from opsim.whole import write_text


@dataclass(frozen=True)
class Picture:
    """A figure: its number in the paper, a caption, and the SVG."""

    number: int
    caption: str
    svg: str


@dataclass(frozen=True)
class Section:
    """What was found of one class (or of all together): tables (see ``emulator.judge.paper``) and pictures."""

    name: str
    words: str
    tables: tuple[Any, ...] = ()
    pictures: tuple[Picture, ...] = field(default=())


def write_paper(folder: Path, title: str, words: Sequence[str], sections: Sequence[Section]) -> Path:
    """Write every table and picture under ``folder``, and the page; returns where the page is."""
    for section in sections:
        for table in section.tables:
            write_text(folder / section.name / f"table_{table.number}.csv", _csv(table))
        for picture in section.pictures:
            write_text(folder / section.name / f"figure_{picture.number}.svg", picture.svg)
    page = template("paper/index.html.jinja").render(
        title=title, words=words, sections=[_shown(section) for section in sections], style=asset("report.css")
    )
    write_text(folder / "index.html", page)
    return folder / "index.html"


def cell(value: str | float) -> str:
    """A table's cell as text: four figures, or the word."""
    return value if isinstance(value, str) else f"{value:.4g}"


def _csv(table: Any) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows([[v if isinstance(v, str) else repr(float(v)) for v in row] for row in table.rows])
    return out.getvalue()


def _shown(section: Section) -> dict[str, Any]:
    tables = [
        {
            "number": table.number,
            "title": table.title,
            "columns": table.columns,
            "rows": [[(cell(v), not isinstance(v, str)) for v in row] for row in table.rows],
        }
        for table in section.tables
    ]
    return {"name": section.name, "words": section.words, "tables": tables, "pictures": section.pictures}
