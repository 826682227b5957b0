"""The rules by which people leave: who works on, for whom the rest is kept, and what is lost."""

from opsim.engine.rules import (
    INTERRUPTION_RULES,
    first_relief,
    is_absent,
    is_kept_for_him,
    is_lost,
    pause_lasts_s,
    stays_on,
    works_on,
)
from opsim.scenario.schema.shifts import RULES


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
