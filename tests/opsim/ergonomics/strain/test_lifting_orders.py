"""The composite index over every order of its lifts."""

from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.lifting_pattern import Kind, composite_range, least_multiplier
from opsim.ergonomics.strain.niosh import composite_index


def kind(low, high, per_min, cm=80.0):
    return Kind((low, high), per_min, (cm,), (cm,))


def test_a_job_of_which_all_is_known_has_one_index():
    """1.5 / FM(1), FM(1) = 0.94; and 0.5 x (1 / FM(3) - 1 / FM(1)), FM(3) = 0.88; as they are given is no matter."""
    found = composite_range([kind(0.5, 0.5, 2.0), kind(1.5, 1.5, 1.0)], [1])
    assert found == pytest.approx([1.5 / 0.94 + 0.5 * (1 / 0.88 - 1 / 0.94)] * 2)


def test_the_most_is_more_than_that_of_the_order_of_all_mosts():
    """Two lifts of index 1 to 1.1: the seldom one first adds the frequent one at its steep place, and is worse."""
    kinds = [kind(1.0, 1.1, 9.0), kind(1.0, 1.05, 2.0)]
    low, high = composite_range(kinds, [8])
    by_mosts = composite_index([1.1, 1.05], [9.0, 2.0], [80.0, 80.0], 8, least=least_multiplier(8))
    assert low < by_mosts < high


kinds = st.lists(
    st.tuples(st.floats(0.1, 2), st.floats(0, 1), st.floats(0.1, 6), st.sampled_from([30.0, 90.0])),
    min_size=1, max_size=4,
)  # fmt: skip


@given(kinds, st.floats(0, 1), st.sampled_from([1, 2, 8]))
def test_no_index_of_a_job_within_the_intervals_is_outside(drawn, share, hours):
    """Twin: the index of a job with indices somewhere between, in its own order."""
    made = [kind(low, low + more, often, cm) for low, more, often, cm in drawn]
    least, most = composite_range(made, [1, 2, 8])
    inside = [(low + share * more, often, cm) for low, more, often, cm in drawn]
    least_fm = least_multiplier(hours)
    alone = [composite_index([f], [often], [cm], hours, least=least_fm) for f, often, cm in inside]
    order = sorted(range(len(made)), key=lambda at: -alone[at])
    found = composite_index(*_columns(inside, order), hours, least=least_fm)
    assert least - 1e-9 <= found <= most + 1e-9


def _columns(inside, order):
    return tuple([inside[at][column] for at in order] for column in range(3))


@given(kinds)
def test_the_search_finds_what_all_permutations_find_where_any_order_may_be(drawn):
    """Twin over all permutations; intervals so wide that none is ruled out."""
    made = [kind(0.0, low + 10.0, often, cm) for low, _, often, cm in drawn]
    every = [
        composite_index(*_columns([(k.fili[1], k.per_min, k.any_cm[0]) for k in made], order), 8, least=0.13)
        for order in permutations(range(len(made)))
    ]
    assert composite_range(made, [8]) == (0.0, pytest.approx(max(every)))
