"""Frames booked into a ledger: the sums of a plain loop, whatever stretches they came in."""

from collections import defaultdict
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.shift.frames import WAITING, Frames
from opsim.ergonomics.shift.ledger import BINS, KEY, Booking

HOUR_S = 3600.0


def frames(worker, start_s, seconds, station, task, product, trunk, arms, row=None):
    """N frames; arms (N, 2) degrees of elevation, left and right."""
    n = len(seconds)
    measures = np.full((n, len(COLUMNS)), np.nan, np.float32)
    measures[:, AT["trunk_flexion"]] = trunk
    measures[:, [AT["left_arm_elevation"], AT["right_arm_elevation"]]] = arms
    none = np.zeros(n, bool)
    ranks = (np.asarray(column, np.int32) for column in (station, task, product))
    row = np.arange(n) if row is None else np.asarray(row)
    times = np.asarray(start_s, float), np.asarray(seconds, float)
    return Frames(worker, *times, *ranks, row, np.zeros(n, int), np.zeros(n), none, none, none, measures)


def scores(rula, reba, owas):
    """Each (N, 2)."""
    return SimpleNamespace(**{k: np.asarray(v, np.int8) for k, v in {"rula": rula, "reba": reba, "owas": owas}.items()})


def naive(stretches, start_s):
    """The definition: (name, bin or None where not known) -> seconds, of each key, frame after frame."""
    found = defaultdict(float)
    for some, of in stretches:
        for i in range(len(some)):
            hour = int((start_s + some.start_s[i]) // HOUR_S) % 24
            key = (some.worker, int(some.station[i]), int(some.task[i]), int(some.product[i]), hour)
            for name in ("rula", "reba", "owas"):
                for bound, ending in ((0, ""), (1, "_at_most")):
                    found[key, name + ending, int(getattr(of, name)[i][bound]) or None] += some.seconds[i]
            found[key, "trunk", _degree(some.measures[i, AT["trunk_flexion"]])] += some.seconds[i]
            arms = [some.measures[i, AT[f"{side}_arm_elevation"]] for side in ("left", "right")]
            known = [arm for arm in arms if not np.isnan(arm)]
            found[key, "arm", _degree(max(known)) if known else None] += some.seconds[i]
    return {of: seconds for of, seconds in found.items() if seconds}


def _degree(angle):
    return None if np.isnan(angle) else int(np.floor(angle))


def told(ledger):
    """The same of a ledger."""
    found = {}
    for at, key in enumerate(ledger.key.tolist()):
        for name, bins in ledger.bins.items():
            for column in np.flatnonzero(bins[at]).tolist():
                found[tuple(key), name, BINS[name].first + column - 1 if column else None] = float(bins[at, column])
    return found


EIGHTHS = st.integers(1, 200).map(lambda n: n / 8)
ANGLE = st.one_of(st.just(float("nan")), st.integers(-179, 178).map(lambda n: n + 0.25))
ARM = st.one_of(st.just(float("nan")), st.integers(0, 179).map(lambda n: n + 0.5))
PAIR = st.integers(0, 4).flatmap(lambda low: st.tuples(st.just(low), st.integers(low, 4) if low else st.just(0)))
ONE = st.tuples(EIGHTHS, *(st.integers(-1, 2),) * 3, ANGLE, ARM, ARM, PAIR, PAIR, PAIR, st.booleans())


@st.composite
def stretch(draw):
    """Frames within an hour of the clock, seconds whole eighths, so that every sum is exact."""
    drawn = draw(st.lists(ONE, min_size=1, max_size=20))
    seconds, station, task, product, trunk, left, right, rula, reba, owas, same = zip(*drawn)
    row = np.cumsum(~np.array(same))
    first = np.searchsorted(row, row)
    station, task, product = (np.array(column)[first] for column in (station, task, product))
    start_s = draw(st.integers(0, 40)) * HOUR_S + np.cumsum(seconds) / 8
    arms = np.stack([left, right], axis=1)
    some = frames(draw(st.integers(0, 2)), start_s, seconds, station, task, product, trunk, arms, row)
    return some, scores(rula, reba, owas)


@settings(max_examples=40, deadline=None)
@given(st.lists(stretch(), max_size=6))
def test_the_ledger_is_the_plain_loop_to_the_last_bit(stretches):
    booking = Booking(start_s=5 * HOUR_S)
    for some, of in stretches:
        booking.add(some, of)
    assert told(booking.close()) == naive(stretches, 5 * HOUR_S)


def by_hand():
    booking = Booking(start_s=23 * HOUR_S)
    known = [[3, 5], [6, 7], [7, 7]]
    first = frames(0, [0, 10, 30], [10, 20, 5], [0, 0, 1], [0, 0, 2], [0, 0, 0], [10, 65, np.nan], [[5, 61]] * 3)
    booking.add(first, scores(known, [[1, 1], [8, 9], [0, 0]], [[1, 3]] * 3))
    late = frames(1, [HOUR_S], [100], [-1], [WAITING], [-1], [np.nan], [[np.nan, np.nan]])
    booking.add(late, scores([[0, 0]], [[0, 0]], [[0, 0]]))
    return booking.close()


def test_seconds_from_a_score_or_an_angle_on_are_what_the_hand_finds():
    ledger = by_hand()
    assert ledger.key.tolist() == [[0, 0, 0, 0, 23], [0, 1, 2, 0, 23], [1, -1, WAITING, -1, 0]]
    assert ledger.seconds.tolist() == [30, 5, 100] and ledger.unmeasured_s.tolist() == [0, 0, 100]
    assert ledger.from_s("rula", 5).tolist() == [20, 5, 0] and ledger.from_s("rula_at_most", 5).tolist() == [30, 5, 0]
    assert ledger.from_s("reba", 8).tolist() == [20, 0, 0] and ledger.from_s("owas_at_most", 3).tolist() == [30, 5, 0]
    assert ledger.from_s("trunk", 60).tolist() == [20, 0, 0] and ledger.from_s("arm", 60).tolist() == [30, 5, 0]
    assert ledger.score_seconds("rula").tolist() == [3 * 10 + 6 * 20, 7 * 5, 0]


@pytest.mark.parametrize("column", KEY)
def test_cells_put_together_by_any_column_sum_to_all(column):
    ledger = by_hand()
    values = np.unique(ledger.key[:, KEY.index(column)])
    by, all_of = ledger.by(column, values), ledger.together()
    for name, bins in by.bins.items():
        assert np.array_equal(bins.sum(axis=0), all_of.bins[name][0])
    assert ledger.by(column, np.array([77])).seconds.tolist() == [0]


def test_an_empty_ledger_has_no_time():
    ledger = Booking().close()
    assert ledger.seconds.shape == (0,) and ledger.together().seconds.tolist() == [0]
    assert ledger.by("worker", np.arange(2)).from_s("rula", 5).tolist() == [0, 0]
