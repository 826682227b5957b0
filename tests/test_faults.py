"""A planted fault is seen: each of ``mutants.faults`` by the tests it names, which ``make test`` runs."""

from collections import Counter

import pytest
from mutants.faults import FAULTS
from mutants.plant import catchers_of, copy_to, is_caught, place_of

SUBJECTS = {"floor", "figures", "study", "emulator", "ergonomics", "readers"}


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    return copy_to(tmp_path_factory.mktemp("copy"))


def test_forty_faults_are_spread_over_the_house():
    assert len(set(FAULTS)) == len(FAULTS) >= 40
    spread = Counter(fault.subject for fault in FAULTS)
    assert set(spread) == SUBJECTS and min(spread.values()) >= 3


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_where_a_fault_goes_and_who_sees_it_is_there(fault):
    assert place_of(fault).is_file() and catchers_of(fault)


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_planted_fault_is_caught(fault, copy):
    assert is_caught(fault, copy)
