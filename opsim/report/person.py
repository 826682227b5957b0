"""One stick figure: limbs as unbroken lines, the torso as a shape, the head as a circle."""

from __future__ import annotations

from typing import Any

import numpy as np

LEFT, RIGHT, TRUNK = "#0072B2", "#D55E00", "#33373d"
TORSO_GREY = "#cdd2d9"
HEAD_M, ROUND = 0.1, np.linspace(0.0, 2 * np.pi, 25)[:-1]
TORSO = ("left_shoulder", "right_shoulder", "right_hip", "left_hip")


def chains(skeleton: Any) -> list[list[int]]:
    """The bones as unbroken lines of joints: each runs from a branching joint to the next branch or to an end.

    The bones that only tie a hip or shoulder to the trunk are left out: the torso is drawn as a shape.
    """
    names, parents = list(skeleton.names), list(skeleton.parents)
    children = {j: [c for c, parent in enumerate(parents) if parent == j] for j in range(len(names))}
    tied = {names.index(name) for name in TORSO} if set(TORSO) <= set(names) else set()
    starts = [
        j for j, parent in enumerate(parents) if parent >= 0 and (len(children[parent]) > 1 or parents[parent] < 0)
    ]
    lines = []
    for joint in starts:
        line = [joint] if joint in tied else [parents[joint], joint]
        while len(children[line[-1]]) == 1:
            line.append(children[line[-1]][0])
        lines.append(line)
    return [line for line in lines if len(line) > 1]


def _limb(name: str) -> str:
    return LEFT if name.startswith("left_") else RIGHT if name.startswith("right_") else TRUNK


def draw_person(axes: Any, flat: np.ndarray, nearness: np.ndarray, at_m: float, skeleton: Any) -> None:
    """Far limbs first, each on a thin white rim, so that a near arm stands clear of the body behind it."""
    names = list(skeleton.names)
    x, z = flat[:, 0] + at_m, flat[:, 1]
    if set(TORSO) <= set(names) and np.isfinite(flat[[names.index(name) for name in TORSO]]).all():
        corners = [names.index(name) for name in TORSO]
        axes.fill(
            x[corners], z[corners], facecolor=TORSO_GREY, edgecolor=TORSO_GREY, lw=6, joinstyle="round", zorder=10
        )
    middle = nearness[skeleton.parents.index(-1)]
    for line in chains(skeleton):
        colour = _limb(names[line[-1]])
        away = float(np.mean(nearness[line]) - middle)
        layer = 11.0 if colour is TRUNK else (9.0 if away < 0 else 13.0) + np.clip(away, -0.9, 0.9)
        style = {"solid_capstyle": "round", "solid_joinstyle": "round"}
        axes.plot(x[line], z[line], color="white", lw=4.6, zorder=layer, **style)
        axes.plot(x[line], z[line], color=colour, lw=3.0, zorder=layer + 0.001, **style)
    head = names.index("head") if "head" in names else None
    if head is not None and np.isfinite(flat[head]).all():
        across, up = HEAD_M * np.cos(ROUND), HEAD_M * np.sin(ROUND)
        axes.fill(x[head] + across, z[head] + up, facecolor="#f4f5f7", edgecolor=TRUNK, lw=2.2, zorder=12)
