"""A fault planted in the fast engine makes its log another one than that of SimPy, on several floors."""

import pytest
from engine_evidence.mutants import HELPED, MUTANTS, found_by, make_sound_code
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


def test_the_floors_of_the_faults_are_alike_without_one():
    assert set(SHOWN_BY) == set(MUTANTS)
    assert [one.differs for one in found_by("", [HELPED])] == [""]


@pytest.mark.slow
@pytest.mark.parametrize("fault", MUTANTS)
def test_a_planted_fault_is_caught_on_its_floors(fault):
    make_sound_code(SHOWN_BY[fault])
    assert all(one.is_wrong for one in found_by(fault, SHOWN_BY[fault]))


def test_a_fault_whose_words_the_engine_has_no_more_is_told_of():
    with pytest.raises(ValueError, match="has to be written anew"):
        plant("parts.events.cancel", "event.alive = 2", "event.alive = 1")
