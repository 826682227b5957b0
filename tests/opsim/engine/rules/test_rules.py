"""Keys by which free workers and calling stations are matched: the smallest goes first.

The rules by which people leave: who works on, for whom the rest is kept, and what is lost.

Who walks and what moves meet where simple arithmetic says.

Keys of waiting jobs: every rule takes the same numbers, and ends in the job's own.
"""

import inspect

import pytest

from opsim.engine.rules import (
    ALLOCATION_RULES,
    INFINITE_S,
    INTERRUPTION_RULES,
    ROUTING_RULES,
    SEQUENCING_RULES,
    critical_ratio,
    first_relief,
    is_absent,
    is_kept_for_him,
    is_lost,
    may_preempt,
    meeting_s,
    more_urgent,
    nearer_to_its_end,
    pause_lasts_s,
    queue_key,
    stays_on,
    strolled_m,
    together_s,
    victim_key,
    whose_it_is,
    works_on,
)
from opsim.subjects.shifts.words import RULES

A = {"n_waiting": 3, "oldest_since_s": 20.0, "walk_s": 8.0, "rating": 1.0, "station_rank": 0, "worker_rank": 0}
B = {"n_waiting": 1, "oldest_since_s": 20.0, "walk_s": 8.0, "rating": 1.0, "station_rank": 1, "worker_rank": 1}
BETTER = {"longest_queue": "n_waiting", "nearest": "walk_s", "oldest_job": "oldest_since_s", "best_skill": "rating"}


def key(rule, pair):
    return ALLOCATION_RULES[rule](*pair.values())


@pytest.mark.parametrize(("rule", "by"), BETTER.items())
def test_a_rule_looks_at_one_thing_first(rule, by):
    worse_elsewhere = {"n_waiting": 1, "oldest_since_s": 90.0, "walk_s": 90.0, "rating": 0.1}
    better = {"n_waiting": 4, "oldest_since_s": 1.0, "walk_s": 0.0, "rating": 1.5}[by]
    winner = {**A, **worse_elsewhere, by: better, "station_rank": 5, "worker_rank": 5}
    assert key(rule, winner) < key(rule, A)


@pytest.mark.parametrize("rule", ALLOCATION_RULES)
def test_natural_order_breaks_ties(rule):
    same = {**B, "n_waiting": 3}
    assert key(rule, A) < key(rule, same)
    assert key(rule, {**A, "worker_rank": 4}) > key(rule, A)


def test_own_stations_come_before_floaters_and_higher_priorities_before_lower():
    assert whose_it_is(False, False) < whose_it_is(False, True) < whose_it_is(True, False) < whose_it_is(True, True)
    assert more_urgent(2) < more_urgent(0) < more_urgent(-1)
    assert nearer_to_its_end(1.0) < nearer_to_its_end(2.5)


def _those(rule, *asked):
    return {name for name, number in INTERRUPTION_RULES.items() if rule(number, *asked)}


def test_every_rule_of_the_language_has_a_number_of_its_own():
    assert set(INTERRUPTION_RULES) == set(RULES.__args__)
    assert len(set(INTERRUPTION_RULES.values())) == len(INTERRUPTION_RULES)


def test_three_rules_let_him_work_on_and_three_do_not():
    assert _those(works_on, True, True) == {"finish", "finish_job", "hand_over"}


def test_what_begins_at_the_very_instant_is_not_begun_but_for_the_rest_of_a_job():
    assert _those(works_on, False, True) == {"finish_job"}
    assert _those(works_on, False, False) == set()


def test_the_rest_is_kept_for_him_only_where_there_is_a_rest_and_only_by_one_rule():
    assert _those(is_kept_for_him, 0.3) == {"resume"} and _those(is_kept_for_him, 0.0) == set()
    assert _those(is_lost) == {"restart"}


def test_a_pause_keeps_its_length_and_the_longest_wait_is_relieved_first():
    assert pause_lasts_s(3600.0, 4500.0) == 900.0
    assert min((first_relief(5.0, 0), first_relief(4.0, 2), first_relief(4.0, 1))) == (4.0, 1)


def test_absence_is_a_share_and_overtime_needs_a_need():
    assert is_absent(0.049, 0.05) and not is_absent(0.05, 0.05) and not is_absent(0.0, 0.0)
    assert stays_on(True, 1.0) and not stays_on(True, 0.0) and not stays_on(False, 1.0)


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
