"""Panels of the import's picture: bones with their spread, gaps along time, and the way of the pelvis from above.

What was imported, at a glance: the body with its joints named, eight moments, the way it went, bones and gaps.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from opsim.report.plot.body import LEFT, RIGHT, TRUNK, draw_person
from opsim.report.plot.plotly import GRID, INK, MUTED

GAP = "#D55E00"


def draw_bones(axes: Any, take: Any) -> None:
    """A bar a bone, named after the joint where it ends, in cm; the line at its end is two standard deviations."""
    names = [name for name, parent in zip(take.names, take.parents) if parent >= 0]
    at = np.arange(len(names))[::-1]
    length, spread = 100 * np.nan_to_num(take.bone_m), 100 * np.nan_to_num(take.spread_m)
    axes.barh(at, length, color=[_colour(name) for name in names], height=0.72, alpha=0.85, zorder=2)
    axes.hlines(at, length - 2 * spread, length + 2 * spread, color="#111111", lw=1.6, zorder=3)
    for y, cm, sd in zip(at, length, spread):
        share = f"  ±{sd / cm:.1%}" if cm > 0 and sd / cm >= 5e-4 else ""
        axes.text(cm + 2 * sd + 0.8, y, f"{cm:.1f}{share}", va="center", size=7.5, color=MUTED)
    axes.set(yticks=at, ylim=(-0.6, len(names) - 0.4), xlim=(0, max(float((length + 2 * spread).max()), 1.0) * 1.25))
    axes.set_yticklabels(names, size=8, color=INK)
    _plain(axes, "bone lengths, cm (± standard deviation over the frames)")


def draw_times(axes: Any, take: Any) -> None:
    """Along time, for each joint, how fast it moves, the darker the faster, and in orange where it was not seen."""
    from matplotlib.colors import LinearSegmentedColormap

    missing = ~np.isfinite(take.positions_m).all(axis=-1)
    with np.errstate(invalid="ignore"):
        speed = np.linalg.norm(np.gradient(take.positions_m, 1 / take.rate_hz, axis=0), axis=-1)
    fastest = float(np.nanquantile(speed, 0.999)) if np.isfinite(speed).any() else 1.0
    fastest = max(fastest, 0.1)
    shades = LinearSegmentedColormap.from_list("speed", ["#f1f3f6", "#9db8d2", "#1f4e79", "#10263b"])
    colours = shades(np.clip(np.nan_to_num(speed) / fastest, 0, 1))[..., :3]
    colours[missing] = [int(GAP[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    seconds = (len(missing) - 1) / take.rate_hz
    n = len(take.names)
    place = (0, seconds, n - 0.5, -0.5)
    axes.imshow(_thinned(colours, missing).swapaxes(0, 1), aspect="auto", interpolation="nearest", extent=place)
    for edge in np.arange(n - 1) + 0.5:
        axes.axhline(edge, color="white", lw=0.8)
    labels = [f"{name}  {share:.1%}" if share else name for name, share in zip(take.names, missing.mean(axis=0))]
    axes.set_yticks(np.arange(n))
    axes.set_yticklabels(labels, size=8, color=INK)
    gaps = f"orange: gaps, {missing.mean():.2%}" if missing.any() else "no gaps"
    _plain(axes, f"speed of the joints along time, s (darkest: {fastest:.2g} m/s; {gaps})")
    axes.grid(visible=False)


def _thinned(colours: np.ndarray, missing: np.ndarray, most: int = 1500) -> np.ndarray:
    """At most ``most`` columns; a gap of one frame stays visible."""
    step = -(-len(colours) // most)
    if step == 1:
        return colours
    kept = colours[::step].copy()
    for joint in range(missing.shape[1]):
        for at in np.unique(np.flatnonzero(missing[:, joint]) // step):
            kept[at, joint] = [int(GAP[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return kept


def draw_path(axes: Any, take: Any) -> None:
    """The pelvis from above, a dot at its start, and an arrow forward at some moments; metres."""
    root = take.positions_m[:, take.parents.index(-1), :2]
    root = root - root[np.isfinite(root).all(axis=-1)][0]
    axes.plot(root[:, 0], root[:, 1], color=TRUNK, lw=1.6, zorder=3)
    hips = [take.positions_m[:, take.names.index(f"{side}_hip"), :2] for side in ("left", "right")]
    across = hips[0] - hips[1]
    forward = np.stack([across[:, 1], -across[:, 0]], axis=-1) / np.linalg.norm(across, axis=-1, keepdims=True)
    middle = (np.nanmin(root, axis=0) + np.nanmax(root, axis=0)) / 2
    half = max(float((np.nanmax(root, axis=0) - np.nanmin(root, axis=0)).max()) * 0.65, 0.3)
    for frame in np.unique(np.linspace(0, len(root) - 1, 8).astype(int)):
        end = root[frame] + 0.25 * half * forward[frame]
        if np.isfinite(end).all():
            style = {"arrowstyle": "->", "color": RIGHT, "lw": 1.2}
            axes.annotate("", xy=end, xytext=root[frame], arrowprops=style, zorder=4)
    axes.plot(0, 0, marker="o", ms=5, color=INK, zorder=5)
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), aspect="equal")
    _plain(axes, "pelvis from above, m (arrows: forward)")


def _colour(name: str) -> str:
    return LEFT if name.startswith("left_") else RIGHT if name.startswith("right_") else "#7d848d"


def _plain(axes: Any, title: str) -> None:
    axes.set_title(title, size=9, color=INK, loc="left")
    axes.tick_params(length=0, labelsize=8, labelcolor=MUTED)
    axes.grid(axis="x", color=GRID, lw=0.8, zorder=0)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_visible(False)


MOMENTS = 8
MOST_ROWS = 12
"""Takes of which moments are drawn; more are named."""
WIDE_IN = 12.0


@dataclass(frozen=True)
class Shown:
    """A take to draw: ``positions_m`` (T, J, 3), z up, nan where not seen; ``bone_m`` and ``spread_m`` (B,)."""

    title: str
    said: str
    names: tuple[str, ...]
    parents: tuple[int, ...]
    positions_m: np.ndarray
    rate_hz: float
    bone_m: np.ndarray
    spread_m: np.ndarray


def draw_import(shown: Sequence[Shown], ending: str) -> bytes:
    """The picture as PNG or SVG: the first take in full, of the others their moments from the side."""
    from matplotlib.figure import Figure

    shown = [replace(take, title=drawable(take.title), said=drawable(take.said)) for take in shown]
    first, rows = shown[0], shown[:MOST_ROWS]
    tall_in = [0.9, 4.6, *[2.05] * (1 + len(rows)), 0.16 * len(first.bone_m) + 1.0]
    figure = Figure(figsize=(WIDE_IN, sum(tall_in)), facecolor="white")
    edges = 1 - np.cumsum([0.0, *tall_in]) / sum(tall_in)
    _headline(figure, shown, edges[0], tall_in)
    _draw_first(figure, first, edges[2], edges[1] - edges[2])
    for row, (take, view) in enumerate([(first, "front"), *((take, "side") for take in rows)]):
        top, bottom = edges[row + 2], edges[row + 3]
        axes = figure.add_axes((0.02, bottom, 0.96, top - bottom))
        _draw_moments(axes, take, view, name=take.title if len(rows) > 1 and view == "side" else "")
    bottom, height = edges[-1], edges[-2] - edges[-1]
    share = 0.55 / sum(tall_in)
    draw_bones(figure.add_axes((0.12, bottom + share, 0.34, height - 1.6 * share)), first)
    draw_times(figure.add_axes((0.6, bottom + share, 0.37, height - 1.6 * share)), first)
    return _render(figure, ending)


def _headline(figure: Any, shown: Sequence[Shown], top: float, tall_in: Sequence[float]) -> None:
    inch = 1 / sum(tall_in)
    more = f" and {len(shown) - 1} more" if len(shown) > 1 else ""
    style = {"va": "top", "parse_math": False}
    figure.text(
        0.02, top - 0.14 * inch, _short(f"{shown[0].title}{more}", 110), size=14, weight="bold", color=INK, **style
    )
    for line, text in enumerate(shown[0].said.split("\n")[:2]):
        at = top - (0.44 + 0.19 * line) * inch
        figure.text(0.02, at, _short(text, 170 - 35 * line), size=9.5, color=MUTED, **style)
    figure.text(0.98, top - 0.74 * inch, "right limbs", ha="right", size=9, color=RIGHT, **style)
    figure.text(0.91, top - 0.74 * inch, "left limbs", ha="right", size=9, color=LEFT, **style)


def _draw_first(figure: Any, take: Shown, bottom: float, height: float) -> None:
    """The first whole frame, large, from the front with its joints named, and from the side; the way from above."""
    frames = _clear_frames(take, 1)
    if not frames:
        figure.text(0.5, bottom + height / 2, "no frame shows pelvis and both hips", ha="center", size=12, color=MUTED)
        return
    frame = frames[0]
    for left, wide, view, named in ((0.02, 0.46, "front", True), (0.48, 0.2, "side", False)):
        axes = figure.add_axes((left, bottom, wide, height))
        flat, near = _flat(take, frame, view)
        _stage(axes, flat)
        draw_person(axes, flat, near, 0.0, _body(take))
        words = {"ha": "center", "va": "top", "size": 9, "color": MUTED}
        axes.text(0.0, np.nanmin(flat[:, 1]) - 0.06, f"from the {view}, frame {frame}", **words)
        if named:
            _name_joints(axes, take, flat)
    draw_path(figure.add_axes((0.745, bottom + 0.13 * height, 0.235, 0.74 * height)), take)


def _stage(axes: Any, flat: np.ndarray) -> None:
    low, high = float(np.nanmin(flat[:, 1])), float(np.nanmax(flat[:, 1]))
    middle = (low + high) / 2
    half = max(0.62 * (high - low), 0.5)
    axes.set(ylim=(middle - half, middle + half), aspect="equal")
    axes.set_xlim(-1, 1)
    box = axes.get_position(original=True)
    inches = axes.figure.get_size_inches()
    ratio = box.width * inches[0] / (box.height * inches[1])
    axes.set_xlim(-half * ratio, half * ratio)
    axes.axis("off")


def _name_joints(axes: Any, take: Shown, flat: np.ndarray) -> None:
    """Names at both sides of the figure, each tied to its joint by a thin line, none over another."""
    half, (low, high) = axes.get_xlim()[1], axes.get_ylim()
    step = (high - low) / 27
    for sign in (-1, 1):
        own = [j for j in range(len(flat)) if np.isfinite(flat[j]).all() and _hand(take.names[j], flat[j, 0]) == sign]
        own.sort(key=lambda j: -flat[j, 1])
        heights = _apart([float(flat[j, 1]) for j in own], step, low + step, high - step)
        for joint, z in zip(own, heights):
            x = sign * 0.62 * half
            axes.plot([flat[joint, 0], x], [flat[joint, 1], z], color="#b4bac2", lw=0.6, zorder=30)
            axes.plot(*flat[joint], marker="o", ms=2.6, color=INK, zorder=31)
            style = {"ha": "left" if sign > 0 else "right", "va": "center", "size": 8, "color": INK}
            axes.text(x + sign * 0.02, z, take.names[joint], parse_math=False, **style)


def _hand(name: str, x: float) -> int:
    """On which side of the picture the name stands: seen from the front the left side is on the right."""
    if name.startswith("left_"):
        return 1
    return -1 if name.startswith("right_") else (1 if len(name) % 2 else -1)


def _apart(heights: list[float], step: float, low: float, high: float) -> list[float]:
    """The heights (falling) moved as little as needed to stand ``step`` apart within the picture."""
    placed: list[float] = []
    for z in heights:
        placed.append(min(z, high if not placed else placed[-1] - step))
    over = low - placed[-1] if placed else 0.0
    if over > 0:  # pushed out below: move up from the bottom
        for i in reversed(range(len(placed))):
            floor = low if i == len(placed) - 1 else placed[i + 1] + step
            placed[i] = max(placed[i], floor)
    return placed


def _draw_moments(axes: Any, take: Shown, view: str, name: str) -> None:
    """Eight figures at even times, each seen from its own front or side."""
    frames = _clear_frames(take, MOMENTS)
    axes.axis("off")
    if not frames:
        return
    flats = [_flat(take, frame, view) for frame in frames]
    height = max(float(np.nanmax(flat[:, 1])) for flat, _ in flats)
    floor = min(float(np.nanmin(flat[:, 1])) for flat, _ in flats)
    tall = (height - floor) * 1.5 + 0.1
    axes.set_ylim(floor - 0.14 * tall, floor + 0.86 * tall)
    box, inches = axes.get_position(original=True), axes.figure.get_size_inches()
    wide = tall * box.width * inches[0] / (box.height * inches[1])
    axes.set(xlim=(0, wide), aspect="equal")
    axes.plot([0, wide], [floor - 0.015] * 2, color="#aab0b8", lw=1.0, zorder=1)
    for i, (frame, (flat, near)) in enumerate(zip(frames, flats)):
        at = wide * (i + 0.5) / len(frames)
        draw_person(axes, flat, near, at, _body(take))
        words = {"ha": "center", "va": "top", "size": 8, "color": MUTED}
        axes.text(at, floor - 0.05 * tall, f"{frame / take.rate_hz:.2f} s", **words)
    said = f"{name}, from the {view}" if name else f"from the {view}"
    axes.text(0.0, floor + 0.85 * tall, _short(said, 120), ha="left", va="top", size=9, color=MUTED, parse_math=False)


def _flat(take: Shown, frame: int, view: str) -> tuple[np.ndarray, np.ndarray]:
    """(J, 2) in the picture about the pelvis, (J,) nearness to who looks, from the body's own front or right side."""
    posture = take.positions_m[frame]
    across = posture[take.names.index("left_hip")] - posture[take.names.index("right_hip")]
    left = across[:2] / np.linalg.norm(across[:2])
    forward = np.array([left[1], -left[0]])
    around = posture[:, :2] - posture[take.parents.index(-1), :2]
    right_of_picture, viewer = (left, forward) if view == "front" else (forward, -left)
    return np.stack([around @ right_of_picture, posture[:, 2]], axis=-1), around @ viewer


