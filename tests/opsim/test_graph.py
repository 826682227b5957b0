from hypothesis import given
from hypothesis import strategies as st

from opsim.layout import reached, reverse, rings

GRAPHS = st.dictionaries(st.sampled_from("abcdef"), st.sets(st.sampled_from("abcdef")))


def naive_reached(graph, start):
    """Everything that a way of at least one step leads to."""
    found = set(graph.get(start, ()))
    while more := {far for near in found for far in graph.get(near, ())} - found:
        found |= more
    return found


@given(GRAPHS, st.sampled_from("abcdef"))
def test_reached_is_the_start_and_all_ways_from_it(graph, start):
    assert reached(graph, [start]) == {start} | naive_reached(graph, start)


@given(GRAPHS)
def test_a_ring_is_all_that_lead_to_each_other(graph):
    ways = {name: naive_reached(graph, name) for name in "abcdef"}
    expected = {frozenset(b for b in ways[a] if a in ways[b]) for a in "abcdef" if a in ways[a]}
    found = list(rings(graph))
    assert {frozenset(ring) for ring in found} == expected
    assert sum(map(len, found)) == len(set().union(*found))


@given(GRAPHS)
def test_there_and_back_is_the_same_graph(graph):
    steps = {(a, b) for a, onward in graph.items() for b in onward}
    assert {(b, a) for a, onward in reverse(graph).items() for b in onward} == steps


def test_a_long_line_has_no_ring_and_needs_no_recursion():
    line = {f"s{n}": [f"s{n + 1}"] for n in range(5000)}
    assert list(rings(line)) == []
    assert list(rings({**line, "s5000": ["s0"]})) == [{f"s{n}" for n in range(5001)}]


def test_what_is_left_out_is_not_passed_through():
    assert reached({"a": ["b"], "b": ["c"]}, ["a"], without={"b"}) == {"a"}
