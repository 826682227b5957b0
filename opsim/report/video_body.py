"""A moving body drawn frame by frame for films: the same shapes, order and camera as the page's script draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.body import body
from opsim.report.body_parts import Shape, body_parts, outer_tangents
from opsim.report.camera import FLOOR_M, SQUARE_M, Camera

FINER = 3
"""Drawn this many times as large, then made smaller: Pillow draws hard edges."""
GRID, SHADOW = "#dde2e8", (40, 46, 54)


class BodyPainter:
    """Draws the bodies of one skeleton into pictures of ``width_px``, seen by ``camera``."""

    def __init__(self, skeleton: Any, camera: Camera, width_px: int) -> None:
        self.camera, self.table = camera, body(skeleton)
        self.size_px = (width_px, round(width_px * camera.height_per_width))
        self.size = (self.size_px[0] * FINER, self.size_px[1] * FINER)
        self.scale = self.size[0] / (2 * camera.wide_m)

    def picture(self, joints_m: np.ndarray, usual_m: np.ndarray) -> Any:
        """A Pillow picture of joints (J, 3); ``usual_m`` (J, 3) are their means, which steady the order of limbs."""
        from PIL import Image, ImageDraw

        large = Image.new("RGB", self.size, "white")
        draw = ImageDraw.Draw(large, "RGBA")
        middle = joints_m[self.table["root"], :2] if self.camera.follow else np.array(self.camera.middle_m)
        self._ground(draw, middle)
        self._shadows(draw, joints_m, middle)
        rim = max(1.5 * FINER, 0.012 * self.scale)
        seen, often = self._seen(joints_m, middle), self._seen(usual_m, middle)
        for part in body_parts(self.table, seen, often, self.scale / 1000):
            _fill(draw, part.shapes, "white", rim)
            _fill(draw, part.shapes, self.table["colours"][part.colour], 0.0)
        return large.reduce(FINER)

    def _seen(self, points_m: np.ndarray, middle: np.ndarray) -> np.ndarray:
        """Points (..., 3) -> (..., 3): x and y in the picture, and nearness in metres."""
        across, high, near = np.moveaxis(self.camera.see(points_m, middle), -1, 0)
        return np.stack([self.size[0] / 2 + self.scale * across, self.size[1] - self.scale * high, near], axis=-1)

    def _ground(self, draw: Any, middle: np.ndarray) -> None:
        reach = self.camera.wide_m - 0.04
        for axis in (0, 1):
            first, last = (np.array([-reach, reach]) + middle[axis]) / SQUARE_M
            for k in range(int(np.ceil(first)), int(np.floor(last)) + 1):
                half = np.sqrt(max(0.0, reach**2 - (k * SQUARE_M - middle[axis]) ** 2))
                ends = np.full((2, 3), FLOOR_M)
                ends[:, axis], ends[:, 1 - axis] = k * SQUARE_M, middle[1 - axis] + np.array([-half, half])
                line = [tuple(end) for end in self._seen(ends, middle)[:, :2]]
                draw.line(line, fill=GRID, width=max(FINER, round(0.004 * self.scale)))

    def _shadows(self, draw: Any, joints_m: np.ndarray, middle: np.ndarray) -> None:
        for foot in self.table["feet"]:
            below = np.append(joints_m[foot, :2], FLOOR_M)
            x, y, _ = self._seen(below, middle)
            dark = 0.28 * np.exp(-max(joints_m[foot, 2], 0.0) / 0.12)
            wide, high = 0.075 * self.scale, 0.02 * self.scale
            draw.ellipse([x - wide, y - high, x + wide, y + high], fill=(*SHADOW, round(255 * dark)))


def _fill(draw: Any, shapes: list[Shape], colour: str, rim: float) -> None:
    """Fill the shapes, each larger by ``rim`` pixels all round."""
    for kind, what in shapes:
        if kind == "inside":
            draw.polygon([tuple(corner) for corner in what], fill=colour)
        elif kind == "disc":
            _disc(draw, what[0], what[1] + rim, colour)
        else:
            a, b, a_px, b_px = what
            _taper(draw, a, b, a_px + rim, b_px + rim, colour)


def _disc(draw: Any, centre: np.ndarray, radius_px: float, colour: str) -> None:
    draw.ellipse([*(centre - radius_px), *(centre + radius_px)], fill=colour)


def _taper(draw: Any, a: np.ndarray, b: np.ndarray, a_px: float, b_px: float, colour: str) -> None:
    """Two discs and what lies between their outer tangents."""
    _disc(draw, a, a_px, colour)
    _disc(draw, b, b_px, colour)
    corners = outer_tangents(a, b, a_px, b_px)
    if len(corners):
        draw.polygon([tuple(corner) for corner in corners], fill=colour)
