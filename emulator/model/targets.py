"""Targets: where a joint is to be at a mark, and where it is in a performance with given joint coordinates.

Places are in the person's own frame at the first moment: the middle of the ankles is the origin, the floor is 0, ahead
is where the pelvis faces, and aside is positive to the left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property

import numpy as np

from emulator.geometry.warps import coordinates_to_clock
from emulator.model.decoding import along, control_points
from emulator.model.joint_coordinates import inverse_all
from emulator.model.joint_law import JointLaw
from emulator.model.performances import MotionPerformances, turned
from emulator.motion import turn
from emulator.skeleton import Skeleton, canonical_name

HANDS = "hands"
"""The middle of both wrists."""
WRISTS = ("left_wrist", "right_wrist")
AXES = ("ahead_m", "aside_m", "height_m")
"""The order of the three axes of a place."""
ANKLES = ("left_ankle", "right_ankle")
STRETCH = 1.15
"""Nobody is asked to reach higher than so many times the longest recorded body, arm up."""
AT_ONCE = 512


@dataclass(frozen=True)
class Target:
    """Where a joint is to be at a mark, in metres in the person's own frame; what is None is drawn as recorded.

    joint    : of the skeleton, or "hands": the middle of both wrists
    mark     : its name, or its number from 0
    height_m : above the floor; ahead_m : ahead of the middle of the ankles as they stood at the start; aside_m : to the
               left of it
    Raises ValueError where nothing is asked for, or what is asked for is no finite number or below the floor.
    """

    joint: str
    mark: str | int
    height_m: float | None = None
    ahead_m: float | None = None
    aside_m: float | None = None

    def __post_init__(self) -> None:
        asked = {name: getattr(self, name) for name in AXES if getattr(self, name) is not None}
        wrong = [
            f"{self}: {name}: found {value!r}, expected metres"
            for name, value in asked.items()
            if isinstance(value, bool) or not isinstance(value, (int, float, np.number)) or not np.isfinite(value)
        ]
        if not asked:
            wrong.append(f"{self}: found no place, expected one or more of height_m, ahead_m, aside_m")
        if not wrong and self.height_m is not None and self.height_m < 0:
            wrong.append(f"{self}: height_m: found {self.height_m:g} m, which is below the floor; expected 0 or more")
        if wrong:
            raise ValueError("\n".join(wrong))

    def __str__(self) -> str:
        return f"target of {self.joint} at {self.mark}"

    @property
    def place(self) -> tuple[float | None, ...]:
        """What is asked for, in the order of ``AXES``."""
        return tuple(getattr(self, name) for name in AXES)


def joints_of(task: str, skeleton: Skeleton, joint: str) -> tuple[int, ...]:
    """Numbers of the joints whose middle a target's joint is. Raises ValueError with the nearest name."""
    names = WRISTS if joint == HANDS else (joint,)
    found = [name if name in skeleton.names else _canonical(name) for name in names]
    if all(name in skeleton.names for name in found):
        return tuple(skeleton.names.index(name) for name in found)
    known = [*skeleton.names, *([HANDS] if set(WRISTS) <= set(skeleton.names) else [])]
    raise ValueError(f"{task}: no joint {joint!r}; {_hint(joint, known)}")


def mark_number(task: str, names: Sequence[str], mark: str | int) -> int:
    """Number of a mark by name or number. Raises ValueError for a task without marks or one that it does not have."""
    if not names:
        raise ValueError(f"{task}: found mark {mark!r}, but the task has no marks; a place needs a moment")
    if isinstance(mark, str) and mark in names:
        return names.index(mark)
    if not isinstance(mark, (str, bool)) and 0 <= int(mark) < len(names):
        return int(mark)
    raise ValueError(f"{task}: no mark {mark!r}; {_hint(str(mark), list(names))}")


def _canonical(name: str) -> str:
    try:
        return canonical_name(name)
    except ValueError:
        return name


