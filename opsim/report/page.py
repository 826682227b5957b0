"""What a section of a report is made of: data that one macro a kind draws, in the order it stands in.

What a study says: once as data, shown on a screen and as one HTML file that needs nothing else.

What every page of ours shares: one file that fetches nothing, and scripts that run only as they were written.

What a picture needs that not everybody has installed.
"""

from __future__ import annotations

import base64
import hashlib
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from opsim.files import write_text

LegendEntry = tuple[str, str] | tuple[str, str, str]
"""(colour, words), or (colour, look, words) with the look of a line (solid, dashed, dotted) or of a dot (dot)."""


@dataclass(frozen=True)
class Words:
    """A paragraph; muted : what is only to be known by who asks how it was made."""

    text: str
    muted: bool = False
    kind: str = "words"


@dataclass(frozen=True)
class Caution:
    """Something that must not be overlooked."""

    text: str
    kind: str = "caution"


@dataclass(frozen=True)
class Bullets:
    """Sentences that stand one below the other."""

    items: Sequence[str]
    kind: str = "bullets"


@dataclass(frozen=True)
class Facts:
    """Pairs of what it is and what it says; code : set in even letters, such as hashes, "" for none."""

    rows: Sequence[tuple[str, str, str]]
    kind: str = "facts"


@dataclass(frozen=True)
class Heading:
    """A title within a section."""

    text: str
    kind: str = "heading"


@dataclass(frozen=True)
class Legend:
    """What the colours mean, of several figures at once."""

    entries: Sequence[LegendEntry]
    kind: str = "legend"


@dataclass(frozen=True)
class Chart:
    """A figure that plotly draws.

    id     : of the page's element, unique on the page, of letters, digits, - and _
    figure : {"data": ..., "layout": ...} as ``opsim.report.plot.plotly`` makes it, names in it escaped
    said   : the same in words, for who cannot see it
    note   : small, below it
    """

    id: str
    figure: Mapping[str, Any]
    said: str
    title: str = ""
    legend: Sequence[LegendEntry] = ()
    note: str = ""
    kind: str = "chart"

    @property
    def height_px(self) -> int:
        """The room that is kept for it until it is drawn."""
        return round(self.figure["layout"].get("height") or 300)


@dataclass(frozen=True)
class Svg:
    """A picture as SVG text whose names are escaped by who draws it; wide : it scrolls sideways on a narrow screen."""

    text: str
    said: str
    title: str = ""
    caption: str = ""
    legend: Sequence[LegendEntry] = ()
    wide: bool = False
    kind: str = "svg"


@dataclass(frozen=True)
class Picture:
    """A picture of many shapes, as SVG bytes: an image, so that they are none of the page's elements.

    aside : who or what it is shown as, beside its title; least_px : narrower than this it scrolls sideways
    """

    svg: bytes
    said: str
    title: str = ""
    aside: str = ""
    caption: str = ""
    legend: Sequence[LegendEntry] = ()
    least_px: int = 760
    kind: str = "picture"

    @property
    def source(self) -> str:
        """Of an image on a page that fetches nothing."""
        return "data:image/svg+xml;base64," + b64encode(self.svg).decode()


@dataclass(frozen=True)
class Card:
    """One thing seen from several sides. pictures : SVG text; scores : (name, value, colour) of its parts"""

    title: str
    strong: str
    muted: str
    pictures: Sequence[str]
    scores: Sequence[tuple[str, str, str]]
    caption: str
    kind: str = "card"


@dataclass(frozen=True)
class Grid:
    """A table of text; the first ``words`` columns are words, the others numbers but those whose place is in ``left``.

    said : what it is, where it has no title; folded : under its title, to open; strong : the place of a column that
    stands out, -1 for none; tags : places of columns whose cells are short remarks in a frame. An empty first cell
    means: of the same as the row above.
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    title: str
    words: int = 1
    folded: bool = False
    left: Sequence[int] = ()
    strong: int = -1
    tags: Sequence[int] = ()
    said: str = ""
    kind: str = "grid"

    def look(self, place: int) -> str:
        """The classes of a column's cells."""
        if place == self.strong:
            return "number mean"
        return "unit" if place in self.left else "words" if place < self.words else "number"


@dataclass(frozen=True)
class Panels:
    """Small charts, pictures or cards beside each other, as many as the screen has room for."""

    blocks: Sequence[Chart | Svg | Card | Words | Panel]
    least_px: int = 300
    kind: str = "panels"


@dataclass(frozen=True)
class Panel:
    """A title with a sentence where a chart would say nothing."""

    title: str
    text: str
    kind: str = "panel"


@dataclass(frozen=True)
class Folded:
    """Blocks under a title, to open; on_paper : whether they are printed unasked."""

    title: str
    blocks: Sequence[Block]
    on_paper: bool = True
    kind: str = "folded"


Block = (
    Words | Caution | Bullets | Facts | Heading | Legend | Chart | Svg | Picture | Card | Grid | Panels | Panel | Folded
)


@dataclass(frozen=True)
class Section:
    """One thing that a report says; where there is nothing to say, a section is not made.

    id : of the page, for links; nav : its short name among the links, "" for none
    """

    id: str
    title: str
    blocks: Sequence[Block] = ()
    nav: str = ""

    @property
    def charts(self) -> dict[str, Mapping[str, Any]]:
        """The figures by the ids of their elements."""
        return {block.id: block.figure for block in flat(self.blocks) if isinstance(block, Chart)}


def flat(blocks: Sequence[Block]) -> Iterator[Block]:
    """All blocks, those within others too, in the order in which they are seen."""
    for block in blocks:
        yield block
        if isinstance(block, Panels | Folded):
            yield from flat(block.blocks)


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
class StudySection:
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
    sections: Sequence[StudySection]
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


@lru_cache(maxsize=16)
def asset(name: str) -> str:
    """The text of a style sheet or script that lies beside this file."""
    return (HERE / name).read_text(encoding="utf-8")


@lru_cache(maxsize=4)
def template(name: str) -> Any:
    """A jinja2 template that lies beside this file: names are escaped, a name that is not given is an error."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)


def policy(*scripts: str) -> str:
    """The browser runs the scripts with these hashes and fetches nothing, whatever a name may have smuggled in."""
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    allowed = " ".join(f"'sha256-{digest}'" for digest in hashes)
    fetched = f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:"
    return f"{fetched}; base-uri 'none'; form-action 'none'"


def need_matplotlib(what: str) -> None:
    """Raises ValueError, saying how to get it, where matplotlib is not installed."""
    if find_spec("matplotlib") is None:
        raise ValueError(f"{what} need matplotlib, which is not installed; 'pip install opsim[matplotlib]' brings it")
