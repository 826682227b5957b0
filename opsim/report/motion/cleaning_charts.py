"""Takes as rows: along time where something was found, beside it how much of each kind.

A cleaned recording as one picture (SVG or PNG), and as a page with the picture and every repair in words.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from opsim.files import whole_file
from opsim.report.motion.cleaning import HEIGHT_IN, VERDICTS, CleanedView, TakeCard, cell, draw_beside, headline
from opsim.report.plot.plotly import GRID, INK, MUTED

MOST_ROWS = 40
ROW_IN = 0.19
SHADES = ("#e8f1f8", "#0b4f7d"), ("#fdf0d5", "#b3590a")
"""From small to large: what was mended, and what was left."""
NEVER_A_FAULT = ("hold", "heading")


def rows_of(cards: Sequence[TakeCard]) -> tuple[list[TakeCard], int]:
    """The cards to be drawn, in their order, and how many with nothing to mend there is no room for."""
    if len(cards) <= MOST_ROWS:
        return list(cards), 0
    order = list(VERDICTS)
    worst = sorted(range(len(cards)), key=lambda i: (order.index(headline(cards[i].verdict)), -_most(cards[i]), i))[
        :MOST_ROWS
    ]
    return [cards[i] for i in sorted(worst)], len(cards) - len(worst)


def overview_height_in(view: CleanedView) -> float:
    return 0.9 + ROW_IN * len(rows_of(view.cards)[0])


def draw_overview(figure: Any, view: CleanedView) -> None:
    """Fill a subfigure: names and verdicts, bars along time, and a table of sizes, coloured by size."""
    cards, hidden = rows_of(view.cards)
    columns = view.columns
    widths = (5.2, max(1.0, 0.95 * len(columns)))
    along, table = figure.subplots(1, 2, sharey=True, gridspec_kw={"width_ratios": widths, "wspace": 0.03})
    for row, card in enumerate(cards):
        along.barh(row, card.duration_s, height=0.62, color="#eceff2", zorder=1)
        for finding in card.findings:
            if finding.of in columns:
                _mark(along, row, card, finding)
    longest = max(card.duration_s for card in cards)
    along.set(xlim=(0, 1.01 * longest), ylim=(len(cards) - 0.4, -0.6))
    along.set_xlabel("time in the take, s", fontsize=9, color=MUTED)
    along.set_yticks(range(len(cards)), [f"{_short(card.name)}  {card.verdict}" for card in cards], fontsize=8)
    for label, card in zip(along.get_yticklabels(), cards):
        label.set_color(VERDICTS[headline(card.verdict)][0] if card.verdict != "good" else MUTED)
    along.tick_params(axis="x", labelsize=8, colors=MUTED)
    along.grid(axis="x", color=GRID, linewidth=0.6)
    along.set_axisbelow(True)
    along.spines[:].set_visible(False)
    if hidden:
        along.set_title(
            f"{hidden} more takes without anything worse are not drawn", fontsize=8, color=MUTED, loc="left"
        )
    _table(table, cards, columns)


def _mark(axes: Any, row: int, card: TakeCard, finding: Any) -> None:
    """A bar where something was found; what runs through the whole take is a line below."""
    whole = finding.last_s - finding.first_s > 0.95 * card.duration_s
    colour = shade(finding.share, finding.mended)
    if whole:
        axes.plot([finding.first_s, finding.last_s], [row + 0.36] * 2, color=colour, lw=1.5, zorder=2)
        return
    least = 0.006 * card.duration_s
    width = max(finding.last_s - finding.first_s, least)
    start = (finding.first_s + finding.last_s - width) / 2
    flat = finding.kind in NEVER_A_FAULT
    axes.barh(row, width, left=start, height=0.62, color="#c9ced6" if flat else colour, zorder=2 if flat else 3)


def _table(axes: Any, cards: Sequence[TakeCard], columns: Sequence[str]) -> None:
    from matplotlib.patches import Rectangle

    for row, card in enumerate(cards):
        for column, name in enumerate(columns):
            found = [finding for finding in card.findings if finding.of == name]
            if not found:
                continue
            most = max(found, key=lambda finding: finding.share)
            left = [finding for finding in found if not finding.mended]
            colour = shade(most.share, not left)
            if name in NEVER_A_FAULT:
                colour = "#eceff2"
            axes.add_patch(Rectangle((column - 0.47, row - 0.42), 0.94, 0.84, facecolor=colour, zorder=1))
            axes.text(column, row, cell(found), ha="center", va="center", size=7, color=ink_on(colour), zorder=2)
    axes.set(xlim=(-0.5, max(len(columns), 1) - 0.5))
    axes.set_xticks(range(len(columns)), [name.replace(" ", "\n") for name in columns], fontsize=8, color=INK)
    axes.xaxis.tick_top()
    axes.tick_params(length=0, labelleft=False)
    axes.spines[:].set_visible(False)


def shade(share: float, mended: bool) -> str:
    """Blue where mended, orange where left, the darker the larger."""
    low, high = SHADES[0 if mended else 1]
    share = min(max(share, 0.0), 1.0)
    mixed = [round(int(low[i : i + 2], 16) * (1 - share) + int(high[i : i + 2], 16) * share) for i in (1, 3, 5)]
    return "#" + "".join(f"{part:02x}" for part in mixed)


def ink_on(colour: str) -> str:
    """Black or white, whichever reads better on a colour."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return "#ffffff" if 0.3 * red + 0.59 * green + 0.11 * blue < 140 else "#111111"


def _short(name: str) -> str:
    return name if len(name) <= 24 else name[:23] + "…"


def _most(card: TakeCard) -> float:
    return max((finding.share for finding in card.findings if finding.kind not in NEVER_A_FAULT), default=0.0)


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
    from opsim.report.page import asset, template

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
