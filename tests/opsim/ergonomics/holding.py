"""Held postures, the naive way: every run of frames is looked at."""

from typing import NamedTuple

import numpy as np

from opsim.ergonomics.angles import AT, COLUMNS


def naive_held(value, start_s, end_s, backward, forward, band, least_s, gap_s):
    """(N,) bool: in some run longer than ``least_s`` that has no gap, nothing neutral, and no more than a band."""
    found = np.zeros(len(value), bool)
    for first in range(len(value)):
        for last in range(first, len(value)):
            run = value[first : last + 1]
            gaps = start_s[first + 1 : last + 1] - end_s[first:last]
            if not ((run > forward) | (run < -backward)).all() or (gaps > gap_s).any() or run.max() - run.min() > band:
                break
            if end_s[last] - start_s[first] > least_s:
                found[first : last + 1] = True
    return found


def naive_parts(value, seconds, band):
    """[(first, last)] of one run: the longest part within a band, then the same before and after it; in order."""
    spans = [
        (first, last)
        for first in range(len(value))
        for last in range(first + 1, len(value) + 1)
        if max(value[first:last]) - min(value[first:last]) <= band
    ]
    if not spans:
        return []
    first, last = max(spans, key=lambda span: (round(sum(seconds[slice(*span)]), 9), -span[0]))
    before = naive_parts(value[:first], seconds[:first], band)
    after = naive_parts(value[last:], seconds[last:], band)
    return [*before, (first, last), *((last + low, last + high) for low, high in after)]


class Stretch(NamedTuple):
    """Frames of one worker."""

    worker: int
    start_s: np.ndarray
    seconds: np.ndarray
    measures: np.ndarray


def frames(value_deg, seconds=1.0, start_s=0.0, worker=0, column="trunk_flexion"):
    """Frames one after the other, neutral but for one measure."""
    value_deg = np.asarray(value_deg, float)
    lasting = np.broadcast_to(np.asarray(seconds, float), value_deg.shape).copy()
    measures = np.zeros((value_deg.size, len(COLUMNS)))
    measures[:, AT[column]] = value_deg
    return Stretch(
        worker, start_s + np.r_[0.0, np.cumsum(lasting)[:-1]] if value_deg.size else lasting, lasting, measures
    )
