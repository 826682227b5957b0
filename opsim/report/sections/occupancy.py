"""Time spent on a floor, spread over a grid: nothing of it is lost, however much it is smoothed.

Where people spend their time: a heat map of presence on the floor, and the places and ways in a table.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, hypot
from typing import TYPE_CHECKING

import numpy as np

from opsim.report.material import Material
from opsim.report.numbers import listing
from opsim.report.page import Grid, Section, Svg, Words
from opsim.report.plot.floor_plan import FloorMap, FloorWays, floor_map, names_of, picture
from opsim.report.sections.common import Presence, presence, with_closed

if TYPE_CHECKING:
    from opsim.plan import Plan

Point = tuple[float, float]


@dataclass(frozen=True)
class HeatGrid:
    """Even cells over a floor. left_m, top_m : its corner; cell_m : wide and high of a cell; shape : rows, columns.

    Rows go from the top down.
    """

    left_m: float
    top_m: float
    cell_m: float
    shape: tuple[int, int]

    def cells(self, points: np.ndarray) -> np.ndarray:
        """(n,) flat numbers of the cells in which points (n, 2) in metres lie; beyond the edge those at it."""
        columns = np.clip(((points[:, 0] - self.left_m) / self.cell_m).astype(int), 0, self.shape[1] - 1)
        rows = np.clip(((self.top_m - points[:, 1]) / self.cell_m).astype(int), 0, self.shape[0] - 1)
        return rows * self.shape[1] + columns


def spread(grid: HeatGrid, lines: Sequence[tuple[Sequence[Point], float]], sigma_m: float) -> np.ndarray:
    """(rows, columns) of some quantity by cell. lines : corners of a line, or one point, and how much lies on it

    It lies evenly along its line, and is smoothed by a bell of this standard deviation, which ends at the floor's edge.
    """
    held = np.zeros(grid.shape[0] * grid.shape[1])
    for corners, amount in lines:
        cells = grid.cells(_along(corners, grid.cell_m))
        held += np.bincount(cells, minlength=held.size) * (amount / cells.size)
    down, across = (_bell(n, sigma_m / grid.cell_m) for n in grid.shape)
    return np.asarray(down @ held.reshape(grid.shape) @ across.T)


def _along(corners: Sequence[Point], step_m: float) -> np.ndarray:
    """(n, 2) points at about even distances along a line: the middles of its steps; of one point that point."""
    pieces = [_piece(a, b, step_m) for a, b in pairwise(corners) if a != b]
    return np.concatenate(pieces) if pieces else np.array([corners[0]], dtype=float)


def _piece(a: Point, b: Point, step_m: float) -> np.ndarray:
    n = ceil(hypot(b[0] - a[0], b[1] - a[1]) / step_m)
    part = (np.arange(n) + 0.5)[:, None] / n
    return np.array(a) + (np.array(b) - np.array(a)) * part


def _bell(n: int, sigma: float) -> np.ndarray:
    """(n, n) how much of each cell (column) comes to each other one (row); columns sum to 1."""
    apart = np.arange(n)[:, None] - np.arange(n)[None]
    share = np.exp(-0.5 * (apart / max(sigma, 1e-6)) ** 2)
    return share / share.sum(axis=0)


COLOURS = ("#e4eef5", "#c3d5e8", "#a0b8da", "#8c8fc3", "#8457a3", "#6a0f63")
"""The least first: the lightness falls evenly, so that they are told apart without colour too (after ColorBrewer)."""
CELL_PX, LEAST_SIGMA_M, LEAST_SIGMA_PX = 3.0, 0.4, 8.0
"""Of the grid, and how far presence is smoothed: half the width of somebody, or what can be seen."""
MOST_ROWS, MOST_SAID = 12, 3
MINUTE_S = 60.0


def occupancy_section(material: Material) -> Section | None:
    """None where no rows are kept, nobody is there, or all places are one."""
    if material.log is None or not material.plan.workers:
        return None
    layout, plan = material.loaded.scenario.layout, material.plan
    on, there = floor_map(plan, layout), presence(material.log, plan)
    if on is None or there.total <= 0:
        return None
    density, _ = density_of(there, plan, FloorWays(layout), on)
    levels = levels_of(float(density.max()))
    names = names_of(on, plan, layout)
    said = _sentence(there, names)
    drawn = Svg(
        picture(on, _bands(density, levels, on), said),
        said,
        legend=[(colour, _band(levels, at)) for at, colour in enumerate(COLOURS)],
        caption=_caption(on, layout.distance, plan),
        wide=True,
    )
    return Section("presence", "Where people spend their time", [Words(said), drawn, _table(there, names)], "Presence")


def density_of(there: Presence, plan: Plan, ways: FloorWays, on: FloorMap) -> tuple[np.ndarray, HeatGrid]:
    """(rows, columns) minutes an hour on each square metre, and the grid they are of.

    The mean over the floor, times its area, is all the time that people were on the floor.
    """
    left, bottom, right, top = on.corners
    cell_m = CELL_PX / on.px_per_m
    shape = (ceil((top - bottom) / cell_m - 1e-9), ceil((right - left) / cell_m - 1e-9))
    cells = HeatGrid(left, top, cell_m, shape)
    points = [((ways.places[name],), float(s)) for name, s in zip(plan.places, there.at_place) if s > 0]
    walked = [(ways.line(plan.places[a], plan.places[b]), s) for (a, b), s in there.on_way.items()]
    return spread(cells, [*points, *walked], sigma_m(on)) / MINUTE_S / cell_m**2, cells


def sigma_m(on: FloorMap) -> float:
    """Standard deviation of the bell by which presence is smoothed."""
    return max(LEAST_SIGMA_M, LEAST_SIGMA_PX / on.px_per_m)


def levels_of(most: float) -> list[float]:
    """Where each colour begins, about three times the one before; the last below the most there is."""
    steps = [base * 10.0**power for power in range(-9, 7) for base in (1.0, 3.0)]
    below = [float(f"{step:.3g}") for step in steps if step < most] or steps[:1]
    return below[-len(COLOURS) :]


def _bands(density: np.ndarray, levels: Sequence[float], on: FloorMap) -> Iterator[str]:
    """An area a level, each on the one before: what is at least so much."""
    left, bottom, right, top = on.corners
    (x, y), (most_x, most_y) = on.at((left, top)), on.at((right, bottom))
    across = [min(x + CELL_PX * n, most_x) for n in range(density.shape[1] + 1)]
    down = [min(y + CELL_PX * n, most_y) for n in range(density.shape[0] + 1)]
    for level, colour in zip(levels, COLOURS):
        path = "".join(
            f"M{across[begin]:.1f} {down[row]:.1f}H{across[end]:.1f}V{down[row + 1]:.1f}H{across[begin]:.1f}z"
            for row, begin, end in _runs(density >= level)
        )
        yield f'<path d="{path}" fill="{colour}" shape-rendering="crispEdges"/>'


def _runs(inside: np.ndarray) -> Iterator[tuple[int, int, int]]:
    """(row, from column, to column) of what is True."""
    edges = np.diff(np.pad(inside.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    starts, ends = np.argwhere(edges == 1), np.argwhere(edges == -1)
    yield from zip(starts[:, 0].tolist(), starts[:, 1].tolist(), ends[:, 1].tolist())


def _band(levels: Sequence[float], at: int) -> str:
    begin = f"{levels[at]:g}"
    return f"{begin} to {levels[at + 1]:g}" if at + 1 < len(levels) else f"{begin} or more min an hour on a m²"


def _sentence(there: Presence, names: Sequence[str]) -> str:
    order = np.argsort(-there.at_place, kind="stable")[:MOST_SAID].tolist()
    first = [f"{names[at]} ({_share(there.at_place[at], there)})" for at in order if there.at_place[at] > 0]
    said = f"Of the time that people are on the floor most is spent at {listing(first)}"
    return f"{said}; {_share(there.walking, there)} goes into walking between places." if there.walking else f"{said}."


def _share(seconds: float, there: Presence) -> str:
    share = 100 * seconds / there.total
    return "less than 1 %" if 0 < share < 0.95 else f"{share:.0f} %"


def _caption(on: FloorMap, distance: str, plan: Plan) -> str:
    key = f" Places: {on.key}." if on.numbered else ""
    first = ", first along x" if distance == "rectilinear" else ""
    hours = " Hours are those in which the floor is open or somebody is on duty." if with_closed(plan) else ""
    return (
        "Minutes an hour that people, all together, spend on each square metre, in the first replication: 60 is "
        f"somebody there all the time.{hours} Who stands at a place is taken to stand within about "
        f"{2 * sigma_m(on):.1f} m of it, and who walks goes along the ways of the layout{first}.{key}"
    )


def _table(there: Presence, names: Sequence[str]) -> Grid:
    rows = [
        (names[at], _minutes(there.at_place[at]), _share(there.at_place[at], there), _minutes(there.work[at]))
        for at in np.argsort(-there.at_place, kind="stable").tolist()
        if there.at_place[at] > 0
    ]
    if there.walking:
        rows.append(("on the way between places", _minutes(there.walking), _share(there.walking, there), "–"))
    shown = [*rows[:MOST_ROWS], *rows[-1:]] if len(rows) > MOST_ROWS + 1 else rows
    columns = ("Where", "min an hour, all together", "share", "of them at work")
    return Grid(columns, shown, "Where people spend their time", folded=True)


def _minutes(seconds: float) -> str:
    return f"{seconds / MINUTE_S:.1f}"
