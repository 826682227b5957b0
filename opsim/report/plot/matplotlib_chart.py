"""The figures of a report drawn by matplotlib, for papers: from the same data as plotly draws them on the page.

Needs the extra ``matplotlib``. Of plotly's language as much is understood as ``opsim.report`` speaks; anything else
raises ValueError, so that no file shows less than the page.

One chart of a report as SVG, drawn by matplotlib from the same data as plotly draws it on the page.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.page import Chart, LegendEntry
from opsim.report.plot.matplotlib_axes import HATCHES, POINT, Scale, colour, dash, hatched, set_axis, words
from opsim.report.plot.matplotlib_marks import draw_bars, draw_box, draw_heatmap, draw_scatter, draw_violin, leave_out

WIDE_IN, PX_PER_IN = 8.0, 110.0
FIXED: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "opsim",
    "font.family": ["sans-serif"],
    "font.sans-serif": ["DejaVu Sans"],
    "hatch.linewidth": 0.7,
    "axes.unicode_minus": False,
}
SILENT: dict[str, Any] = {"showticklabels": False, "showgrid": False, "title": {}}
"""An axis that stands there already."""
Trace = Mapping[str, Any]
Layout = Mapping[str, Any]
Pair = tuple[str, str]


def chart_svg(chart: Chart, legend: Sequence[LegendEntry] = ()) -> bytes:
    """The same bytes for the same chart. legend : what colours mean, where the chart itself does not say

    Raises ValueError for what no drawing is known of.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(FIXED):
        figure = Figure(figsize=(WIDE_IN, max(1.2, chart.height_px / PX_PER_IN)), facecolor="white")
        _draw(figure, chart.figure["data"], chart.figure["layout"])
        _title(figure, chart.title)
        _legend(figure, chart.legend or legend)
        stream = io.BytesIO()
        metadata = {"Date": None, "Creator": "opsim"}
        figure.savefig(stream, format="svg", bbox_inches="tight", pad_inches=0.08, metadata=metadata)
    return stream.getvalue()


def _draw(figure: Any, data: Sequence[Trace], layout: Layout) -> None:
    traces = [trace for trace in data if trace.get("visible", True) is True]
    refs = list(dict.fromkeys((trace.get("xaxis", "x"), trace.get("yaxis", "y")) for trace in traces)) or [("x", "y")]
    scales = {ref: _scale(layout, traces, ref) for pair in refs for ref in pair}
    found = {pair: _axes(figure, layout, pair) for pair in refs}
    shown: set[str] = set()
    for pair, axes in found.items():
        own = [trace for trace in traces if (trace.get("xaxis", "x"), trace.get("yaxis", "y")) == pair]
        _draw_traces(axes, own, scales[pair[0]], scales[pair[1]], layout)
        for which, ref in zip("xy", pair):
            set_axis(axes, which, {**_said(layout, ref), **(SILENT if ref in shown else {})}, scales[ref])
        shown |= set(pair)
        leave_out(axes)
    for shape in layout.get("shapes", ()):
        _shape(figure, found, scales, shape)
    for note in layout.get("annotations", ()):
        _note(figure, found, scales, note)


def _said(layout: Layout, ref: str) -> Mapping[str, Any]:
    """What the layout says of an axis: ``x2`` is ``xaxis2``."""
    return layout.get(f"{ref[0]}axis{ref[1:]}") or {}


def _scale(layout: Layout, traces: Sequence[Trace], ref: str) -> Scale:
    which = ref[0]
    values: list[Any] = []
    for trace in traces:
        if trace.get(f"{which}axis", which) == ref and trace.get(which) is not None:
            values += list(trace[which])
    return Scale(_said(layout, ref), values)


def _axes(figure: Any, layout: Layout, pair: Pair) -> Any:
    """The field of a pair of axes: the sheet is what plotly calls paper."""
    x, y = (_said(layout, ref) for ref in pair)
    base = _said(layout, y["overlaying"]) if y.get("overlaying") else y
    (left, right), (low, high) = x.get("domain", (0.0, 1.0)), base.get("domain", (0.0, 1.0))
    axes = figure.add_axes((left, low, right - left, high - low), label=f"{pair[0]}{pair[1]}")
    axes.patch.set_visible(False)
    axes.set_axisbelow(True)
    for side in axes.spines.values():
        side.set_visible(False)
    if x.get("scaleanchor") or y.get("scaleanchor"):
        axes.set_aspect("equal", adjustable="datalim")
    return axes


def _draw_traces(axes: Any, traces: Sequence[Trace], x: Scale, y: Scale, layout: Layout) -> None:
    bars = [trace for trace in traces if trace["type"] == "bar"]
    if bars:
        draw_bars(axes, bars, x, y, layout)
    before = None
    for trace in traces:
        kind = trace.get("type", "scatter")
        if kind in ("scatter", "scattergl"):
            draw_scatter(axes, trace, x, y, before)
            before = x(trace["x"]), y(trace["y"])
        elif kind in OTHERS:
            OTHERS[kind](axes, trace, x, y)
        elif kind != "bar":
            raise ValueError(f"no drawing of a {kind!r} chart")


OTHERS = {"heatmap": draw_heatmap, "violin": draw_violin, "box": draw_box}


