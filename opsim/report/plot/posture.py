"""A load as a box between the hands of a body that faces along x.

One posture as a picture: a person with round limbs, what drives a score in warm colours, the load in the hands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from opsim.ergonomics.angles import SHORTEST_M
from opsim.report.plot.body import FLOOR_M, SQUARE_M, TORSO_PART, Camera, Part, Shape, body, body_parts
from opsim.report.plot.svg_canvas import path_of, polygon

KG_PER_M3 = 300.0
"""Of what is carried in factories, packed: only for the size of the picture."""
SMALLEST_M, LARGEST_M = 0.12, 0.45
WIDEST_M, LEVEL_M = 0.7, 0.15
"""Hands that hold one box on both sides are no further apart, nor one of them so much higher or further ahead."""
BESIDE_M = 0.06
"""From the middle of a hand or wrist to what it holds: further off it does not touch."""
FACES = (((0, 1), "#c9a97c"), ((1, 1), "#b8945f"), ((1, -1), "#b8945f"), ((0, -1), "#c9a97c"), ((2, 1), "#dcc298"))
"""Axis and side of each face that may be seen, with its colour: lighter above."""


def load_box(
    joints_m: np.ndarray, skeleton: Any, load_kg: float, seen: Callable[[np.ndarray], np.ndarray]
) -> list[tuple[float, str]]:
    """[(nearness, svg)] of a box of load_kg between hands, or wrists, of joints (J, 3); empty where there is none.

    Where both hands are level and further apart than its mass makes it wide, it is as wide as they are apart; where
    one is too far off to hold it, it hangs in the lower hand.
    seen : points (..., 3) in metres -> x and y in pixels, nearness in metres
    """
    hands = _hands_m(joints_m, list(skeleton.names))
    if load_kg <= 0 or hands is None:
        return []
    half, middle = _held(hands, float(np.clip(np.cbrt(load_kg / KG_PER_M3), SMALLEST_M, LARGEST_M)) / 2)
    return [(float(seen(middle)[2]), _box(half, middle, seen, FACES, "#8a6b3d"))]


def _box(
    half: np.ndarray,
    middle: np.ndarray,
    seen: Callable[[np.ndarray], np.ndarray],
    faces: Sequence[tuple[tuple[int, int], str]],
    edge: str,
) -> str:
    """A box about its middle (3,), half as long along each axis as ``half`` (3,), the farthest of its faces first."""
    ordered = sorted(
        ((seen(_corners(axis, side) * half + middle), colour) for (axis, side), colour in faces),
        key=lambda face: float(face[0][:, 2].mean()),
    )
    look = f'stroke="{edge}" stroke-width="1" stroke-linejoin="round"'
    return "".join(f'<path d="{polygon(corners[:, :2])}" fill="{colour}" {look}/>' for corners, colour in ordered)


BOARD = (((0, 1), "#8fa3b8"), ((0, -1), "#8fa3b8"), ((1, 1), "#8fa3b8"), ((1, -1), "#8fa3b8"), ((2, 1), "#c3cfdb"))
BOARD_HALF_M, BEFORE_M = np.array([0.20, 0.30, 0.012]), 0.14
"""A board of a shelf, from its middle to its sides; its middle is so far ahead of the hands' middle."""


def _board(joints_m: np.ndarray, skeleton: Any, height_m: float, seen: Callable[[np.ndarray], np.ndarray]) -> str:
    """A board whose top is at this height, under the hands of a body that faces along x; nothing without hands."""
    hands = _hands_m(joints_m, list(skeleton.names))
    if hands is None:
        return ""
    ahead_m, aside_m = hands[:, :2].mean(axis=0)
    middle = np.array([ahead_m + BEFORE_M, aside_m, height_m - BOARD_HALF_M[2]])
    return _box(BOARD_HALF_M, middle, seen, BOARD, "#5d7186")


def _held(hands: np.ndarray, half_m: float) -> tuple[np.ndarray, np.ndarray]:
    """(3,) half the box along each axis, and (3,) its middle: between both hands, or below the lower one."""
    half, apart = np.full(3, half_m), np.abs(hands[1] - hands[0])
    if (apart <= 2 * (half + BESIDE_M)).all():
        return half, hands.mean(axis=0)
    if apart[1] <= WIDEST_M and max(apart[0], apart[2]) <= LEVEL_M:
        half[1] = apart[1] / 2
        return half, hands.mean(axis=0)
    lower = hands[int(hands[1, 2] < hands[0, 2])]
    return half, lower - [0.0, 0.0, min(half_m, float(lower[2]) / 2)]


