"""What figures 14, 15 and 16 of the paper show: sub-sequences that the schemes draw, beside the recordings."""

from __future__ import annotations

import numpy as np

from emulator import sphere
from emulator.judge.distance import distances
from emulator.judge.mds import mds_of_two
from emulator.judge.paper.prepared import PWI, PaperClass
from emulator.judge.paper.tables import DRAWERS, SPAN_DIMS, SPANS

RECORDED = "recordings"
SPAN, DIMS, N_PEOPLE = SPANS[1], SPAN_DIMS[1], 7
Draws = dict[str, np.ndarray]


def draws_of(c: PaperClass) -> Draws:
    """The sub-sequences 180 to 240 (N, 61, B, 3): the recordings, and as many of each scheme."""
    drawn = {name: c.draw(name, len(c.aligned), SPAN, None if name == PWI else DIMS) for name in DRAWERS}
    return {RECORDED: c.aligned[:, SPAN]} | drawn


def people(c: PaperClass, draws: Draws) -> dict[str, np.ndarray]:
    """Figure 14: joints (7, J, 3), metres, root at 0, of the first sub-sequence of each, in a mean body."""
    bones = np.mean([motion.bone_length_m for motion in c.motions.motions], axis=0)
    at = np.linspace(0, len(range(*SPAN.indices(len(c.aligned[0])))) - 1, N_PEOPLE).astype(int)
    root = np.zeros((N_PEOPLE, 3))
    return {name: c.motions.skeleton.positions(made[0][at], bones, root) for name, made in draws.items()}


def scaled(draws: Draws) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Figure 15: recorded (N, 2) and drawn (N, 2) sub-sequences of each scheme in the plane."""
    real = draws[RECORDED]
    among, points = distances(real), {}
    for name, made in draws.items():
        if name != RECORDED:
            drawn, recorded, _ = mds_of_two(distances(made, real), distances(made), among)
            points[name] = recorded, drawn
    return points


def roughness_over_time(draws: Draws) -> Draws:
    """Figure 16: mean distance (60,) of successive postures, radians summed over bones."""
    return {name: sphere.distance(made[:, 1:], made[:, :-1]).mean(axis=0) for name, made in draws.items()}
