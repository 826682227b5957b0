"""A movement that takes another time is the same movement, at the same shares of it."""

import numpy as np
import pytest

from opsim.external_worker import library_model
from opsim.performance import Drawn
from opsim.tasks import Fixed
from opsim.tasks.variability import retimed

LIFT = library_model("bench_work/lift")
BODY = LIFT.sample(4, np.random.default_rng(1))
LONGER = retimed(BODY, BODY.duration_s * np.array([1.0, 2.0, 0.5, 3.0]))
DECODED = ("directions", "positions_m", "root_m")


@pytest.mark.parametrize("what", DECODED)
def test_at_shares_of_its_time_a_stretched_movement_is_the_movement(what):
    share = np.linspace(0, 1, 7)
    stretched = getattr(LONGER, what)(times_s=LONGER.duration_s[:, None] * share)
    assert np.allclose(stretched, getattr(BODY, what)(times_s=BODY.duration_s[:, None] * share), rtol=0, atol=1e-10)
    assert np.array_equal(getattr(LONGER, what)(n_times=7), getattr(BODY, what)(n_times=7))


@pytest.mark.parametrize("what", DECODED)
def test_the_same_times_for_all_are_times_of_the_new_duration(what):
    at_s = np.array([0.0, 0.4, 1.0])
    together = getattr(LONGER, what)(times_s=at_s)
    for row, stretch in enumerate([1.0, 2.0, 0.5, 3.0]):
        alone = getattr(BODY[row], what)(times_s=at_s / stretch)[0]
        assert np.allclose(together[row], alone, rtol=0, atol=1e-10)


def test_marks_keep_their_share_and_what_is_not_time_stays():
    assert BODY.mark_s.shape[1] > 0
    assert np.allclose(LONGER.mark_s / LONGER.duration_s[:, None], BODY.mark_s / BODY.duration_s[:, None], rtol=1e-12)
    assert LONGER.skeleton is BODY.skeleton
    assert np.array_equal(LONGER[1:].bone_length_m, BODY[1:].bone_length_m)
    assert not hasattr(retimed(Whole(BODY), LONGER.duration_s), "bone_length_m")
    assert np.array_equal(LONGER.scores, BODY.scores)


@pytest.mark.parametrize("index", [2, -1, slice(1, 3), np.array([3, 0])], ids=str)
def test_rows_can_be_taken_where_the_body_has_rows(index):
    rows = np.atleast_1d(np.arange(4)[index])
    some = LONGER[index]
    assert len(some) == len(rows)
    assert np.array_equal(some.duration_s, LONGER.duration_s[rows])
    assert np.allclose(some.mark_s, LONGER.mark_s[rows], rtol=1e-12)
    assert np.allclose(some.positions_m(n_times=5), LONGER.positions_m(n_times=5)[rows], rtol=0, atol=1e-10)


class Whole:
    """Performances without rows: the seam does not ask for them."""

    def __init__(self, block):
        self.duration_s, self.mark_s, self.positions_m = block.duration_s, block.mark_s, block.positions_m


def test_a_body_without_rows_is_decoded_whole():
    whole = retimed(Whole(BODY), LONGER.duration_s)
    assert not hasattr(type(whole), "__getitem__")
    at_s = np.linspace(0, 2, 5)
    cut = Drawn(LONGER, 1).decoded("positions_m", times_s=at_s)
    assert np.allclose(Drawn(whole, 1).decoded("positions_m", times_s=at_s), cut, rtol=0, atol=1e-10)


def test_a_stretched_time_without_a_body_has_no_postures():
    longer = retimed(Fixed(2.0).sample(3, np.random.default_rng(0)), np.full(3, 5.0))
    assert longer.mark_s.shape == longer.scores.shape == (3, 0)
    with pytest.raises(ValueError, match="no postures"):
        longer.positions_m()
