"""One stick figure: limbs as unbroken lines, the torso as a shape, the head as a circle.

A body to be drawn with thickness: round limbs that taper, a torso between shoulders and hips, a head.

The parts of a body as it is seen, the far ones first: what films and pictures of single postures draw alike.

From where a movement is looked at, and where its figures stand in the picture.

From where moving bodies are looked at, the same for all of them: on the page and in films.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

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


TRUNK_GREY = "#9aa2ad"
COLOURS = (TRUNK_GREY, LEFT, RIGHT)
HEAD_RADIUS_M, TORSO_M = 0.105, 0.085
OTHER_M = (0.036, 0.032)
STEADY_M = 0.15
"""A limb that is about as far before the torso as it usually is keeps its place in the order of drawing."""
LIMB_M = {
    "neck": (0.06, 0.055),
    "head": (0.055, 0.05),
    "elbow": (0.052, 0.041),
    "wrist": (0.041, 0.029),
    "hand": (0.034, 0.030),
    "fingers": (0.026, 0.018),
    "thumb": (0.020, 0.014),
    "knee": (0.084, 0.058),
    "ankle": (0.058, 0.037),
    "toe": (0.040, 0.032),
    "heel": (0.040, 0.036),
}
"""Radii (m) at both ends of the bone that ends in this joint, of a person of middle size."""


def body(skeleton: Any) -> dict[str, Any]:
    """What a page needs to draw this skeleton, lengths in whole mm.

    bones : rows (parent, child, radius at parent, radius at child, colour number), without those that tie the torso
    torso : four joint numbers round the torso, or none; head : its joint, or -1; feet : joints that throw a shadow
    """
    names, parents = list(skeleton.names), list(skeleton.parents)
    torso = [names.index(name) for name in TORSO] if set(TORSO) <= set(names) else []
    bones = [
        (parent, joint, *(round(1000 * radius) for radius in LIMB_M.get(_joint(names[joint]), OTHER_M)), _side(name))
        for joint, (name, parent) in enumerate(zip(names, parents))
        if parent >= 0 and joint not in torso
    ]
    return {
        "bones": bones,
        "torso": torso,
        "torso_mm": round(1000 * TORSO_M),
        "head": names.index("head") if "head" in names else -1,
        "head_mm": round(1000 * HEAD_RADIUS_M),
        "feet": [i for i, name in enumerate(names) if _joint(name) in ("ankle", "toe", "foot", "heel")],
        "root": parents.index(-1),
        "colours": COLOURS,
    }


def _joint(name: str) -> str:
    return name.removeprefix("left_").removeprefix("right_")


def _side(name: str) -> int:
    return 1 if name.startswith("left_") else 2 if name.startswith("right_") else 0


TORSO_PART = -1
"""In place of a joint."""
Shape = tuple[str, Any]
"""("taper", (a, b, radius at a, radius at b)), ("disc", (middle, radius)) or ("inside", corners), all in pixels."""


class Part(NamedTuple):
    """How near it is to the viewer, the number of its colour, the joint that it ends in, and what it is made of."""

    near: float
    colour: int
    joint: int
    shapes: list[Shape]


def body_parts(table: Mapping[str, Any], seen: np.ndarray, often: np.ndarray, px_per_mm: float) -> list[Part]:
    """The parts of the body of ``body.body`` at joints seen (J, 3): x and y in pixels, nearness in metres.

    often : (J, 3) the same of the usual posture: a limb about as near as usual keeps its place in the order
    """
    torso = table["torso"] or [table["root"]]
    here, there = seen[torso, 2].mean(), often[torso, 2].mean()
    parts: list[Part] = []
    for parent, joint, from_mm, to_mm, side in table["bones"]:
        now, then = seen[[parent, joint], 2].mean() - here, often[[parent, joint], 2].mean() - there
        near = (then if abs(now - then) < STEADY_M else now) if side else now - 0.3
        limb = ("taper", (seen[parent, :2], seen[joint, :2], from_mm * px_per_mm, to_mm * px_per_mm))
        parts.append(Part(near, side, joint, [limb]))
    if table["torso"]:
        parts.append(Part(-0.02, 0, TORSO_PART, _rounded(seen[torso, :2], table["torso_mm"] * px_per_mm)))
    if table["head"] >= 0:
        head = seen[table["head"]]
        disc = ("disc", (head[:2], table["head_mm"] * px_per_mm))
        parts.append(Part(head[2] - here, 0, table["head"], [disc]))
    return sorted(parts, key=lambda part: part.near)


def outer_tangents(a: np.ndarray, b: np.ndarray, a_px: float, b_px: float) -> np.ndarray:
    """(4, 2) corners of what lies between two discs: on a, on b, on b again, on a; (0, 2) where one holds the other."""
    far = float(np.hypot(*(b - a)))
    if far <= abs(a_px - b_px) + 1e-6:
        return np.empty((0, 2))
    along, open_rad = np.arctan2(b[1] - a[1], b[0] - a[0]), np.arccos((a_px - b_px) / far)
    ends = ((a, a_px, open_rad), (b, b_px, open_rad), (b, b_px, -open_rad), (a, a_px, -open_rad))
    ways = [(middle, radius, along + turn) for middle, radius, turn in ends]
    return np.array([middle + radius * np.array([np.cos(turn), np.sin(turn)]) for middle, radius, turn in ways])


def _rounded(corners: np.ndarray, round_px: float) -> list[Shape]:
    """A filled outline with round corners: its inside, and a limb along each side."""
    sides = zip(corners, np.roll(corners, -1, axis=0))
    return [("inside", corners), *(("taper", (a, b, round_px, round_px)) for a, b in sides)]


TRAVEL_M = 0.8
"""A pelvis that goes further than this is followed by the picture (walking)."""
NARROWEST_M = 0.95
"""Figures stand at least this far apart, else a slim movement would be drawn larger than others."""
THREE_QUARTER_RAD, FRONT_RAD = np.radians(28.0), np.radians(14.0)


@dataclass(frozen=True)
class Strip:
    """One row of figures: ``positions_m`` (T, J, 3) at T equal steps of ``duration_s``, marks in seconds, a label."""

    label: str
    positions_m: np.ndarray
    duration_s: float
    mark_s: np.ndarray


def _facing(positions: np.ndarray, skeleton: Any) -> tuple[np.ndarray, np.ndarray]:
    """Unit horizontal vectors (forward, left) of the person, from the mean hip line."""
    names = list(skeleton.names)
    across = (positions[:, names.index("left_hip")] - positions[:, names.index("right_hip")]).mean(axis=0)[:2]
    left = across / np.linalg.norm(across)
    return np.array([left[1], -left[0]]), left


def view_axes(positions: np.ndarray, skeleton: Any) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal unit vectors (picture's right, towards the viewer) from which the movement is seen best.

    The picture lies along the main horizontal direction of the movement, as far as the person still faces the viewer:
    a movement to the side is seen from the front, one forward and back from the side, turned by 28 degrees towards the
    front so that the far limbs are not hidden. positions: (T, J, 3) m.
    """
    forward, left = _facing(positions, skeleton)
    moving = (positions - positions[:, skeleton.parents.index(-1), None])[..., :2]
    moving = np.reshape((moving - moving.mean(axis=0)) @ np.stack([left, forward], axis=1), (-1, 2))
    (xx, xy), (_, yy) = moving.T @ moving
    main = np.arctan2(2 * xy, xx - yy) / 2  # of the covariance's ellipse, from the left-right line
    most = np.pi / 2 - THREE_QUARTER_RAD
    turn = most if abs(main) > most else np.sign(main or 1.0) * max(abs(main), FRONT_RAD)
    right = np.cos(turn) * left + np.sin(turn) * forward
    return right, np.cos(turn) * forward - np.sin(turn) * left


