"""Rotations as turns about three axes, one after the other, and rotations that bring one direction to another."""

from __future__ import annotations

import numpy as np

USUAL_ORDER = "ZXY"
ORDERS = (USUAL_ORDER, "ZYX", "XZY")
"""One with each axis in the middle, where 90 degrees lock the other two."""
_FAR_DEG = 70.0


def euler_deg(rotation: np.ndarray, order: str = USUAL_ORDER) -> np.ndarray:
    """(T, 3) degrees about the axes of ``order`` of rotations (T, 3, 3): "ZXY" is Rz Rx Ry. Unwrapped in time.

    Where the middle turn is 90 degrees the other two are one; the last is then 0.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    across = np.hypot(rotation[:, i, j], rotation[:, i, i])
    middle = np.arctan2(sign * rotation[:, i, k], across)
    locked = across < 1e-7
    first = np.arctan2(-sign * rotation[:, j, k], rotation[:, k, k])
    last = np.arctan2(-sign * rotation[:, i, j], rotation[:, i, i])
    first[locked] = np.arctan2(sign * rotation[locked, k, j], rotation[locked, j, j])
    last[locked] = 0.0
    return np.degrees(np.unwrap(np.stack([first, middle, last], axis=1), axis=0))


def calm_order(rotation: np.ndarray) -> str:
    """ "ZXY", or where its middle turn comes near 90 degrees the order whose middle turn stays furthest from it."""
    largest = {order: float(np.abs(euler_deg(rotation, order)[:, 1]).max()) for order in ORDERS}
    return USUAL_ORDER if largest[USUAL_ORDER] < _FAR_DEG else min(ORDERS, key=lambda order: largest[order])


def least_turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(T, 3, 3) rotations without twist that bring unit vectors (T, 3) to others; half a turn where they are opposite.

    A turn is the product of two half turns, the second about the bisector: exact near opposite vectors too.
    """
    middle = start + end
    size = np.linalg.norm(middle, axis=1, keepdims=True)
    aside = np.zeros_like(start)
    aside[np.arange(len(start)), np.argmin(np.abs(start), axis=1)] = 1.0
    middle = np.where(size > 1e-7, middle / np.where(size > 1e-7, size, 1.0), np.cross(start, aside))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    return _half_turn(middle) @ _half_turn(start)


def best_turn(rest: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Rotations (T, 3, 3) about the origin that bring points (C, 3) nearest to points (T, C, 3).

    Source: Kabsch 1976.
    """
    left, _, right = np.linalg.svd(np.einsum("tca,cb->tab", vectors, rest))
    sign = np.ones((len(vectors), 3))
    sign[:, 2] = np.sign(np.linalg.det(left @ right))
    return left @ (sign[:, :, None] * right)


def _half_turn(axis: np.ndarray) -> np.ndarray:
    return 2.0 * axis[:, :, None] * axis[:, None, :] - np.eye(3)
