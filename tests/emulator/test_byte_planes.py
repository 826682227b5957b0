"""Whole numbers as planes of bytes: the way back is exact for any numbers; smooth ones pack into few bytes."""

import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from emulator.byte_planes import from_planes, to_planes

WHOLE = st.sampled_from([np.int16, np.int32]).flatmap(lambda kind: arrays(kind, st.tuples(*[st.integers(0, 5)] * 2)))


@given(WHOLE)
def test_the_way_back_is_exact(whole):
    again = from_planes(to_planes(whole))
    assert again.dtype == whole.dtype and np.array_equal(again, whole)


@pytest.mark.parametrize(("values", "planes"), [([5, 5], [[10, 9]]), ([-1, -2, -3], [[1, 0, 0]])])
def test_first_values_and_second_differences_are_folded(values, planes):
    """5, then a change of -5 in the step: 2 * 5, and 2 * 5 - 1; a straight line is nothing after its first step."""
    found = to_planes(np.array(values, np.int16))
    assert found[0].tolist() == planes[0] and not found[1:].any()


def test_a_smooth_curve_takes_less_than_its_high_byte():
    curve = np.rint(1e6 * np.sin(np.linspace(0, 3, 1000))).astype(np.int32)
    assert len(zlib.compress(to_planes(curve).tobytes())) < 0.25 * curve.nbytes


@pytest.mark.parametrize("planes", [np.zeros((3, 4), np.uint8), np.zeros((2, 4), np.int16), np.zeros((0, 4), np.uint8)])
def test_what_are_no_planes_is_refused(planes):
    with pytest.raises(ValueError, match="expected 2 or 4 of uint8"):
        from_planes(planes)
