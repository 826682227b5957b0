"""How people stand who perform nothing that is known: upright, arms hanging.

Where every joint of a worker is at a time: the definition that the page is compared with.

Made from the emulators' own performances, one at a time; the page decodes the packed columns instead.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from opsim.plan import Plan
from opsim.threads import one_blas_thread
from opsim.viewer.playback import bones_m
from opsim.viewer.routes import TURN_S, at_m, eased_heading, smooth, wrapped
from opsim.viewer.scene import Scene, Standing
from opsim.viewer.segments import is_gone
from opsim.viewer.skeletons import Tree, hung, path_of, tree_of, turned, vectors_of

_MIDDLE = {"spine": (0.02, 0, 1), "chest": (0.03, 0, 1), "neck": (0.03, 0, 1), "head": (0.25, 0, 1)}
_LEFT = {
    "clavicle": (0, 1, 0.2), "shoulder": (0, 0.75, 0.67), "elbow": (0, 0.2, -1), "wrist": (0.22, -0.02, -1),
    "hand": (0.22, -0.02, -1), "fingers": (0.22, -0.02, -1), "hip": (0, 0.89, -0.45), "knee": (0.02, 0.02, -1),
    "ankle": (-0.03, 0, -1), "toe": (0.92, 0.16, -0.35), "foot": (0.92, 0.16, -0.35), "heel": (-0.5, 0, -1),
}  # fmt: skip
"""Ahead, to the left, up; those of the right side are mirrored. Of the made library's people before they reach."""
NOBODYS = SimpleNamespace(names=("pelvis", "chest"), parents=(-1, 0))
"""The skeleton where nobody works."""


def standing(plan: Plan, replication: int) -> Standing:
    """The posture and each worker's bones: those with which he walks."""
    found = [bones_m(plan, replication, rank) for rank in range(len(plan.workers))]
    skeleton = found[0][0] if found else NOBODYS
    directions = standing_directions(tree_of(skeleton))
    return Standing(skeleton, directions, np.array([bones for _, bones in found]).reshape(len(found), len(directions)))


def standing_directions(tree: Tree) -> np.ndarray:
    """(B, 3) unit vectors of a skeleton's bones, by the names of the joints where they end; unknown ones point up."""
    names, parents = tree
    vectors = np.array([_vector(name) for name, parent in zip(names, parents) if parent >= 0], dtype=float)
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _vector(name: str) -> tuple[float, float, float]:
    side, _, limb = name.partition("_")
    if side in ("left", "right") and limb in _LEFT:
        x, y, z = _LEFT[limb]
        return x, y if side == "left" else -y, z
    return _MIDDLE.get(name, (0.0, 0.0, 1.0))


def root_height_m(directions: np.ndarray, bone_m: np.ndarray, skeleton: Any) -> float:
    """How high the root is when the lowest joint stands on the floor."""
    return float(-hung(directions, bone_m, np.zeros(3), tree_of(skeleton)[1])[:, 2].min())


@dataclass(frozen=True, eq=False)
class Body:
    """A posture on the floor: directions (B, 3) without heading, lengths (B,), root (3,) in metres, heading."""

    tree: Tree
    directions: np.ndarray
    bone_m: np.ndarray
    root_m: np.ndarray
    heading_rad: float

    @property
    def joints_m(self) -> np.ndarray:
        """(J, 3) metres, z up."""
        return hung(turned(self.directions, self.heading_rad), self.bone_m, self.root_m, self.tree[1])


def joints_m(scene: Scene, worker: int, time_s: float) -> np.ndarray | None:
    """(J, 3) joints of a worker in metres, z up, on the floor of the scene; None where he is not on it."""
    with one_blas_thread():
        body = body_at(scene, scene.segments.row(worker, time_s), time_s)
    return None if body is None else body.joints_m


def body_at(scene: Scene, row: int, time_s: float) -> Body | None:
    """The body in a segment at a time; None where nobody is on the floor."""
    segments = scene.segments
    if is_gone(segments.state[row]):
        return None
    if segments.performance[row] >= 0:
        return _performing(scene, row, time_s)
    return _standing(scene, row, time_s)


