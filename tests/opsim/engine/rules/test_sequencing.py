"""Keys of waiting jobs: every rule takes the same numbers, and ends in the job's own."""

import inspect

import pytest

from opsim.engine.rules import ROUTING_RULES, SEQUENCING_RULES, critical_ratio, may_preempt, queue_key, victim_key


@pytest.mark.parametrize("rules", [SEQUENCING_RULES, ROUTING_RULES], ids=["sequencing", "routing"])
def test_all_rules_take_the_same_numbers_and_end_in_a_natural_rank(rules):
    names = {tuple(inspect.signature(rule).parameters) for rule in rules.values()}
    assert len(names) == 1
    numbers = [float(2 + n) for n in range(len(names.pop()))]
    keys = [rule(*numbers) for rule in rules.values()]
    assert len({key[-1] for key in keys}) == 1 and keys[0][-1] in numbers


def test_a_late_job_comes_before_one_in_time_and_one_without_a_due_date_last():
    late, in_time, never = (
        critical_ratio(100, 0, 5, 20, 2, due, 0, n) for n, due in enumerate((90, 130, float("inf")))
    )
    assert late < in_time < never


def test_a_job_without_work_left_has_its_slack_as_ratio():
    assert critical_ratio(100, 0, 0, 0, 0, 103, 0, 7) == (3, 0, 7)


def test_priority_then_what_was_interrupted_then_the_rule():
    order = [queue_key(1, False, 9.0), queue_key(0, True, 9.0), queue_key(0, False, 1.0), queue_key(-1, True, 0.0)]
    assert sorted(order) == order


def test_only_a_lower_priority_gives_way_the_lowest_first_then_the_one_begun_last():
    assert may_preempt(2, 1) and not may_preempt(1, 1)
    assert min([(1, 0.0, 1), (0, 5.0, 2), (0, 7.0, 3)], key=lambda job: victim_key(*job)) == (0, 7.0, 3)