def _hands_m(joints_m: np.ndarray, names: list[str]) -> np.ndarray | None:
    """(2, 3) hands, or wrists; None where one of them is not known."""
    for joint in ("hand", "wrist"):
        if {f"left_{joint}", f"right_{joint}"} <= set(names):
            found = np.asarray(joints_m[[names.index(f"left_{joint}"), names.index(f"right_{joint}")]])
            if np.isfinite(found).all():
                return found
    return None


def _corners(axis: int, side: int) -> np.ndarray:
    """(4, 3) corners of a face of the cube from -1 to 1."""
    corners = np.full((4, 3), float(side))
    others = [other for other in range(3) if other != axis]
    corners[:, others] = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return corners


VIEWS = {"side": 90.0, "three_quarter": 50.0, "front": 0.0}
"""Degrees from straight ahead, towards the side that is nearer to the viewer."""
WARM = ((0.0, (0xA9, 0xB0, 0xBA)), (0.75, (0xF0, 0xA8, 0x30)), (2.0, (0xB0, 0x41, 0x0B)))
"""Colours by points of a score that a part brings in."""
FLOOR, SHADOW = "#dde2e8", "#28303a"
EDGE_M, HEAD_ROOM_M = 0.16, 0.16
REGIONS = {
    "neck": ("head",),
    "arms": ("elbow", "wrist"),
    "wrists": ("hand", "fingers", "thumb"),
    "legs": ("knee", "ankle", "toe", "heel", "foot"),
}
"""Parts of ``explain``'s drives, and the joints in which their bones end; all other bones are of the trunk."""
ALIKE = {"back": "trunk"}


def posture_svg(
    joints_m: np.ndarray,
    skeleton: Any,
    *,
    drives: Mapping[str, float] | None = None,
    side: str | None = None,
    load_kg: float | None = None,
    board_m: float | None = None,
    view: str = "three_quarter",
    room: Camera | None = None,
    width_px: int = 220,
    label: str = "",
) -> str:
    """An ``svg`` element of joints (J, 3) in metres, z up, wherever the body stands and whichever way it faces.

    drives  : points of a score by part of the body (``explained.explain``), which colour it; None: left and right
    side    : the arm that is nearer to the viewer and takes the arms' colour; None: the right one, and both
    load_kg : a box in the hands, by this mass; 0 or None: none
    board_m : height above the floor of a board under the hands; None: none
    view    : one of VIEWS;  room : of ``room_of``, where several pictures are to have one scale
    label   : what a screen reader says
    A joint that is nan is left out with the bones that end in it.
    """
    standing = _turned_ahead(joints_m, skeleton)
    camera, table = room or room_of([joints_m], skeleton, view, side), body(skeleton)
    scale = width_px / (2 * camera.wide_m)
    height_px = round(width_px * camera.height_per_width)
    seen = _seen(standing, camera, width_px, height_px)
    rim = max(1.2, 0.012 * scale)
    drawn = [
        (part.near, _part_svg(part, _colour(part, table, skeleton, drives, side), rim))
        for part in _there(table, seen, scale)
    ]

    def to_picture(points_m: np.ndarray) -> np.ndarray:
        return _seen(points_m, camera, width_px, height_px)

    box = load_box(standing, skeleton, load_kg or 0.0, to_picture)
    here = np.nanmean(seen[table["torso"] or [table["root"]], 2])
    drawn += [(near - here, svg) for near, svg in box]
    return "".join(
        [
            f'<svg viewBox="0 0 {width_px} {height_px}" width="{width_px}" height="{height_px}" role="img" '
            f'aria-label="{escape(label or "a posture")}">',
            *_ground(camera, width_px, height_px),
            *_shadows(standing, table, camera, width_px, height_px, scale),
            "" if board_m is None else _board(standing, skeleton, board_m - _lowest_m(joints_m), to_picture),
            *(svg for _, svg in sorted(drawn, key=lambda each: each[0])),
            "</svg>",
        ]
    )


def room_of(
    postures_m: Sequence[np.ndarray], skeleton: Any, view: str = "three_quarter", side: str | None = None
) -> Camera:
    """The view of several postures (J, 3), each at its own place: as wide and as tall as the largest asks for."""
    ahead = [_turned_ahead(joints_m, skeleton) for joints_m in postures_m]
    wide_m = max(float(np.nanmax(np.hypot(joints[:, 0], joints[:, 1]))) for joints in ahead)
    tall_m = max(float(np.nanmax(joints[:, 2])) for joints in ahead)
    turn = VIEWS[view] * (1.0 if side == "left" else -1.0)
    return Camera(round(turn), False, (0.0, 0.0), max(wide_m, 0.6) + EDGE_M, tall_m + HEAD_ROOM_M)


def _lowest_m(joints_m: np.ndarray) -> float:
    """The height of the lowest joint, which stands on the floor of the picture."""
    return float(np.nanmin(np.asarray(joints_m, float)[:, 2]))


