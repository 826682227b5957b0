"""Who walks and what moves meet where simple arithmetic says."""

import pytest

from opsim.engine.rules import INFINITE_S, meeting_s, strolled_m, together_s


def test_a_job_that_comes_towards_a_worker_is_met_at_the_sum_of_the_speeds():
    assert meeting_s(-6.5, 1.2, 0.1) == pytest.approx(5.0)
    assert meeting_s(-6.0, 1.2, 0.0) == pytest.approx(5.0)


def test_one_that_moves_away_is_met_at_the_difference_or_never():
    assert meeting_s(5.5, 1.2, 0.1) == pytest.approx(5.0)
    assert meeting_s(5.5, 0.1, 0.1) == INFINITE_S
    assert meeting_s(0.0, 0.1, 0.1) == 0.0


def test_who_walks_back_waits_where_he_may_begin():
    assert strolled_m(6.0, 1.0, 1.0, 3.0) == 3.0
    assert strolled_m(6.0, 1.0, 1.0, 8.0) == 1.0


def test_two_alike_take_half_the_time_and_never_more_than_one():
    assert together_s(10.0, 10.0) == 5.0
    assert together_s(10.0, 30.0) == pytest.approx(7.5)
