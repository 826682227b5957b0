"""Panels of the import's picture: bones with their spread, gaps along time, and the way of the pelvis from above."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.palette import GRID, INK, MUTED
from opsim.report.person import LEFT, RIGHT, TRUNK

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
