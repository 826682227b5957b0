"""Bars: stacked, beside or over each other, with their words and error bars.

Lines, marks, areas, fields, boxes and violins of plotly's language, on matplotlib's axes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.plot.matplotlib_axes import (
    DARK,
    HATCHES,
    POINT,
    STEPS,
    Colour,
    Scale,
    colour,
    dash,
    each,
    ink_on,
    symbol,
    words,
)

Trace = Mapping[str, Any]
LETTER = 0.6
"""Width of a letter, in sizes of it."""


def draw_bars(axes: Any, traces: Sequence[Trace], x: Scale, y: Scale, layout: Mapping[str, Any]) -> None:
    """All bars of one pair of axes."""
    mode, gap = layout.get("barmode", "group"), layout.get("bargap", 0.2)
    flat = [trace.get("orientation") == "h" for trace in traces]
    places = [(y if lies else x)(_along(trace, lies)) for trace, lies in zip(traces, flat)]
    room = _room(places) * (1.0 - gap)
    tops: dict[tuple[bool, float, bool], float] = {}
    for n, (trace, lies, at) in enumerate(zip(traces, flat, places)):
        scale, long = x if lies else y, trace["x" if lies else "y"]
        value = scale(long) if trace.get("base") is None else scale.lengths(long)
        value = np.nan_to_num(value) if mode in ("stack", "relative") else value
        wide = _numbers(trace.get("width"), at.size, room if mode != "group" else room / len(traces))
        start = at - wide / 2 if mode != "group" else at - room / 2 + n * room / len(traces)
        if trace.get("offset") is not None:
            start = at + _numbers(trace["offset"], at.size, 0.0)
        base = _base(trace, at, value, mode, tops, scale, lies)
        _draw(axes, trace, lies, start, wide, base, value)


def _along(trace: Trace, lies: bool) -> Sequence[Any]:
    along = trace.get("y" if lies else "x")
    return along if along is not None else list(range(len(trace["x" if lies else "y"])))


def _room(places: Sequence[np.ndarray]) -> float:
    """The least distance between two places."""
    apart = np.diff(np.unique(np.concatenate(places)))
    return float(apart[apart > 1e-9].min()) if (apart > 1e-9).any() else 1.0


def _numbers(said: Any, n: int, otherwise: float) -> np.ndarray:
    return np.array([otherwise if one is None else one for one in each(said, n)], float)


def _base(
    trace: Trace, at: np.ndarray, value: np.ndarray, mode: str, tops: dict[Any, float], scale: Scale, lies: bool
) -> np.ndarray:
    """Where each bar begins; in a stack on what is below it, upwards and downwards apart."""
    if trace.get("base") is not None:
        return scale(each(trace["base"], at.size))
    if mode not in ("stack", "relative"):
        return np.zeros(at.size)
    found = np.zeros(at.size)
    for i, (place, height) in enumerate(zip(at.tolist(), value.tolist())):
        key = (lies, place, height < 0)
        found[i] = tops.get(key, 0.0)
        tops[key] = found[i] + height
    return found


def _draw(
    axes: Any, trace: Trace, lies: bool, start: np.ndarray, wide: np.ndarray, base: np.ndarray, value: np.ndarray
) -> None:
    marker, n = trace.get("marker") or {}, value.size
    opacity = each(marker.get("opacity", trace.get("opacity", 1.0)), n)
    fill = [colour(one, o) for one, o in zip(each(marker.get("color", "#0072B2"), n), opacity)]
    line, pattern = marker.get("line") or {}, marker.get("pattern") or {}
    drawn = (
        axes.barh(start, value, wide, base, align="edge", color=fill, zorder=2)
        if lies
        else axes.bar(start, value, wide, base, align="edge", color=fill, zorder=2)
    )
    edges, hatches = each(line.get("color"), n), each(pattern.get("shape", ""), n)
    for patch, edge, hatch in zip(drawn, edges, hatches):
        patch.set_linewidth(0.0 if edge is None else np.max(line.get("width", 1)) * POINT)
        if edge is not None:
            patch.set_edgecolor(colour(edge))
        if hatch:
            patch.set_hatch(HATCHES[hatch])
            patch.set_edgecolor(colour(pattern.get("fgcolor", "#ffffff")))
    _texts(axes, trace, lies, start + wide / 2, base, value, fill)
    for key in ("error_x", "error_y"):
        if trace.get(key):
            place, end = start + wide / 2, base + value
            draw_errors(axes, key, trace[key], *((end, place) if lies else (place, end)))


def _texts(
    axes: Any,
    trace: Trace,
    lies: bool,
    place: np.ndarray,
    base: np.ndarray,
    value: np.ndarray,
    fills: Sequence[Colour | None],
) -> None:
    if trace.get("textposition") == "none" or trace.get("text") is None:
        return
    outside = trace.get("textposition") == "outside"
    font = {**(trace.get("textfont") or {}), **(trace.get("outsidetextfont" if outside else "insidetextfont") or {})}
    inks = each(font["color"], value.size) if "color" in font else [DARK if outside else ink_on(one) for one in fills]
    for text, at, low, long, ink in zip(each(trace["text"], value.size), place, base, value, inks):
        along = low + long if outside else low + long / 2
        look = {"ha": "left" if outside and lies else "center", "va": "bottom" if outside and not lies else "center"}
        spot = (along, at) if lies else (at, along)
        if text and np.isfinite(along):
            size = font.get("size", 12) * POINT
            note = axes.text(
                *spot, words(text), color=colour(ink), size=size, zorder=6, parse_math=False, clip_on=True, **look
            )
            if not outside and lies:
                note.room = (low, low + long)


def leave_out(axes: Any) -> None:
    """Words that are wider than the bar they stand in, now that ranges are known."""
    for note in list(axes.texts):
        if hasattr(note, "room"):
            low, high = (axes.transData.transform((end, 0.0))[0] for end in note.room)
            wide = LETTER * note.get_size() * len(note.get_text()) * axes.get_figure().dpi / 72.0
            if wide > abs(high - low):
                note.remove()


def draw_errors(axes: Any, key: str, said: Mapping[str, Any], x: np.ndarray, y: np.ndarray) -> None:
    """Error bars of what ``array`` and ``arrayminus`` say, in the values' own unit."""
    if said.get("visible") is False:
        return
    above = np.array([np.nan if one is None else one for one in said["array"]], float)
    minus = said.get("arrayminus")
    below = above if minus is None else np.array([np.nan if one is None else one for one in minus], float)
    thick, cap = said.get("thickness", 2) * POINT, said.get("width", 4) * POINT
    axes.errorbar(
        x,
        y,
        **{key.replace("error_", "") + "err": np.stack([below, above])},
        fmt="none",
        ecolor=colour(said.get("color", "#22262b")),
        elinewidth=thick,
        capsize=cap,
        capthick=thick,
        zorder=5,
    )


