import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from emulator.motion import stretches


def test_stretches_stop_one_beyond_their_last_frame():
    assert stretches(np.array([True, False, True, True, False, False, True])) == [(0, 1), (2, 4), (6, 7)]
    assert stretches(np.zeros(3, bool)) == [] and stretches(np.zeros(0, bool)) == []


@given(st.lists(st.booleans(), max_size=40))
def test_stretches_hold_all_true_frames_and_no_other(true):
    inside = [frame for start, stop in stretches(np.array(true, bool)) for frame in range(start, stop)]
    assert inside == [frame for frame, is_true in enumerate(true) if is_true]