@dataclass(frozen=True)
class Stage:
    """What all rows share: view, metres of picture a second, seconds between figures, head and joint numbers."""

    right: np.ndarray
    viewer: np.ndarray
    m_per_s: float
    step_s: float
    skeleton: Any

    def flat(self, strip: Strip, at_s: float) -> tuple[np.ndarray, np.ndarray]:
        """The posture at ``at_s``: (J, 2) in the picture about the figure's place, and (J,) nearness to the viewer."""
        time = np.linspace(0.0, strip.duration_s, len(strip.positions_m))
        index = np.clip(np.searchsorted(time, at_s), 1, len(time) - 1)
        share = np.clip((at_s - time[index - 1]) / (time[index] - time[index - 1]), 0.0, 1.0)
        posture = (1 - share) * strip.positions_m[index - 1] + share * strip.positions_m[index]
        root = strip.positions_m[:, self.skeleton.parents.index(-1), :2]
        travels = np.linalg.norm(np.ptp(root, axis=0)) > TRAVEL_M
        centre = posture[self.skeleton.parents.index(-1), :2] if travels else root.mean(axis=0)
        around = posture[:, :2] - centre
        return np.stack([around @ self.right, posture[:, 2]], axis=-1), around @ self.viewer


def stage_of(strips: Sequence[Strip], skeleton: Any, n_figures: int) -> Stage:
    right, viewer = view_axes(strips[0].positions_m, skeleton)
    step_s = _round_step_s(max(strip.duration_s for strip in strips) / n_figures)
    unit = Stage(right, viewer, 1.0, step_s, skeleton)
    widths = [
        np.ptp(unit.flat(strip, at_s)[0][:, 0]) for strip in strips for at_s in np.linspace(0, strip.duration_s, 7)
    ]
    return Stage(right, viewer, max(max(widths) + 0.12, NARROWEST_M) / step_s, step_s, skeleton)


