"""Circles of waiting, in graphs small enough to see through."""

from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.wait_graph import Pool, circles, stuck


def held_by(*holders, free=0):
    return Pool("it", free, dict.fromkeys(holders, 1))


TWO = {"a": held_by("b"), "b": held_by("a")}
"""a and b have each what the other wants."""


def want(*names):
    return (tuple((name, 1) for name in names),)


def test_two_who_want_what_the_other_has_are_stuck():
    waits = {"a": want("a"), "b": want("b")}
    assert stuck(waits, TWO) == {"a", "b"}
    assert list(circles(waits, TWO)) == [({"a", "b"}, [("a", "a"), ("b", "b")])]


def test_one_free_unit_is_enough():
    assert stuck({"a": want("a"), "b": want("b")}, {**TWO, "b": held_by("a", free=1)}) == set()


def test_another_way_out_is_enough():
    pools = {**TWO, "door": held_by(free=1)}
    assert stuck({"a": want("a"), "b": want("b") + want("door")}, pools) == set()


def test_all_of_one_way_is_needed():
    pools = {**TWO, "door": held_by(free=1)}
    assert stuck({"a": want("a"), "b": want("b", "door")}, pools) == {"a", "b"}


def test_somebody_who_waits_for_nothing_gives_back():
    assert stuck({"a": want("it")}, {"it": held_by("z")}) == set()


def test_two_units_are_more_than_one():
    pools = {"it": Pool("it", 0, {"z": 1, "a": 1})}
    assert stuck({"a": ((("it", 1),),)}, pools) == set()
    assert stuck({"a": ((("it", 2),),)}, pools) == {"a"}


def test_who_waits_for_a_circle_is_stuck_and_not_of_it():
    waits = {"a": want("a"), "b": want("b"), "c": want("b")}
    assert stuck(waits, TWO) == {"a", "b", "c"}
    assert [ring for ring, _ in circles(waits, TWO)] == [{"a", "b"}]


def test_who_waits_for_what_nobody_has_starves_and_is_no_circle():
    waits, pools = {"a": want("gone")}, {"gone": held_by()}
    assert stuck(waits, pools) == {"a"} and list(circles(waits, pools)) == []


def test_the_shortest_circle_is_told():
    pools = {"a": held_by("b", "c"), "b": held_by("c"), "c": held_by("a")}
    waits = {name: want(name) for name in "abc"}
    ((ring, circle),) = circles(waits, pools)
    assert ring == {"a", "b", "c"} and circle == [("a", "a"), ("c", "c")]


def test_a_circle_that_waits_for_another_is_not_told():
    pools = {**TWO, "c": held_by("d", "a"), "d": held_by("c")}
    waits = {name: want(name) for name in "abcd"}
    assert [ring for ring, _ in circles(waits, pools)] == [{"a", "b"}]


NAMES = "abcde"
WAITS = st.dictionaries(
    st.sampled_from(NAMES),
    st.lists(st.lists(st.tuples(st.sampled_from("xyz"), st.integers(1, 2)), max_size=2).map(tuple), max_size=2),
)
POOLS = st.fixed_dictionaries(
    {
        name: st.builds(
            Pool, st.just(name), st.integers(0, 1), st.dictionaries(st.sampled_from(NAMES), st.integers(1, 2))
        )
        for name in "xyz"
    }
)


@given(WAITS, POOLS)
def test_who_is_stuck_is_stuck_by_definition_and_nobody_else(waits, pools):
    """The set keeps itself stuck, and each who is not in it is let go by some who went before."""
    left = stuck(waits, pools)

    def can_go(who, still):
        def room(name):
            return pools[name].free + sum(n for other, n in pools[name].holders.items() if other not in still)

        return any(all(room(name) >= n for name, n in way) for way in waits[who])

    assert not any(can_go(who, left) for who in left)
    still = set(waits)
    while still != left:
        gone = {who for who in still - left if can_go(who, still)}
        assert gone
        still -= gone


@given(WAITS, POOLS)
def test_each_of_a_circle_waits_for_something_that_the_next_has(waits, pools):
    for ring, circle in circles(waits, pools):
        names = [who for who, _ in circle]
        assert set(names) <= ring and len(set(names)) == len(names)
        for (who, pool), after in zip(circle, [*names[1:], names[0]]):
            assert pool in {name for way in waits[who] for name, _ in way}
            assert after in pools[pool].holders
