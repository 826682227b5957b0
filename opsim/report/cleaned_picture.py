"""A cleaned recording as one picture (SVG or PNG), and as a page with the picture and every repair in words."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from opsim.report.cleaned import VERDICTS, CleanedView
from opsim.report.cleaned_beside import HEIGHT_IN, draw_beside
from opsim.report.cleaned_overview import draw_overview, overview_height_in
from opsim.report.palette import INK, MUTED
from opsim.whole import whole_file

WIDTH_IN = 11.0
TITLE_IN = 0.95


def cleaned_bytes(view: CleanedView, kind: str = "svg") -> bytes:
    """The picture: takes along time and by kind, then the worst repairs before and after. kind: svg or png."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    stream = io.BytesIO()
    style: Any = {"svg.fonttype": "path", "svg.hashsalt": "opsim", "text.parse_math": False}
    heights = [TITLE_IN, overview_height_in(view), *[HEIGHT_IN] * len(view.worst)]
    with rc_context(style):
        figure = Figure(figsize=(WIDTH_IN, sum(heights)), facecolor="white", layout="constrained")
        rows = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
        _title(rows[0], view)
        draw_overview(rows[1], view)
        for part, mended in zip(rows[2:], view.worst):
            draw_beside(part, mended)
        metadata = {"Date": None, "Creator": "opsim"} if kind == "svg" else {"Software": "opsim"}
        figure.savefig(stream, format=kind, dpi=110, metadata=metadata)
    return stream.getvalue()


def write_cleaned(view: CleanedView, *paths: Path) -> None:
    """Write the picture, .svg or .png by its ending, or the page, .html; the same picture is drawn once."""
    drawn: dict[str, bytes] = {}
    for path in paths:
        ending = path.suffix.removeprefix(".").lower()
        kind = "svg" if ending == "html" else ending
        drawn[kind] = drawn.get(kind) or cleaned_bytes(view, kind)
        made = page(view, drawn["svg"].decode()).encode() if ending == "html" else drawn[kind]
        with whole_file(path) as temporary:
            temporary.write_bytes(made)


def page(view: CleanedView, picture: str) -> str:
    """One offline page: the picture, which is SVG, above a table of all that was found."""
    from opsim.report.offline import asset, template

    rows = [
        {
            "take": card.name,
            "verdict": card.verdict,
            "kind": finding.kind,
            "at": f"{finding.first_s:.2f} to {finding.last_s:.2f}",
            "size": finding.size,
            "words": finding.words,
        }
        for card in view.cards
        for finding in card.findings
    ]
    return str(
        template("cleaned.html.jinja").render(
            title=view.title,
            notes=list(view.notes),
            picture=picture[picture.index("<svg") :],
            kinds=list(view.kinds),
            rows=rows,
            style=asset("report.css"),
        )
    )


def _title(figure: Any, view: CleanedView) -> None:
    figure.text(0.012, 0.94, view.title, va="top", size=13, weight="bold", color=INK)
    for line, note in enumerate(view.notes[:2]):
        figure.text(0.012, 0.66 - 0.2 * line, note, va="top", size=9, color=MUTED)
    at = 0.012
    for verdict, (colour, meaning) in VERDICTS.items():
        if any(verdict in card.verdict.split(", ") for card in view.cards):
            words = f"{verdict}: {meaning}"
            figure.text(at, 0.22, words, va="top", size=9, color=colour)
            at += 0.0068 * len(words) + 0.02
