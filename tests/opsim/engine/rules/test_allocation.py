"""Keys by which free workers and calling stations are matched: the smallest goes first."""

import pytest

from opsim.engine.rules import ALLOCATION_RULES, more_urgent, nearer_to_its_end, whose_it_is

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
