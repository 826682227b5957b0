"""The judge of cycle boundaries against foot contact can fail."""

import numpy as np

from tests.take_evidence.cycles_judged import judged, strikes


def contact(strides, n=None):
    """(T, 2) of a walk whose left foot strikes at the running sum of ``strides`` and bears for half of each."""
    at = np.cumsum([7, *strides])
    bears = np.zeros((n or at[-1] + 10, 2), bool)
    for start, stride in zip(at, [*strides, strides[-1]], strict=True):
        bears[start : start + stride // 2, 0] = True
    return bears, at


def test_boundaries_at_one_phase_are_all_right_whatever_the_phase():
    bears, at = contact([30, 33, 27, 30, 31])
    for offset in (-13, 0, 5, 14):
        inside = at + offset
        found = judged(inside[inside >= 0].astype(float), bears)
        assert found.right == found.judged == len(inside[inside >= 0]) - 1
        assert found.offset % 30 in (offset % 30, offset % 30 - 30)


def test_one_boundary_five_frames_off_spoils_both_cycles_beside_it():
    bears, at = contact([30, 30, 30, 30, 30])
    boundary = at.astype(float)
    boundary[2] += 5
    assert judged(boundary, bears).right == 3


def test_a_boundary_that_is_missing_spoils_its_cycle():
    bears, at = contact([30, 30, 30, 30, 30])
    found = judged(np.delete(at, 2).astype(float), bears)
    assert (found.right, found.judged) == (3, 4)
    assert (found.strides_found, found.strides) == (3, 5)


def test_boundaries_at_random_are_mostly_wrong():
    bears, at = contact([30] * 40)
    rng = np.random.default_rng(0)
    found = judged(np.sort(rng.uniform(0, at[-1], 41)), bears)
    assert found.right < 0.2 * found.judged


def test_flickers_are_no_strikes():
    bears, at = contact([30, 30, 30])
    bears[at[1] + 5, 0] = False
    bears[at[2] - 6, 0] = True
    assert np.array_equal(strikes(bears[:, 0])[1:3], at[1:3])
