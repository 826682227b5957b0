import numpy as np
import pytest

from opsim.viewer.frame_corrections import STEP, amends, corners

BONE_M = np.array([0.5, 0.2])


def off(at_s):
    """(S, 2, 3) a foot that is turned at once at 0.7310 s, and a shin that is not."""
    found = np.zeros((at_s.size, 2, 3))
    found[:, 1, 2] = np.where(at_s < 0.731, 0.0, 0.06) * np.clip((0.75 - at_s) / 0.01, 0, 1)
    return found


def far(at_s):
    return (np.linalg.norm(off(at_s), axis=2) * BONE_M).max(axis=1)


def shown(knots, at_s):
    own = np.column_stack([np.interp(at_s, knots.at_s, STEP * knots.by[:, c]) for c in range(3)])
    return np.linalg.norm(off(at_s)[:, 1] - own, axis=1) * BONE_M[1]


def test_what_comes_at_once_is_met_at_once():
    knots = amends(far, off, BONE_M, 2.0, 50.0)
    assert set(knots.bone) == {1} and np.all(np.diff(knots.at_s) > 0) and len(knots) < 12
    assert shown(knots, np.linspace(0.0, 2.0, 20_011)).max() < 2.5e-4
    assert not knots.by[[0, -1]].any() and np.diff(knots.at_s).min() < 2e-6


def test_good_frames_are_left_alone():
    assert len(amends(lambda at_s: 0.9e-3 + 0 * at_s, off, BONE_M, 2.0, 50.0)) == 0


def test_corners_come_as_near_as_is_asked():
    at_s = np.linspace(0.0, 1.0, 200)
    by = np.column_stack([np.sin(9 * at_s), np.cos(5 * at_s), at_s])
    rows = corners(at_s, by, 0.02)
    line = np.column_stack([np.interp(at_s, at_s[rows], by[rows, c]) for c in range(3)])
    assert np.linalg.norm(line - by, axis=1).max() <= 0.02 and len(rows) < 40
    assert corners(at_s, np.outer(at_s, [1.0, 2.0, 3.0]), 1e-9) == pytest.approx([0, 199])
