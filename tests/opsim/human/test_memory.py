import pytest

from opsim.human.forgetting import LearnForgetCurve, Memory
from opsim.human.learning import Wright

HALF = Wright(0.5**0.5)


def memory(forgetting, experience=()):
    return Memory(HALF, forgetting, experience, lambda _task: 1.0)


def test_repetitions_that_came_to_something_are_counted_from_those_behind_him():
    """His 201st; then, as the next is broken off in the instant in which it begins, the 202nd is another one."""
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (0.0, 200.0))
    assert mine.begins(1, 0, 0.0) == 201.0
    mine.works(0.0, 1, 0, 5.0)
    assert mine.begins(1, 1, 5.0) == 202.0
    mine.works(5.0, 1, 1, 10.0)
    mine.stops(5.0)
    assert [mine.begins(1, 2, 5.0), mine.begins(0, 0, 9.0)] == [202.0, 1.0]


def test_to_go_on_with_what_was_begun_is_no_repetition_more():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0))
    assert mine.begins(0, 0, 0.0) == 1.0
    mine.works(0.0, 0, 0, 5.0)
    mine.stops(2.0)
    assert mine.begins(0, 1, 2.0) == 2.0  # it comes to nothing
    mine.works(3.0, 0, 0, 6.0)
    assert mine.begins(0, 2, 6.0) == 2.0


def test_a_pause_takes_what_the_model_says_by_hand():
    """100 behind him, a pause of 180: 10 are left (tests of forgetting), so the next is the eleventh."""
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    assert mine.begins(0, 0, 0.0) == 100.0
    mine.works(0.0, 0, 0, 5.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_a_pause_begins_where_he_was_broken_off():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 500.0)
    mine.stops(5.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_work_at_another_task_does_not_shorten_the_pause():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0, 0.0))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 5.0)
    mine.begins(1, 0, 5.0)
    mine.works(5.0, 1, 0, 180.0)
    assert mine.begins(0, 1, 185.0) == pytest.approx(11.0)


def test_a_short_pause_costs_nothing():
    mine = memory(LearnForgetCurve(forgotten_in_s=1980.0, least_pause_s=60.0), (99.0,))
    mine.begins(0, 0, 0.0)
    mine.works(0.0, 0, 0, 5.0)
    assert mine.begins(0, 1, 64.0) == 101.0
