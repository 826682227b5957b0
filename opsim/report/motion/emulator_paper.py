"""The folder that ``opsim motion judge --paper`` writes: tables as CSV, figures as SVG, and an index page.

Axes and SVG for the figures: light, labelled, told apart without colour vision, the same bytes every time.

Tables as CSV, figures as SVG, and an index page that shows them all.

Figures 14, 15, 16 and 19, drawn from plain arrays (see ``emulator.judge.paper``).

Figures 4, 5, 7, 8, 9, 10 and 13, drawn from plain arrays (see ``emulator.judge.paper``).
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import write_text
from opsim.report.page import asset, template
from opsim.report.plot.body import draw_person

INK, GRID = "#22262b", "#e3e6ea"
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "P")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))


def figure(columns: int = 1, rows: int = 1, wide: float = 4.6, tall: float = 3.2) -> tuple[Any, list[Any]]:
    """A figure and its axes, row by row."""
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(wide * columns, tall * rows), facecolor="white", layout="constrained")
    axes = list(drawn.subplots(rows, columns, squeeze=False).ravel())
    for one in axes:
        one.grid(color=GRID, lw=0.8)
        one.set_axisbelow(True)
        one.spines[["top", "right"]].set_visible(False)
        one.tick_params(labelsize=8, colors=INK)
    return drawn, axes


def said(axes: Any, title: str, x: str, y: str) -> None:
    """Title and labels."""
    axes.set_title(title, size=9, color=INK, parse_math=False)
    axes.set_xlabel(x, size=8, color=INK)
    axes.set_ylabel(y, size=8, color=INK)


def style(i: int) -> dict[str, Any]:
    """Colour and dashes of the i-th line."""
    return {"color": COLOURS[i % len(COLOURS)], "ls": LINES[i % len(LINES)], "lw": 1.5}


def dots(i: int) -> dict[str, Any]:
    """Colour and shape of the i-th cloud."""
    return {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)], "s": 14, "alpha": 0.75, "lw": 0}


def legend(axes: Any) -> None:
    """Names of the lines, where they hide least."""
    axes.legend(fontsize=7, frameon=False)


def svg(drawn: Any) -> str:
    """The figure as the text of an SVG element."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "opsim", "svg.fonttype": "path"}):
        drawn.savefig(stream, format="svg", metadata={"Date": None, "Creator": "opsim"})
    text = stream.getvalue().decode()
    return text[text.index("<svg") :]


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


STEP_M, ROOM = 1.1, 2.5


def figure_14(people: Mapping[str, np.ndarray], skeleton: Any) -> Picture:
    """people : name -> joints (P, J, 3) with the root at 0."""
    drawn, axes = figure(1, len(people), 9.0, 2.1)
    for one, (name, points) in zip(axes, people.items()):
        for i, joints in enumerate(points):
            draw_person(one, joints[:, [0, 2]], -joints[:, 1], STEP_M * i, skeleton)
        one.set(aspect="equal", xlim=(-0.8, STEP_M * (len(points) - 1) + 0.8))
        one.axis("off")
        one.set_title(name, size=9, loc="left", parse_math=False)
    return Picture(14, "points 180 to 240: a recording, and one draw of each scheme", svg(drawn))