def _place(
    figure: Any, found: Mapping[Pair, Any], scales: Mapping[str, Scale], which: str, ref: str
) -> tuple[Any, Any]:
    """(matplotlib's transformation along one direction, how values become its numbers)."""
    if ref == "paper":
        return figure.transFigure, float
    axis, _, domain = ref.partition(" ")
    axes = next(axes for pair, axes in found.items() if pair["xy".index(which)] == axis)
    return (axes.transAxes, float) if domain else (axes.transData, scales[axis].number)


def _shape(figure: Any, found: Mapping[Pair, Any], scales: Mapping[str, Scale], said: Mapping[str, Any]) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Ellipse, Rectangle
    from matplotlib.transforms import blended_transform_factory

    axes = next(iter(found.values()))
    across, x = _place(figure, found, scales, "x", said.get("xref", "x"))
    upward, y = _place(figure, found, scales, "y", said.get("yref", "y"))
    (x0, x1), (y0, y1) = (x(said["x0"]), x(said["x1"])), (y(said["y0"]), y(said["y1"]))
    line, opacity = said.get("line") or {}, said.get("opacity", 1.0)
    wide = line.get("width", 2) * POINT
    look: dict[str, Any] = {
        "transform": blended_transform_factory(across, upward),
        "zorder": 0.6 if said.get("layer") == "below" else 3.5,
        "clip_on": False,
    }
    if said["type"] == "line":
        ink = colour(line.get("color", "#22262b"), opacity)
        axes.add_artist(Line2D([x0, x1], [y0, y1], color=ink, lw=wide, ls=dash(line.get("dash")), **look))
        return
    fill = colour(said.get("fillcolor"), opacity)
    paint = {
        "facecolor": fill or "none",
        "edgecolor": colour(line.get("color"), opacity) if wide else "none",
        "lw": wide,
    }
    if said["type"] == "rect":
        axes.add_artist(Rectangle((x0, y0), x1 - x0, y1 - y0, **paint, **look))
    elif said["type"] == "circle":
        axes.add_artist(Ellipse(((x0 + x1) / 2, (y0 + y1) / 2), abs(x1 - x0), abs(y1 - y0), **paint, **look))
    else:
        raise ValueError(f"no drawing of a shape {said['type']!r}")


def _note(figure: Any, found: Mapping[Pair, Any], scales: Mapping[str, Scale], said: Mapping[str, Any]) -> None:
    from matplotlib.transforms import blended_transform_factory

    across, x = _place(figure, found, scales, "x", said.get("xref", "x"))
    upward, y = _place(figure, found, scales, "y", said.get("yref", "y"))
    font, arrow = said.get("font") or {}, said.get("showarrow", True)
    shift = (said.get("xshift", 0) * POINT, said.get("yshift", 0) * POINT)
    if arrow:
        shift = (said.get("ax", -10) * POINT, -said.get("ay", -30) * POINT)
    anchors = {"top": "top", "middle": "center", "bottom": "bottom", "auto": "center"}
    side = said.get("xanchor", "auto")
    axes = next(iter(found.values()))
    note = axes.annotate(
        words(said["text"]),
        (x(said["x"]), y(said["y"])),
        shift,
        xycoords=blended_transform_factory(across, upward),
        textcoords="offset points",
        ha="center" if side == "auto" else side,
        va=anchors[said.get("yanchor", "auto")],
        ma=said.get("align", "center"),
        color=colour(font.get("color", "#22262b")),
        size=font.get("size", 12) * POINT,
        rotation=-said.get("textangle", 0),
        parse_math=False,
        annotation_clip=False,
        zorder=7,
        arrowprops={"arrowstyle": "-", "color": colour(said.get("arrowcolor", "#5c6570")), "lw": 0.8}
        if arrow
        else None,
    )
    if said.get("bgcolor"):
        note.set_bbox({"facecolor": colour(said["bgcolor"]), "edgecolor": "none", "pad": 1.5})


def _title(figure: Any, title: str) -> None:
    if title:
        at = {"xycoords": figure.transFigure, "textcoords": "offset points", "annotation_clip": False}
        axes = figure.axes[0]
        axes.annotate(
            title, (0.0, 1.0), (0, 26), ha="left", va="bottom", weight="bold", size=10, parse_math=False, **at
        )


def _legend(figure: Any, entries: Sequence[LegendEntry]) -> None:
    """Below the chart."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    if not entries:
        return
    lines = {"solid": "-", "dashed": (0, (6, 4)), "dotted": (0, (1.5, 2.5))}
    handles: list[Any] = []
    for entry in entries:
        ink, look = colour(entry[0]), entry[1] if len(entry) == 3 else ""
        if look == "dot":
            handles.append(Line2D([], [], color=ink, marker="o", lw=0))
        elif look:
            handles.append(Line2D([], [], color=ink, ls=lines[look], lw=2))
        else:
            hatch = HATCHES[hatched(entry[0])]
            handles.append(Patch(facecolor=ink, edgecolor="#ffffff" if hatch else "#aab0b8", hatch=hatch, lw=0.5))
    names = [entry[-1] for entry in entries]
    columns = int(np.clip(110 / (max(map(len, names)) + 8), 1, 6))
    height_in = figure.get_figheight()
    drawn = figure.legend(
        handles,
        names,
        loc="upper left",
        bbox_to_anchor=(0.0, -0.5 / height_in),
        ncols=columns,
        frameon=False,
        fontsize=8.5,
    )
    for text in drawn.get_texts():
        text.set_parse_math(False)