def _round_step_s(least_s: float) -> float:
    """The next number of seconds that a person would choose for an axis."""
    power = 10.0 ** np.floor(np.log10(least_s))
    return float(
        next(power * digit for digit in (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if power * digit >= least_s - 1e-12)
    )


LIFT_RAD = 0.17
"""How steeply one looks down."""
FLOOR_M, SQUARE_M = -0.03, 0.25
"""The floor lies a sole below the lowest joint; its squares."""
NARROWEST_VIEW_M = 0.45


@dataclass(frozen=True)
class Camera:
    """A view without perspective: from ``turn_deg`` about the vertical, 0 along x, looking down by LIFT_RAD.

    middle_m : (x, y) at the middle of the picture, unless it follows the root of each body
    wide_m   : from the middle to the edge, as much as any view of any body needs; tall_m : above the floor's zero
    """

    turn_deg: int
    follow: bool
    middle_m: tuple[float, float]
    wide_m: float
    tall_m: float

    @property
    def height_per_width(self) -> float:
        """Of the picture."""
        tall_m = (self.tall_m - FLOOR_M) * np.cos(LIFT_RAD) + 2 * self.wide_m * np.sin(LIFT_RAD)
        return float(tall_m / (2 * self.wide_m))

    def see(self, points_m: np.ndarray, middle_m: np.ndarray) -> np.ndarray:
        """Points (..., 3) -> (..., 3): metres to the right of the middle, up from the lower edge, near the viewer."""
        turn, away = np.radians(self.turn_deg), points_m[..., :2] - middle_m
        near = away @ np.array([np.cos(turn), np.sin(turn)])
        across = away @ np.array([-np.sin(turn), np.cos(turn)])
        up, lean = np.cos(LIFT_RAD), np.sin(LIFT_RAD)
        high = self.wide_m * lean + (points_m[..., 2] - FLOOR_M) * up - near * lean
        return np.stack([across, high, near * up + points_m[..., 2] * lean], axis=-1)

    def as_dict(self) -> dict[str, Any]:
        """What a page's script needs to look in the same way."""
        return {
            "turn_deg": self.turn_deg,
            "follow": self.follow,
            "middle": [round(value, 4) for value in self.middle_m],
            "wide": round(self.wide_m, 4),
            "tall": round(self.tall_m, 4),
            "lift": LIFT_RAD,
            "floor": FLOOR_M,
            "square": SQUARE_M,
        }


def camera_of(positions_m: Sequence[np.ndarray], skeleton: Any) -> Camera:
    """The view of bodies (T, J, 3) that stand side by side; who walks is followed."""
    root = skeleton.parents.index(-1)
    ways = [joints[:, root, :2] for joints in positions_m]
    follow = bool(max(np.linalg.norm(np.ptp(way, axis=0)) for way in ways) > TRAVEL_M)
    low, high = np.min([way.min(axis=0) for way in ways], axis=0), np.max([way.max(axis=0) for way in ways], axis=0)
    middle = (low + high) / 2
    reach = [
        np.linalg.norm(joints[..., :2] - (way[:, None] if follow else middle), axis=-1).max()
        for joints, way in zip(positions_m, ways)
    ]
    return Camera(
        _turn_deg(positions_m, skeleton),
        follow,
        (float(middle[0]), float(middle[1])),
        max(float(max(reach)), NARROWEST_VIEW_M) + 0.1,
        float(max(joints[..., 2].max() for joints in positions_m)) + 0.16,
    )


def _turn_deg(positions_m: Sequence[np.ndarray], skeleton: Any) -> int:
    """Whence all are looked at first: one direction, from the movements of all."""
    if not {"left_hip", "right_hip"} <= set(skeleton.names):
        return 30
    _, viewer = view_axes(np.concatenate(positions_m), skeleton)
    return round(float(np.degrees(np.arctan2(viewer[1], viewer[0]))))