TEXTS = {"top": (0, 1, "bottom"), "bottom": (0, -1, "top"), "middle": (0, 0, "center")}
SIDES = {"left": (-1, "right"), "right": (1, "left"), "center": (0, "center")}


def draw_scatter(axes: Any, trace: Trace, x: Scale, y: Scale, before: tuple[np.ndarray, np.ndarray] | None) -> None:
    """before : the points of the trace before, for an area that reaches to it"""
    at = x(trace["x"]), y(trace["y"])
    mode, line = trace.get("mode", "lines"), trace.get("line") or {}
    own = colour(line.get("color", (trace.get("marker") or {}).get("color", "#0072B2")) if _one(trace) else "#0072B2")
    opacity, step = trace.get("opacity", 1.0), STEPS[line.get("shape", "linear")]
    if trace.get("fill", "none") != "none":
        _area(axes, trace, at, before)
    if "lines" in mode and line.get("width", 2):
        axes.plot(
            *at,
            color=own,
            lw=line.get("width", 2) * POINT,
            ls=dash(line.get("dash")),
            drawstyle=step,
            alpha=opacity,
            zorder=3,
        )
    if "markers" in mode:
        _marks(axes, trace.get("marker") or {}, at, opacity)
    if "text" in mode and trace.get("text") is not None:
        _mark_texts(axes, trace, at)
    for key in ("error_x", "error_y"):
        if trace.get(key):
            draw_errors(axes, key, trace[key], *at)