def _performing(scene: Scene, row: int, time_s: float) -> Body:
    """As the emulator has it at the own time of the performance, put where it is done."""
    segments = scene.segments
    share = _share(scene, row, time_s)
    own_s = segments.from_s[row] + share * (segments.to_s[row] - segments.from_s[row])
    block, place = scene.performed.one(segments.performance[row])
    some, at_s = block[np.array([place])], np.array([[own_s]])
    tree = tree_of(some.skeleton)
    joints = np.asarray(some.positions_m(times_s=at_s), dtype=float)[0, 0]
    own_yaw = float(path_of(some, at_s)[0, 0, 3])
    directions, bone_m = vectors_of(joints, tree[1])
    root = joints[tree[1].index(-1)]
    if segments.way[row] >= 0:
        level, heading = _on_way(scene, row, time_s, root)
    else:
        heading = float(segments.yaw_rad[row])
        level = turned(root, heading)[:2] + _moved(scene, row, share)
    own = turned(directions, -own_yaw)
    return Body(tree, own, bone_m, np.array([*level, root[2]]), heading + own_yaw)


def _on_way(scene: Scene, row: int, time_s: float, root_m: np.ndarray) -> tuple[np.ndarray, float]:
    """(the root's place (2,), the heading) of who has come so far on his way."""
    segments, ways, way = scene.segments, scene.ways, int(scene.segments.way[row])
    points = ways.points_m(way)
    whole_m = float(np.hypot(*np.diff(points, axis=0).T).sum())
    s_m = root_m[0] * whole_m / ways.own_m[way]
    point, heading = at_m(points, s_m)
    begun_s, left_s = time_s - segments.start_s[row], segments.end_s[row] - time_s
    yaw = float(ways.yaw_from[way]), float(ways.yaw_to[way])
    heading = eased_heading(heading, begun_s, left_s, begun_s + left_s, yaw)
    return point + root_m[1] * np.array([-np.sin(heading), np.cos(heading)]), heading


def _standing(scene: Scene, row: int, time_s: float) -> Body:
    """Upright; just come from what was done before, or about to do what comes next."""
    segments = scene.segments
    body = _upright(scene, row, _share(scene, row, time_s))
    ease_s = min(TURN_S, (segments.end_s[row] - segments.start_s[row]) / 3)
    begun_s, left_s = time_s - segments.start_s[row], segments.end_s[row] - time_s
    if begun_s < ease_s and (before := _before(scene, row)) is not None:
        return mixed(before, body, smooth(begun_s / ease_s))
    if left_s < ease_s and (after := _after(scene, row)) is not None:
        return mixed(after, body, smooth(left_s / ease_s))
    return body


def _before(scene: Scene, row: int) -> Body | None:
    """How the segment before ends, where that shows a body."""
    segments = scene.segments
    if row == segments.first[_worker(scene, row)] or is_gone(segments.state[row - 1]):
        return None
    if segments.performance[row - 1] < 0:
        return _upright(scene, row - 1, 1.0)
    return _performing(scene, row - 1, float(segments.end_s[row - 1]))


def _after(scene: Scene, row: int) -> Body | None:
    """How the segment after begins, where that is a performance."""
    segments = scene.segments
    if row + 1 == segments.first[_worker(scene, row) + 1] or segments.performance[row + 1] < 0:
        return None
    return _performing(scene, row + 1, float(segments.start_s[row + 1]))


def _upright(scene: Scene, row: int, share: float) -> Body:
    stands, bone_m = scene.standing, scene.standing.bone_m[_worker(scene, row)]
    height = root_height_m(stands.directions, bone_m, stands.skeleton)
    root = np.array([*_moved(scene, row, share), height])
    return Body(tree_of(stands.skeleton), stands.directions, bone_m, root, float(scene.segments.yaw_rad[row]))


def mixed(one: Body, other: Body, share: float) -> Body:
    """From one body (0) to another (1) of the same skeleton; of another skeleton: the other."""
    if one.tree != other.tree:
        return other
    directions = (1 - share) * one.directions + share * other.directions
    directions = directions / np.maximum(np.linalg.norm(directions, axis=-1, keepdims=True), 1e-12)
    heading = one.heading_rad + share * wrapped(other.heading_rad - one.heading_rad)
    bone_m = (1 - share) * one.bone_m + share * other.bone_m
    return Body(one.tree, directions, bone_m, (1 - share) * one.root_m + share * other.root_m, heading)


def _share(scene: Scene, row: int, time_s: float) -> float:
    """How much of a segment is over."""
    start_s, end_s = float(scene.segments.start_s[row]), float(scene.segments.end_s[row])
    return min(max((time_s - start_s) / (end_s - start_s), 0.0), 1.0)


def _moved(scene: Scene, row: int, share: float) -> np.ndarray:
    """(2,) the frame of a segment, as far as he has been carried."""
    s: Any = scene.segments
    return np.array([s.x_m[row] + share * s.dx_m[row], s.y_m[row] + share * s.dy_m[row]])


def _worker(scene: Scene, row: int) -> int:
    return int(np.searchsorted(scene.segments.first, row, side="right")) - 1
