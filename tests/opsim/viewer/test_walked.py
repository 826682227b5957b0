import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from made_scene import scene

from opsim.viewer.playback import DRAWN_S, stand_ins

WALKS = st.lists(st.tuples(st.integers(0, 2), st.sampled_from([1.0, 2.0, 2.001, 7.5, 30.0])), max_size=60)


@given(WALKS, st.sampled_from([1.0, 40.0, 400.0]))
def test_walks_are_shown_by_one_of_the_same_person_about_as_long(walks, whole_s):
    worker, long_m = np.array([w for w, _ in walks], int), np.array([m for _, m in walks])
    shown = stand_ins(worker, long_m, np.full(long_m.size, whole_s))
    assert np.array_equal(worker[shown], worker)
    assert np.all(np.abs(np.log(long_m[shown] / long_m)) < 0.3)
    assert np.array_equal(shown[shown], shown)
    if long_m.size * whole_s <= DRAWN_S:
        assert np.array_equal(shown, np.arange(long_m.size))


def test_walks_are_as_long_as_their_ways():
    """So that feet do not slide: drawn over the way between the spots, or stretched by a hundredth at most."""
    shown = scene("two_shift_plant")
    ways = [way for way in np.unique(shown.segments.way) if way >= 0]
    long_m = np.array([np.hypot(*np.diff(shown.ways.points_m(way), axis=0).T).sum() for way in ways])
    assert np.all(np.abs(np.log(long_m / shown.ways.own_m[ways])) < 0.011)