def _one(trace: Trace) -> bool:
    """Whether one colour holds for all points."""
    return not isinstance((trace.get("marker") or {}).get("color"), list | tuple)


def _area(
    axes: Any, trace: Trace, at: tuple[np.ndarray, np.ndarray], before: tuple[np.ndarray, np.ndarray] | None
) -> None:
    fill = colour(trace.get("fillcolor") or (trace.get("line") or {}).get("color", "#0072B2"))
    if trace.get("fillcolor") is None and fill is not None:
        fill = (*fill[:3], 0.5 * fill[3])
    look = {"color": fill, "lw": 0, "zorder": 1.5}
    x, y = _stepped(*at, (trace.get("line") or {}).get("shape", "linear"))
    if trace["fill"] == "toself":
        gaps = np.isnan(x) | np.isnan(y)
        for part in np.split(np.arange(x.size), np.flatnonzero(gaps)):
            axes.fill(x[part[~gaps[part]]], y[part[~gaps[part]]], **look)
    elif trace["fill"] == "tozeroy":
        axes.fill_between(x, y, 0.0, **look)
    elif trace["fill"] == "tozerox":
        axes.fill_betweenx(y, x, 0.0, **look)
    elif trace["fill"] == "tonexty" and before is not None:
        axes.fill_between(x, y, np.interp(x, *before), **look)
    else:
        raise ValueError(f"no drawing of an area {trace['fill']!r}")


def _stepped(x: np.ndarray, y: np.ndarray, shape: str) -> tuple[np.ndarray, np.ndarray]:
    """With the corners of a line that goes in steps."""
    if shape == "linear" or x.size < 2:
        return x, y
    if shape == "hv":
        return np.repeat(x, 2)[1:], np.repeat(y, 2)[:-1]
    if shape == "vh":
        return np.repeat(x, 2)[:-1], np.repeat(y, 2)[1:]
    raise ValueError(f"no drawing of an area with steps {shape!r}")


def _marks(axes: Any, marker: Mapping[str, Any], at: tuple[np.ndarray, np.ndarray], opacity: float) -> None:
    n, line = at[0].size, marker.get("line") or {}
    inks = [colour(one, opacity * marker.get("opacity", 1.0)) for one in each(marker.get("color", "#0072B2"), n)]
    sizes = np.array(each(marker.get("size", 6), n), float) * POINT
    kinds = np.array([str(one) for one in each(marker.get("symbol", "circle"), n)])
    edges = each(line.get("color"), n)
    for kind in dict.fromkeys(kinds.tolist()):
        of = np.flatnonzero(kinds == kind)
        mark, filled = symbol(kind)
        thin = mark in "|_"
        rims = [inks[i] if edges[i] is None or not filled or thin else colour(edges[i]) for i in of]
        wide = line.get("width", 0 if filled and not thin else 1.5)
        axes.scatter(
            at[0][of],
            at[1][of],
            s=sizes[of] ** 2,
            marker=mark,
            facecolors=[inks[i] for i in of] if filled or thin else "none",
            **({} if thin else {"edgecolors": rims}),
            linewidths=(float(np.max(wide)) if np.max(wide) else 0.0) * POINT if not thin else 1.5,
            zorder=4,
        )


def _mark_texts(axes: Any, trace: Trace, at: tuple[np.ndarray, np.ndarray]) -> None:
    font = trace.get("textfont") or {}
    n = at[0].size
    for x, y, text, where, ink in zip(
        *at,
        each(trace["text"], n),
        each(trace.get("textposition", "middle center"), n),
        each(font.get("color", "#22262b"), n),
    ):
        up, side = where.split() if " " in where else (where, "center")
        _, dy, va = TEXTS[up]
        dx, ha = SIDES[side]
        if text and np.isfinite(x) and np.isfinite(y):
            axes.annotate(
                words(text),
                (x, y),
                (4 * dx, 4 * dy),
                textcoords="offset points",
                ha=ha,
                va=va,
                color=colour(ink),
                size=font.get("size", 12) * POINT,
                zorder=6,
                parse_math=False,
            )


