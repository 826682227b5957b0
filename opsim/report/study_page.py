"""What a study says: once as data, shown on a screen and as one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from opsim.whole import write_text

HERE = Path(__file__).parent
WORDS, SENTENCE = 16, 40
"""Characters beyond which the text of a column needs room on a narrow screen."""


@dataclass(frozen=True)
class Table:
    """Rows of text under columns; the first ``words`` columns are words, the others numbers that stand to the right."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    words: int = 1

    @property
    def kinds(self) -> list[str]:
        """Of each column, how a page sets it: text that is long keeps room for some words in a line on a phone too."""
        return ["number" if at >= self.words else self._kind_of_words(at) for at in range(len(self.columns))]

    def _kind_of_words(self, at: int) -> str:
        longest = max((len(row[at]) for row in self.rows if at < len(row)), default=0)
        return "sentence" if longest > SENTENCE else "words" if longest > WORDS else ""


@dataclass(frozen=True)
class Section:
    """One thing that a study says: sentences, a table, a picture; each may be missing.

    picture   : SVG text, with names escaped
    legend    : (edge, fill, words) of its marks
    code      : lines to copy into a file
    on_screen : whether the terminal shows it too; what it shows of a study fits on one screen
    on_page   : whether the page shows it; not where another section has all of which this is the short form
    """

    title: str
    sentences: Sequence[str] = ()
    table: Table | None = None
    picture: str = ""
    legend: Sequence[tuple[str, str, str]] = ()
    on_screen: bool = False
    on_page: bool = True
    code: str = ""


@dataclass(frozen=True)
class StudyPage:
    """A study told: ``answer`` says in sentences what came out, as an engineer would; ``words`` how to read it."""

    title: str
    kind: str
    answer: Sequence[str]
    sections: Sequence[Section]
    words: Sequence[str] = ()


def write_study_page(page: StudyPage, path: str | Path) -> Path:
    """Write the page and return where it is."""
    path = Path(path)
    write_text(path, study_html(page))
    return path


def study_html(page: StudyPage) -> str:
    """The page as text; names are escaped by jinja2, and in pictures by who draws them."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined)
    style = (HERE / "report.css").read_text(encoding="utf-8")
    return environment.get_template("study.html.jinja").render(page=page, style=style)