def _turned_ahead(joints_m: np.ndarray, skeleton: Any) -> np.ndarray:
    """The body about its own middle, facing along x, its lowest joint on the floor."""
    names, joints_m = list(skeleton.names), np.asarray(joints_m, float)
    low, high = np.nanmin(joints_m, axis=0), np.nanmax(joints_m, axis=0)
    found = joints_m - [*((low + high) / 2)[:2], low[2]]
    if not {"left_hip", "right_hip"} <= set(names):
        return found
    across = (found[names.index("left_hip")] - found[names.index("right_hip")])[:2]
    wide_m = np.hypot(*across)
    if not wide_m >= SHORTEST_M:
        return found
    y, x = across / wide_m, np.array([across[1], -across[0]]) / wide_m
    turned = np.concatenate([found[:, :2] @ np.stack([x, y], axis=1), found[:, 2:]], axis=1)
    middle = (np.nanmin(turned, axis=0) + np.nanmax(turned, axis=0)) / 2
    return np.asarray(turned - [middle[0], middle[1], 0.0])


def _seen(points_m: np.ndarray, camera: Camera, width_px: int, height_px: int) -> np.ndarray:
    """(..., 3): x and y in the picture, nearness in metres."""
    across, high, near = np.moveaxis(camera.see(np.asarray(points_m, float), np.zeros(2)), -1, 0)
    scale = width_px / (2 * camera.wide_m)
    return np.stack([width_px / 2 + scale * across, height_px - scale * high, near], axis=-1)


def _there(table: dict[str, Any], seen: np.ndarray, scale: float) -> list[Part]:
    """Parts all of whose ends are known."""
    return [part for part in body_parts(table, seen, seen, scale / 1000) if np.isfinite(part.near)]


def _part_svg(part: Part, colour: str, rim: float) -> str:
    outline = " ".join(map(_outline, part.shapes))
    look = f'fill="{colour}" stroke="#fff" stroke-width="{2 * rim:.1f}" stroke-linejoin="round" paint-order="stroke"'
    return f'<path d="{outline}" {look}/>'


def _outline(shape: Shape) -> str:
    return path_of(*shape)


def _colour(
    part: Part, table: dict[str, Any], skeleton: Any, drives: Mapping[str, float] | None, side: str | None
) -> str:
    if drives is None:
        return str(table["colours"][part.colour])
    name = "" if part.joint == TORSO_PART else skeleton.names[part.joint]
    plain = name.removeprefix("left_").removeprefix("right_")
    region = next((region for region, joints in REGIONS.items() if plain in joints), "trunk")
    other_arm = region in ("arms", "wrists") and side is not None and not name.startswith(side)
    points = {ALIKE.get(part_of, part_of): more for part_of, more in drives.items()}
    return warm(0.0 if other_arm else points.get(region, 0.0))


def warm(points: float) -> str:
    """The colour of a part that brings so many points into a score."""
    at, channels = [stop for stop, _ in WARM], np.array([colour for _, colour in WARM], float)
    mixed = [round(float(np.interp(points, at, channels[:, channel]))) for channel in range(3)]
    return "#{:02x}{:02x}{:02x}".format(*mixed)


def _ground(camera: Camera, width_px: int, height_px: int) -> list[str]:
    """Squares of the floor, in a circle about the body."""
    reach, lines = camera.wide_m - 0.04, []
    for axis in (0, 1):
        last = int(np.floor(reach / SQUARE_M))
        for k in range(-last, last + 1):
            half = np.sqrt(max(0.0, reach**2 - (k * SQUARE_M) ** 2))
            ends = np.full((2, 3), FLOOR_M)
            ends[:, axis], ends[:, 1 - axis] = k * SQUARE_M, (-half, half)
            (x0, y0, _), (x1, y1, _) = _seen(ends, camera, width_px, height_px)
            lines.append(f"M{x0:.1f} {y0:.1f}L{x1:.1f} {y1:.1f}")
    return [f'<path d="{"".join(lines)}" stroke="{FLOOR}" fill="none"/>']


def _shadows(
    joints_m: np.ndarray, table: dict[str, Any], camera: Camera, width_px: int, height_px: int, scale: float
) -> list[str]:
    found = []
    for foot in table["feet"]:
        if np.isfinite(joints_m[foot]).all():
            x, y, _ = _seen(np.append(joints_m[foot, :2], FLOOR_M), camera, width_px, height_px)
            dark = 0.28 * np.exp(-max(joints_m[foot, 2], 0.0) / 0.12)
            size = f'rx="{0.075 * scale:.1f}" ry="{0.02 * scale:.1f}"'
            found.append(f'<ellipse cx="{x:.1f}" cy="{y:.1f}" {size} fill="{SHADOW}" opacity="{dark:.2f}"/>')
    return found
