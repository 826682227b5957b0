"""Tasks whose postures are known: performances that bend forward and come up again, and logs of them."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from plans import plan

from opsim.ergonomics.angles import CANONICAL
from opsim.streams import BLOCK
from tests.opsim.ergonomics.bodies import ABOVE_THE_HIPS, standing, turn

WORK = """
opsim: 1
name: made work
run: {horizon: 3600 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {bend: {fixed: 9 s}, count: {fixed: 5 s}, cook: {fixed: 5 s, automatic: true}}
stations: {s1: {at: a, tasks: [bend, count, cook], buffer: 1}}
products: {p: {route: [s1]}}
release: {kind: saturated}
workers: {ana: {skills: {s1: 1.0}}, ben: {skills: {s1: 1.25}}}
"""


class Skeleton(NamedTuple):
    """All that is asked of one."""

    names: tuple[str, ...] = CANONICAL


BEND, COOK, COUNT = 0, 1, 2


SKELETON = Skeleton()


def up_and_down(share):
    """Flexion in degrees at shares of a performance: 0, evenly to 90 in the middle, evenly back to 0."""
    return 90.0 * (1.0 - np.abs(2.0 * share - 1.0))


def leaning(flexion_deg):
    """(T, 21, 3) a standing body bent forward by each of some angles."""
    body, rows = standing(), [CANONICAL.index(name) for name in ABOVE_THE_HIPS]
    turns = np.array([turn([0, 1, 0], angle) for angle in flexion_deg])
    bodies = np.repeat(body[None], len(turns), axis=0)
    bodies[:, rows] = np.einsum("tij,rj->tri", turns, body[rows] - body[0]) + body[0]
    return bodies


@dataclass(frozen=True, eq=False)
class Bends:
    """Performances that cannot be taken apart: performance i has depth_i / 90 of the course of ``up_and_down``."""

    duration_s: np.ndarray
    depth_deg: np.ndarray
    skeleton: Skeleton = SKELETON
    course = staticmethod(up_and_down)

    @property
    def mark_s(self):
        return np.empty((len(self.duration_s), 0))

    def positions_m(self, n_times):
        shares = np.linspace(0.0, 1.0, n_times)
        return np.array([leaning(self.course(shares) * depth / 90.0) for depth in self.depth_deg])


class BendsApart(Bends):
    """The same, of which some can be taken."""

    def __getitem__(self, rows):
        return type(self)(self.duration_s[rows], self.depth_deg[rows], self.skeleton)


@dataclass(frozen=True)
class Bending:
    """A task model: every performance bends by ``depth_deg`` (BLOCK,) and lasts 9 s."""

    depth_deg: tuple[float, ...] = (90.0,) * BLOCK
    kind: type = BendsApart
    skeleton: Skeleton = SKELETON

    def mean_duration_s(self, worker=None):
        return 9.0

    def draw_worker(self, rng, body=None):
        return None

    def sample(self, n, rng, *, worker=None, condition=None):
        return self.kind(np.full(n, 9.0), np.array(self.depth_deg[:n]), self.skeleton)


def made_plan(model=None, **more):
    """The plan of ``WORK`` with a model for the task that bends."""
    found = plan(WORK)
    tasks = (replace(found.tasks[BEND], model=Bending() if model is None else model), *found.tasks[1:])
    return replace(found, tasks=tasks, **more)
