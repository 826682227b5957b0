import numpy as np
import pytest

from opsim.study.long_run.diagnostics import beyond_luck, growth
from tests.opsim.study.long_run.waits import mm1_waits


def test_a_straight_line_grows_by_what_it_grows():
    by, p = growth(np.arange(1000.0))
    assert by == pytest.approx(1000) and p == 0
    assert growth(np.full(100, 3.0)) == (0.0, 1.0) and growth(-np.arange(1000.0))[1] == 1


@pytest.mark.parametrize("replications", [1, 5])
def test_luck_at_a_load_of_one_is_hardly_ever_taken_for_more(replications):
    """M/M/1 from empty, 4,000 customers, 300 times: at most 2 in 100."""
    made = np.reshape([mm1_waits(1.0, 4000, seed) for seed in range(300 * replications)], (300, replications, 4000))
    assert sum(beyond_luck(rows) for rows in made) <= 6


@pytest.mark.parametrize("load", [0.8, 0.95])
def test_a_stable_queue_is_never_beyond_luck(load):
    assert not any(beyond_luck(mm1_waits(load, 2000, seed)) for seed in range(300))


def test_an_overloaded_queue_is_beyond_luck_in_a_long_run():
    assert sum(beyond_luck(mm1_waits(1.1, 20_000, seed)) for seed in range(50)) >= 48


def test_a_steady_climb_is_beyond_luck_and_a_constant_or_a_fall_is_not():
    climb = np.arange(400.0)
    assert beyond_luck(climb) and beyond_luck([climb, climb + 1])
    assert not beyond_luck(-climb) and not beyond_luck(np.ones(400)) and not beyond_luck([1.0, 2.0, 9.0])
