import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from emulator.runs import runs_of


def test_runs_are_first_and_last_frames():
    assert runs_of(np.array([True, False, True, True, False, False, True])) == [(0, 0), (2, 3), (6, 6)]
    assert runs_of(np.zeros(3, bool)) == [] and runs_of(np.zeros(0, bool)) == []


@given(st.lists(st.booleans(), max_size=40))
def test_runs_hold_all_true_frames_and_no_other(true):
    inside = [frame for first, last in runs_of(np.array(true, bool)) for frame in range(first, last + 1)]
    assert inside == [frame for frame, is_true in enumerate(true) if is_true]