def figure_15(points: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """points : name -> recorded (N, 2) and drawn (n, 2)."""
    drawn, axes = figure(len(points), 1, 3.2)
    for one, (name, (recorded, made)) in zip(axes, points.items()):
        one.scatter(*recorded.T, **dots(1), label="recorded")
        one.scatter(*made.T, **dots(0), label="drawn")
        said(one, name, "", "")
        legend(one)
    return Picture(15, "classical scaling of the distances between recorded and drawn sub-sequences", svg(drawn))


def figure_16(rough: Mapping[str, np.ndarray]) -> Picture:
    """rough : name -> (T,); the recordings first."""
    drawn, axes = figure(2)
    for i, (name, course) in enumerate(rough.items()):
        for one in axes:
            one.plot(course, label=name, **style(i))
    said(axes[0], "all", "point from 180 on", "radians a step")
    axes[1].set_ylim(0, ROOM * float(next(iter(rough.values())).max()))
    said(axes[1], "near the recordings", "point from 180 on", "radians a step")
    legend(axes[1])
    return Picture(16, "temporal roughness: mean distance of successive postures", svg(drawn))


def figure_19(rows: Mapping[str, Sequence[Any]]) -> Picture:
    """rows : those of the two-level simulation by the name of level one."""
    drawn, axes = figure(len(rows))
    for one, (name, found) in zip(axes, rows.items()):
        for i, row in enumerate(r for r in found if r.level_two != "PWI"):
            one.scatter(*row.qq.T, **dots(i), label=row.level_two)
        ends = found[0].qq[:, 0].min(), found[0].qq[:, 0].max()
        one.plot(ends, ends, color="#22262b", lw=1)
        said(one, f"level one: {name}", "log-likelihood of the test", "of the draws")
        legend(one)
    return Picture(
        19, "log-likelihood at level two under the law of level one; PWI lies far below the picture", svg(drawn)
    )


N_BINS, N_BARS, CLOCK = 12, 15, "point of the common clock"


def figure_4(shown: Mapping[str, np.ndarray]) -> Picture:
    """shown : name -> (2, T, 3)."""
    drawn, axes = figure(2, 2)
    for row, (name, channels) in enumerate(shown.items()):
        for i in range(2):
            for k in range(channels.shape[-1]):
                axes[2 * row + i].plot(channels[i, :, k], **style(k))
            said(axes[2 * row + i], f"{name}, repetition {i + 1}", CLOCK, "radians")
    caption = "velocity fields brought to one posture, and their integrals: the three liveliest channels"
    return Picture(4, caption, svg(drawn))


def figure_5(errors: Mapping[str, np.ndarray]) -> Picture:
    """errors : name -> (T,)."""
    drawn, (axes,) = figure(1, 1, 7.0)
    for i, (name, error) in enumerate(errors.items()):
        axes.semilogy(np.maximum(error, 1e-17), label=name, **style(i))
    said(axes, "there and back again", CLOCK, "error, radians (sum of arcs)")
    legend(axes)
    return Picture(5, "error of flattening and its way back; the paper's floor of 1e-7 is its arccos", svg(drawn))


def figure_7(shares: Mapping[str, np.ndarray]) -> Picture:
    """shares : name -> share of each component."""
    drawn, axes = figure(len(shares))
    for one, (name, share) in zip(axes, shares.items()):
        one.bar(np.arange(1, len(share[:N_BARS]) + 1), share[:N_BARS], color="#0072B2")
        said(one, f"{name}: share of the variance in space", "component", "share")
    return Picture(7, "spatial PCA: how much of the variance each component carries", svg(drawn))


def figure_8(scores: np.ndarray, functions: np.ndarray, shares: np.ndarray) -> Picture:
    """scores (N, T), functions (3, T), shares of all functions."""
    drawn, axes = figure(3)
    axes[0].plot(scores.T, color="#9aa3ad", lw=0.5)
    axes[0].plot(scores.mean(axis=0), color="#0072B2", lw=2)
    said(axes[0], "first spatial score and its mean", CLOCK, "radians")
    for k, function in enumerate(functions):
        axes[1].plot(function, **style(k), label=f"function {k + 1}")
    said(axes[1], "first functions of time", CLOCK, "")
    legend(axes[1])
    axes[2].bar(np.arange(1, len(shares[:N_BARS]) + 1), shares[:N_BARS], color="#0072B2")
    said(axes[2], "share of the variance", "function", "share")
    return Picture(8, "functional PCA of the first spatial score (SIEM)", svg(drawn))


def figure_9(errors: Mapping[str, tuple[Sequence[int], Sequence[float]]]) -> Picture:
    """errors : reduction -> numbers a sequence, errors."""
    drawn, (axes,) = figure(1, 1, 7.0)
    for i, (name, (numbers, error)) in enumerate(errors.items()):
        axes.plot(numbers, error, marker="o", ms=3, label=name, **style(i))
    axes.set_xscale("log")
    said(axes, "of the sequences that were fitted", "numbers a sequence", "error, radians (eq. 5)")
    legend(axes)
    return Picture(9, "reconstruction error against the numbers that say a sequence", svg(drawn))


def figure_10(coefficients: np.ndarray) -> Picture:
    """coefficients (N, 2, 4)."""
    drawn, axes = figure(4, 2, 2.6, 2.0)
    for k, one in enumerate(axes):
        x = coefficients[:, k // 4, k % 4]
        one.hist(x, bins=N_BINS, density=True, color="#b7cfe3")
        grid, sd = np.linspace(x.min(), x.max(), 100), max(float(x.std()), 1e-12)
        one.plot(grid, np.exp(-0.5 * ((grid - x.mean()) / sd) ** 2) / (sd * np.sqrt(2 * np.pi)), color="#D55E00")
        said(one, f"score {k // 4 + 1}, function {k % 4 + 1}", "", "")
    return Picture(10, "coefficients of SIEM/SequentialPCA and one Gaussian each", svg(drawn))


def figure_13(widths: Sequence[int], errors: Mapping[int, Sequence[float]], p: Sequence[float]) -> Picture:
    """widths : d2; errors : by d1; p for the last d1."""
    drawn, axes = figure(2)
    for i, (d1, error) in enumerate(errors.items()):
        axes[0].plot(widths, error, label=f"d1 = {d1}", **style(i))
    said(axes[0], "reconstruction error", "d2", "radians (eq. 5)")
    legend(axes[0])
    axes[1].scatter(widths, p, **dots(0))
    axes[1].set_ylim(0, 1.05)
    said(axes[1], "reconstructed against original, d1 = 10", "d2", "p")
    return Picture(13, "choosing the dimensions: error, and two-sample test of what is reconstructed", svg(drawn))
