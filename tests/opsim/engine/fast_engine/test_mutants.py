"""A fault planted in the fast engine makes its log another one than that of SimPy, on several floors."""

import pytest
from engine_evidence.mutants import CONTROL, HELPED, MUTANTS, found_by, make_sound_code
from engine_evidence.planted import plant

SHOWN_BY = {
    "wrong_tie": (388, 411, 545),
    "stale_timeout": (86, 101, 187),
    "lost_interruption": (86, 101, 187),
    "last_who_waits": (11, 235, 559),
    "late_breaks": (86, 101, 411),
    "rest_of_two": (HELPED,),
}
"""Floors that ``python -m engine_evidence.mutants`` found to show a fault."""


def wrong(fault, floors):
    return [one for one in found_by(fault, floors) if one.is_wrong]


def test_every_fault_has_floors_that_show_it():
    assert set(SHOWN_BY) == set(MUTANTS)


@pytest.mark.slow
def test_without_a_fault_the_engine_is_right_also_where_its_own_words_are_planted():
    assert wrong("", [HELPED]) == wrong(CONTROL, [HELPED]) == []


@pytest.mark.slow
@pytest.mark.parametrize("fault", MUTANTS)
def test_a_planted_fault_is_caught_on_its_floors(fault):
    make_sound_code(SHOWN_BY[fault])
    found = wrong(fault, SHOWN_BY[fault])
    assert len(found) == len(SHOWN_BY[fault]) and any(one.differs for one in found)


def test_a_fault_whose_words_the_engine_has_no_more_is_told_of():
    with pytest.raises(ValueError, match="has to be written anew"):
        plant("routing.cancel", "event.alive = 2", "event.alive = 1")
