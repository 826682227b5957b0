"""Where names stand in a picture, so that they hide as little as can be of what is drawn and of each other."""

from __future__ import annotations

from collections.abc import Sequence

LETTER, ABOVE, BELOW, LONGEST = 8.0, 12.0, 3.5, 28
"""Width of a letter, how far letters reach above and below their line, in units of the picture; letters of a name."""
OUTSIDE = 150.0
"""How much worse a unit beyond the picture's edge is than a unit of what is hidden."""
Box = tuple[float, float, float, float]
"""(left, top, right, bottom)"""
Place = tuple[float, float, str]
"""(x, y, anchor) of a text"""


def shortened(name: str) -> str:
    """A name as a picture has room for."""
    return name if len(name) <= LONGEST else name[: LONGEST - 1] + "…"


def places(at: Sequence[tuple[float, float]], names: Sequence[str], taken: Sequence[Box], wide: float) -> list[Place]:
    """Beside each point a place for its name, in their order; what stands there already is avoided where it can be.

    taken : boxes that names should not hide; wide : of the picture
    """
    boxes, found = list(taken), []
    for (x, y), name in zip(at, names):
        length = LETTER * len(name)
        offers = [(x + side, y + down, side > 0) for down in (-8, 17, 4.5, -24, 33) for side in (9, -9)]
        covers = [_box(*offer, length) for offer in offers]
        best = min(range(len(offers)), key=lambda i: (_hidden(covers[i], boxes, wide), i))
        boxes.append(covers[best])
        found.append((*offers[best][:2], "start" if offers[best][2] else "end"))
    return found


def _box(x: float, y: float, rightward: bool, length: float) -> Box:
    left = x if rightward else x - length
    return left, y - ABOVE, left + length, y + BELOW


def _hidden(box: Box, taken: Sequence[Box], wide: float) -> float:
    """How much of others a box covers, and how far it stands out of the picture."""
    left, top, right, _ = box
    out = max(0.0, -left) + max(0.0, right - wide) + max(0.0, -top)
    return OUTSIDE * out + sum(shared(box, other) for other in taken)


def shared(a: Box, b: Box) -> float:
    """The area that two boxes have in common."""
    across, down = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    return max(0.0, across) * max(0.0, down)