def _clear_frames(take: Shown, n: int) -> list[int]:
    """``n`` frames at even times, moved to the nearest that shows the most of the body."""
    seen = np.isfinite(take.positions_m).all(axis=-1)
    tied = [take.names.index(name) for name in ("pelvis", "left_hip", "right_hip") if name in take.names]
    usable = np.flatnonzero(seen[:, tied].all(axis=1))
    if len(usable) == 0:
        return []
    best = usable[seen[usable].sum(axis=1) == seen[usable].sum(axis=1).max()]
    wanted = np.linspace(0, len(seen) - 1, n) if n > 1 else np.zeros(1)
    return [int(best[np.abs(best - at).argmin()]) for at in wanted]


def _body(take: Shown) -> Any:
    return SimpleNamespace(names=take.names, parents=take.parents)


def drawable(text: str) -> str:
    """The text with ``?`` for characters that the picture's font has not; new lines stay."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    known = get_font(findfont(FontProperties())).get_charmap()
    return "".join(c if c == "\n" or (c.isprintable() and ord(c) in known) else "?" for c in text)


def _short(text: str, most: int) -> str:
    return text if len(text) <= most else text[: most - 1] + "…"


def _render(figure: Any, ending: str) -> bytes:
    import matplotlib

    stream = io.BytesIO()
    fixed: Any = {"svg.hashsalt": "opsim", "svg.fonttype": "path", "axes.edgecolor": GRID}
    metadata = {"Date": None, "Creator": "opsim"} if ending == "svg" else {"Software": "opsim"}
    with matplotlib.rc_context(fixed):
        figure.savefig(stream, format=ending, dpi=130, metadata=metadata)
    return stream.getvalue()