def draw_heatmap(axes: Any, trace: Trace, x: Scale, y: Scale) -> None:
    """A field of colours; nothing where nothing is known."""
    from matplotlib.colors import LinearSegmentedColormap

    z = np.array([[np.nan if value is None else value for value in row] for row in trace["z"]], float)
    stops: Any = [(share, colour(said)) for share, said in trace["colorscale"]]
    known = z[np.isfinite(z)]
    low = trace.get("zmin", known.min() if known.size else 0.0)
    high = trace.get("zmax", known.max() if known.size else 1.0)
    edges = [
        _edges(scale(trace[key]) if trace.get(key) is not None else np.arange(n, dtype=float), n)
        for scale, key, n in ((x, "x", z.shape[1]), (y, "y", z.shape[0]))
    ]
    gap = max(trace.get("xgap", 0), trace.get("ygap", 0)) * POINT
    axes.pcolormesh(
        *edges,
        np.ma.masked_invalid(z),
        cmap=LinearSegmentedColormap.from_list("said", stops),
        vmin=low,
        vmax=high if high > low else low + 1.0,
        edgecolors="white" if gap else "face",
        linewidth=gap,
        zorder=1,
    )


def _edges(at: np.ndarray, n: int) -> np.ndarray:
    """Of n cells: plotly says their edges, or their middles."""
    if at.size == n + 1:
        return at
    if n == 1:
        return np.array([at[0] - 0.5, at[0] + 0.5])
    inner = (at[1:] + at[:-1]) / 2
    return np.concatenate([[2 * at[0] - inner[0]], inner, [2 * at[-1] - inner[-1]]])


def draw_violin(axes: Any, trace: Trace, x: Scale, y: Scale) -> None:
    """How raw values are spread, mirrored or on one side; at the place ``x0`` or ``y0``."""
    lies = trace.get("orientation") == "h" or trace.get("y") is None
    values = (x if lies else y)([value for value in trace["x" if lies else "y"] if value is not None])
    place = float((y if lies else x).number(trace.get("y0" if lies else "x0", 0)))
    wide = trace.get("width") or 0.8
    if not values.size or np.ptp(values) == 0:
        return
    drawn = axes.violinplot(
        values, [place], orientation="horizontal" if lies else "vertical", widths=wide, showextrema=False, points=120
    )
    line = trace.get("line") or {}
    side = trace.get("side", "both")
    for body in drawn["bodies"]:
        body.set(facecolor=colour(trace.get("fillcolor", "#0072B2")), alpha=None, zorder=2)
        body.set(edgecolor=colour(line.get("color")), linewidth=line.get("width", 1) * POINT)
        if side != "both":
            corners = body.get_paths()[0].vertices
            at = corners[:, 1 if lies else 0]
            corners[:, 1 if lies else 0] = np.maximum(at, place) if side == "positive" else np.minimum(at, place)


def draw_box(axes: Any, trace: Trace, x: Scale, y: Scale) -> None:
    """Boxes of quantiles that are given, ends of whiskers too."""
    if trace.get("q1") is None:
        raise ValueError("no drawing of boxes whose quantiles are not given")
    lies = trace.get("orientation") == "h"
    places = (y if lies else x)(trace["y" if lies else "x"])
    of = x if lies else y
    found = zip(*(of(trace[key]) for key in ("lowerfence", "q1", "median", "q3", "upperfence")))
    stats = [dict(zip(("whislo", "q1", "med", "q3", "whishi"), map(float, one)), fliers=[]) for one in found]
    ink = colour((trace.get("line") or {}).get("color", "#22262b"))
    line = {"color": ink, "linewidth": 1.2}
    axes.bxp(
        stats,
        positions=places,
        widths=trace.get("width") or 0.5,
        orientation="horizontal" if lies else "vertical",
        manage_ticks=False,
        patch_artist=True,
        boxprops={"facecolor": colour(trace.get("fillcolor", "#ffffff")), "edgecolor": ink},
        medianprops=line,
        whiskerprops=line,
        capprops=line,
        zorder=3,
    )
