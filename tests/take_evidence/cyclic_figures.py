"""Pictures of cyclic motion, as figures 1 to 3 of Remillard & Kry (2010), and how far draws are from the recording."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from emulator.skeleton import standard_skeleton
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED

COLOURS = {0: "#D55E00", 1: "#0072B2", 2: "#E69F00"}


def reduction(energy: np.ndarray, errors_cm: list[np.ndarray], path: Path) -> None:
    """Cumulative energy and the error at the toes, with two standard deviations, by the number of components."""
    import matplotlib.pyplot as plt

    figure, left = plt.subplots(figsize=(9, 4.5), layout="constrained")
    number = np.arange(1, len(energy) + 1)
    left.plot(number, 100 * energy, "o-", color=ACCENT)
    left.set(xlabel="components", ylabel="cumulative energy [%]", ylim=(0, 102), xticks=number)
    left.yaxis.label.set_color(ACCENT)
    right = left.twinx()
    mean, spread = [one.mean() for one in errors_cm], [2 * one.std() for one in errors_cm]
    right.errorbar(number, mean, yerr=spread, fmt="s-", color=COLOURS[0], capsize=3)
    right.set_ylabel("error at the toes [cm], mean and 2 SD")
    right.set_ylim(0)
    right.yaxis.label.set_color(COLOURS[0])
    left.grid(color=GRID)
    left.set_title("What a few components keep of a walk", color=INK)
    _save(figure, path)


def walking(walks: Any, path: Path, n: int) -> None:
    """A pose, the trajectory coloured by state, and poses inferred without and with switching."""
    start = walks.z[0][100:101]
    alone = walks.single.sample(start, n, np.random.default_rng(7), noise=False)[0][0]
    along, state = walks.switching.sample(start, n, np.random.default_rng(7))
    joints = walks.takes[0].positions_m[60]
    titles = ("a pose", "recorded", "one process, mean", "switching, drawn")
    words = {1: "left foot bears", 2: "right foot bears"}
    few = list(zip(walks.z[:4], walks.state[:4]))
    _four(joints, walks.skeleton, few, alone, along[0], state[0], titles, words, path)


def rowing(take: np.ndarray, z: list[np.ndarray], states: list[np.ndarray], paths: Any, path: Path, n: int) -> None:
    """The same for made rowing; both drawn."""
    words = {0: "pause", 1: "moving, slower", 2: "moving, faster"}
    alone, along, state = paths["single"][0][0, :n], paths["switching"][0][0, :n], paths["switching"][1][0, :n]
    titles = ("a pose", "made", "one process, drawn", "switching, drawn")
    _four(take[20], standard_skeleton(), list(zip(z, states)), alone, along, state, titles, words, path)


def manifold(shown: Any, path: Path) -> None:
    """Distance from the nearest training pose through time, drawn and two controls, with the bound."""
    import matplotlib.pyplot as plt

    away, controls, bound = shown
    figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
    axes.semilogy(np.maximum(away, 1e-3), color=ACCENT, lw=0.7, label="switching, drawn")
    for (name, values), colour in zip(controls.items(), (COLOURS[0], COLOURS[2])):
        axes.semilogy(np.maximum(values, 1e-3), color=colour, lw=0.9, label=f"control: {name}")
    axes.axhline(bound, color=INK, ls="--", label="farthest recorded pose from the other takes")
    axes.set(xlabel="pose", ylabel="distance to the nearest recorded pose\n[spreads of the first component]")
    axes.grid(color=GRID)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, ncols=4)
    _save(figure, path)


def _four(
    joints: np.ndarray, skeleton: Any, recorded: Any, alone: np.ndarray, along: np.ndarray, state: np.ndarray,
    titles: tuple[str, ...], words: dict[int, str], path: Path,
) -> None:  # fmt: skip
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(15, 4.4), layout="constrained")
    body = figure.add_subplot(1, 4, 1, projection="3d")
    for parent, child in skeleton.edges:
        body.plot(*joints[[parent, child]].T, color=MUTED if "left" in skeleton.names[child] else INK, lw=2.5)
    _equal(body, joints)
    body.view_init(8, -60)
    whole = np.concatenate([z for z, _ in recorded])
    for place, (title, paths) in enumerate(zip(titles[1:], (recorded, [(alone, None)], [(along, state)])), start=2):
        axes = figure.add_subplot(1, 4, place, projection="3d")
        for z, which in paths:
            axes.plot(*z.T, color=GRID if which is not None else MUTED, lw=0.5)
            for one in words if which is not None else ():
                axes.scatter(*z[which == one].T, s=3, color=COLOURS[one], label=words[one], depthshade=False)
        _equal(axes, whole)
        axes.view_init(28, -60)
        axes.set_title(title, color=INK)
        if place == 2:
            handles = dict(zip(*reversed(axes.get_legend_handles_labels())))
            figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=3, frameon=False, markerscale=4)
    body.set_title(titles[0], color=INK)
    _save(figure, path)


def _equal(axes: Any, points: np.ndarray) -> None:
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = (low + high) / 2, (high - low).max() / 2 * 1.05
    axes.set(xlim=middle[0] + [-half, half], ylim=middle[1] + [-half, half], zlim=middle[2] + [-half, half])
    axes.tick_params(labelsize=6, colors=MUTED)


def _save(figure: Any, path: Path) -> None:
    import matplotlib.pyplot as plt

    figure.savefig(path, dpi=110)
    plt.close(figure)
