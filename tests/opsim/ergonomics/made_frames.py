"""Frames of one worker, made by hand."""

import numpy as np

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.shift.frames import Frames


def made_frames(n=None, *, worker=0, start_s=0.0, seconds=1.0, task=0, k=0, carrying=False, **measures):
    """N frames one after the other; a measure is a number or (N,), and 0 where it is not named."""
    sizes = [np.size(value) for value in (seconds, task, k, carrying, *measures.values())]
    n = max(sizes) if n is None else n
    lasting = np.broadcast_to(np.asarray(seconds, float), n).copy()
    table = np.zeros((n, len(COLUMNS)))
    for name, value in measures.items():
        table[:, AT[name]] = value
    ranks = [np.broadcast_to(np.asarray(value), n).copy() for value in (0, task, 0, 0, k)]
    flags = [np.broadcast_to(np.asarray(value), n).copy() for value in (carrying, False, False)]
    begins = start_s + np.r_[0.0, np.cumsum(lasting)[:-1]][:n]
    return Frames(worker, begins, lasting, *ranks, np.full(n, 0.5), *flags, table)


def hands(up_m, forward_m=0.3, left_m=0.0, knee=0.0):
    """Measures of hands at a height and place, and of knees."""
    places = {"hands_forward_m": forward_m, "hands_left_m": left_m, "left_knee": knee, "right_knee": knee}
    return {"left_hand_up_m": up_m, "right_hand_up_m": up_m, **places}
