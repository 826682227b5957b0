"""``emulator_evidence``: that what is not the same is told of."""

import numpy as np
import pytest
from emulator_evidence.same import differences

ONE = {"duration_s": np.array([1.0, 2.0]), "marks": np.zeros((2, 0))}


def test_what_is_the_same_to_a_rounding_is_not_told_of():
    assert differences(ONE, ONE | {"duration_s": ONE["duration_s"] * (1 + 1e-14)}) == []


@pytest.mark.parametrize(
    ("other", "told"),
    [
        (ONE | {"duration_s": np.array([1.0, 2.0 + 1e-9])}, "duration_s: up to 1e-09 apart"),
        (ONE | {"marks": np.zeros((2, 1))}, "marks: (2, 0) and (2, 1)"),
        ({"marks": ONE["marks"]}, "duration_s: only in one of the two"),
        (ONE | {"duration_s": np.array([1.0, np.nan])}, "duration_s: up to 0 apart"),
    ],
)
def test_what_is_not_is_named(other, told):
    assert differences(ONE, other) == [told]
