"""Every figure of a report as an SVG file of its own."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from opsim.report.contents import Contents
from opsim.report.section import Card, Chart, Legend, LegendEntry, Picture, Section, Svg, flat
from opsim.whole import whole_file

LONGEST = 80
ROOT = re.compile(r"<svg\b(?![^>]*\bxmlns=)")


def write_figures(contents: Contents, folder: Path) -> list[Path]:
    """Write all figures and return where they are; charts have their own names, pictures the section's and a number.

    Raises OSError where they cannot be written.
    """
    paths = []
    for section in contents.sections:
        for name, svg in figures_of(section):
            paths.append(folder / f"{safe(name)}.svg")
            with whole_file(paths[-1]) as temporary:
                temporary.write_bytes(svg)
    return paths


def figures_of(section: Section) -> Iterator[tuple[str, bytes]]:
    """The name and the SVG of each figure of a section, in their order."""
    from opsim.report.drawn.chart import chart_svg

    legend: tuple[LegendEntry, ...] = ()
    pictures: list[bytes] = []
    for block in flat(section.blocks):
        if isinstance(block, Legend):
            legend = tuple(block.entries)
        elif isinstance(block, Chart):
            yield block.id, chart_svg(block, legend)
        elif isinstance(block, Picture):
            pictures.append(block.svg)
        elif isinstance(block, Svg):
            pictures.append(_whole(block.text))
        elif isinstance(block, Card):
            pictures += [_whole(picture) for picture in block.pictures]
    yield from ((f"{section.id}-{n}", svg) for n, svg in enumerate(pictures, 1))


def safe(name: str) -> str:
    """A name of a file that leads nowhere else: letters, digits, - and _."""
    return re.sub(r"[^A-Za-z0-9_-]", "-", name)[:LONGEST] or "figure"


def _whole(text: str) -> bytes:
    """What stands in a page as a file of its own."""
    return ROOT.sub('<svg xmlns="http://www.w3.org/2000/svg"', text, count=1).encode()
