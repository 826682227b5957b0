"""A fault in the one source of the floor is caught, though both drivers read it and may well agree."""

import pytest
from engine_evidence.mutants import make_sound_code
from engine_evidence.one_source import FAULTS, FLOORS, caught

CAUGHT_BY = {
    "wrong_tie": {"twins", "golden"},
    "stale_timeout": {"twins", "golden"},
    "lost_interruption": {"twins", "audit", "sanitizer"},
    "begun_twice": {"twins", "audit", "sanitizer"},
    "one_too_many": {"twins"},
    "used_after": {"sanitizer"},
}
"""Judges that ``python -m engine_evidence.one_source`` found to catch a fault."""


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_caught(fault):
    make_sound_code(FLOORS)
    assert CAUGHT_BY[fault] <= set(caught(fault))


@pytest.mark.slow
def test_no_judge_says_anything_of_the_sound_source():
    make_sound_code(FLOORS)
    assert caught("") == {}