def _hint(word: str, known: Sequence[str]) -> str:
    near = get_close_matches(word, known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"


def checked(model: JointLaw, targets: Sequence[Target]) -> tuple[Target, ...]:
    """The targets, if the model can be asked for them. Raises ValueError with all mistakes, each in a line."""
    wrong, seen = [], set()
    for target in targets:
        if not isinstance(target, Target):
            wrong.append(f"{model.task}: found {target!r}, expected a Target")
            continue
        try:
            key = joints_of(model.task, model.skeleton, target.joint), _mark(model, target.mark)
        except ValueError as why:
            wrong.append(str(why))
            continue
        if key in seen:
            wrong.append(f"{model.task}: {target} is given twice")
        seen.add(key)
        most_m = highest_m(model, key[0])
        if target.height_m is not None and target.height_m > most_m:
            wrong.append(
                f"{model.task}: {target}: height_m: found {target.height_m:g} m, above anybody's reach; "
                f"expected at most {most_m:.2f} m"
            )
    if not targets:
        wrong.append(f"{model.task}: found no target, expected one or more")
    if wrong:
        raise ValueError("\n".join(wrong))
    return tuple(targets)


def _mark(model: JointLaw, mark: str | int) -> int:
    return mark_number(model.task, model.mark_names, mark)


def highest_m(model: JointLaw, joints: Sequence[int]) -> float:
    """How high nobody gets: all bones from an ankle up and out to the joint in one line, of the longest recorded body.

    On a skeleton without ankles: from the root, which is no bound and told as infinite.
    """
    skeleton = model.skeleton
    if not set(ANKLES) <= set(skeleton.names):
        return float("inf")
    known = model.workforce.smoothed
    z = model.workforce.effects if known is None else known.scores
    length_m = model.bone_length_m(z).max(axis=0)
    to_joint = skeleton.lineage(joints[0])
    leg = skeleton.lineage(skeleton.names.index(ANKLES[0]))
    return float(STRETCH * (length_m[to_joint].sum() + length_m[leg].sum() + 0.1))


@dataclass(frozen=True, eq=False)
class HandPlaces:
    """h(z): where joints are at marks, G pairs of them, from joint coordinates, by a few frames of the decoder.

    The root's path is that of the coordinates, without what feet correct. joints : numbers of the joints of each pair;
    marks : (G,) numbers
    """

    model: JointLaw
    joints: tuple[tuple[int, ...], ...]
    marks: tuple[int, ...]

    @classmethod
    def of(cls, model: JointLaw, targets: Sequence[Target]) -> HandPlaces:
        """Where the targets' joints are at the targets' marks."""
        joints = tuple(joints_of(model.task, model.skeleton, target.joint) for target in targets)
        return cls(model, joints, tuple(_mark(model, target.mark) for target in targets))

    def __call__(self, z: np.ndarray, scale: float | np.ndarray = 1.0, turns: np.ndarray | None = None) -> np.ndarray:
        """z (n, K), factor on every bone (or (n,)), turns of bones ((n,) B, 3) -> (n, G, 3) m ahead, aside, high."""
        z, scale = np.asarray(z), np.broadcast_to(scale, len(z))
        turns = np.zeros((0, 3)) if turns is None else turns
        turns = np.broadcast_to(turns, (len(z), *turns.shape[-2:]))
        blocks = [slice(start, start + AT_ONCE) for start in range(0, len(z), AT_ONCE)]
        found = [self._block(z[b], scale[b], turns[b]) for b in blocks]
        return np.concatenate([np.zeros((0, len(self.marks), 3)), *found])

    def clock(self, z: np.ndarray) -> np.ndarray:
        """(n, G) places of the marks on the common clock, in cells."""
        model = self.model
        clock = coordinates_to_clock(inverse_all(model.mark_margins, model.scale.raw(z, "marks")))
        return np.asarray(clock[:, list(self.marks)] * (model.n_times - 1))

    def decoded(self, performances: MotionPerformances) -> np.ndarray:
        """(n, G, 3) the same of performances as they are decoded, feet and all."""
        start_s = np.zeros((len(performances), 1))
        times_s = np.concatenate([start_s, performances.mark_s[:, list(self.marks)]], axis=1)
        return self.seen(performances.positions_m(times_s), performances.path(start_s)[:, 0, 3])

    def seen(self, positions_m: np.ndarray, yaw_rad: np.ndarray) -> np.ndarray:
        """(n, G, 3) from joints (n, 1 + G, J, 3) at the start and at each mark, and the heading (n,) at the start."""
        origin = positions_m[:, 0, self.stand].mean(axis=1)
        origin[:, 2] = 0.0
        hands = [positions_m[:, 1 + g, list(joints)].mean(axis=1) for g, joints in enumerate(self.joints)]
        return turn(np.stack(hands, axis=1) - origin[:, None], -np.asarray(yaw_rad)[:, None])

    @cached_property
    def stand(self) -> list[int]:
        """Joints that say where somebody stands: the ankles, or the root."""
        names = self.model.skeleton.names
        ankles = [names.index(name) for name in ANKLES if name in names]
        return ankles if len(ankles) == len(ANKLES) else [self.model.skeleton.root]

    def _block(self, z: np.ndarray, scale: np.ndarray, turns: np.ndarray) -> np.ndarray:
        model = self.model
        place = np.concatenate([np.zeros((len(z), 1)), self.clock(z)], axis=1)
        flat = _along(self.posture_control, model.scale.raw(z, "posture"), place)
        lengths = model.bone_length_m(z) * scale[:, None]
        path = self._ridden(z, lengths, place) if model.rides else self._path(z, lengths, place)
        directions = turn(turned(model.flatten.inverse(flat), turns), path[..., 3:])
        return self.seen(model.skeleton.positions(directions, lengths[:, None], path[..., :3]), path[:, 0, 3])

    def _path(self, z: np.ndarray, lengths: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(n, S, 4) root and heading at places (n, S)."""
        path = _along(self._root_control, self.model.scale.raw(z, "root"), place)
        path[..., :3] *= self.model.channel.leg_m(lengths)[:, None, None]
        return path

    def _ridden(self, z: np.ndarray, lengths: np.ndarray, place: np.ndarray) -> np.ndarray:
        """The same in libraries of before, whose path is a sum over the whole performance."""
        model = self.model
        root, yaw = model.channel.inverse(model.root_channel(z), model.aligned_directions(z), lengths)
        return along(control_points(np.concatenate([root, yaw[..., None]], axis=-1)), place)

    @cached_property
    def posture_control(self) -> np.ndarray:
        """(T + 2, P + 1, C) control points of posture components and their mean."""
        posture = self.model.posture
        return _control(np.concatenate([posture.basis, posture.mean[None]]), self.model.n_times)

    @cached_property
    def _root_control(self) -> np.ndarray:
        root = self.model.root
        return _control(np.concatenate([root.basis, root.mean[None]]), self.model.n_times)


def _control(rows: np.ndarray, n_times: int) -> np.ndarray:
    """Rows (P + 1, T * C) -> control points by place (T + 2, P + 1, C)."""
    control = control_points(rows.reshape(len(rows), n_times, -1))
    return np.ascontiguousarray(np.moveaxis(control, 1, 0))


def blended(control: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (n, S, R, C) at places (n, S), in cells, of splines with control points (T + 2, R, C)."""
    low, weight = _cells(len(control), place)
    return np.einsum("nsk,nskrc->nsrc", weight, control[low[..., None] + np.arange(4)])


def _cells(n_control: int, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First of four control points (n, S), and their weights (n, S, 4), of cubic B-splines at places (n, S)."""
    low = np.clip(place.astype(int), 0, n_control - 4)
    u = place - low
    weight = np.stack([(1 - u) ** 3, (3 * u - 6) * u**2 + 4, ((3 - 3 * u) * u + 3) * u + 1, u**3], axis=-1) / 6.0
    return low, weight


def _along(control: np.ndarray, coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (n, S, C) at places (n, S), in cells, of splines with coefficients (n, P) of control (T + 2, P + 1, C)."""
    low, weight = _cells(len(control), place)
    with_mean = np.concatenate([coefficients, np.ones((len(coefficients), 1))], axis=1)
    out = np.zeros((*place.shape, control.shape[-1]))
    for s in range(place.shape[1]):
        for cell in np.unique(low[:, s]):
            rows = np.flatnonzero(low[:, s] == cell)
            values = np.tensordot(with_mean[rows], control[cell : cell + 4], axes=(1, 1))  # (rows, 4, C)
            out[rows, s] = np.einsum("rk,rkc->rc", weight[rows, s], values)
    return out
