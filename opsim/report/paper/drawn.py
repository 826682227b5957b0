"""Figures 14, 15, 16 and 19, drawn from plain arrays (see ``emulator.judge.paper``)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.paper.drawing import dots, figure, legend, said, style, svg
from opsim.report.paper.write import Picture
from opsim.report.person import draw_person

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
