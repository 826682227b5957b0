"""Rotations as three turns, and the turns that bring one thing to another."""

import numpy as np
import pytest

from emulator.recordings.bvh_write import ORDERS, best_turn, calm_order, euler_deg, least_turn
from tests.naive import naive_turn


@pytest.mark.parametrize("order", [*ORDERS, "XYZ", "YXZ", "YZX"])
def test_angles_give_the_rotation_back(order):
    rng = np.random.default_rng(3)
    angles = np.concatenate([rng.uniform(-180, 180, (50, 3)), [[10, 90, 20], [0, -90, 0], [30, 90 - 1e-6, 5]]])
    turns = np.array([np.linalg.multi_dot([naive_turn(a.lower(), v) for a, v in zip(order, row)]) for row in angles])
    found = euler_deg(turns, order)
    back = np.array([np.linalg.multi_dot([naive_turn(a.lower(), v) for a, v in zip(order, row)]) for row in found])
    assert np.abs(back - turns).max() < 1e-7


def test_a_knee_bent_to_a_right_angle_is_told_in_another_order():
    bent = np.array([naive_turn("x", angle) for angle in range(0, 140, 5)])
    assert calm_order(bent[:4]) == "ZXY" and calm_order(bent) != "ZXY"


def test_turns_bring_what_they_should_where_they_should():
    rng = np.random.default_rng(4)
    start, end = rng.normal(size=(2, 60, 3))
    start, end = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (start, end))
    end[:3] = -start[:3]
    end[3] = start[3]
    turns = least_turn(start, end)
    assert np.allclose(np.einsum("tab,tb->ta", turns, start), end, atol=1e-12)
    assert np.allclose(np.linalg.det(turns), 1)
    least = np.arctan2(np.linalg.norm(np.cross(start, end), axis=1), np.sum(start * end, axis=1))
    assert np.allclose(np.trace(turns, axis1=1, axis2=2), 1 + 2 * np.cos(least))
    shape = rng.normal(size=(3, 3))
    assert np.allclose(best_turn(shape, np.einsum("tab,cb->tca", turns, shape)), turns, atol=1e-9)


def test_angles_do_not_jump_where_they_pass_half_a_turn():
    around = np.array([naive_turn("z", angle) for angle in range(0, 800, 40)])
    assert np.allclose(euler_deg(around)[:, 0], np.arange(0, 800, 40))
