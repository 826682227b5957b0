"""Bars: stacked, beside or over each other, with their words and error bars."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.drawn.looks import DARK, HATCHES, POINT, Colour, colour, each, ink_on, words
from opsim.report.drawn.places import Scale

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
