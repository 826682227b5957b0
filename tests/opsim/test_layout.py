from itertools import pairwise
from math import hypot, inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.layout import distances_m, ways
from opsim.scenario.schema import Layout


def layout(distance="euclidean", paths=None, **places):
    told = {"distance": distance, "places": {name: [f"{x} m", f"{y} m"] for name, (x, y) in places.items()}}
    return Layout.model_validate(told if paths is None else {**told, "paths": paths})


def test_known_distances():
    assert distances_m(layout("euclidean", a=(0, 0), b=(3, 4)))[0][1] == 5.0
    assert distances_m(layout("rectilinear", a=(0, 0), b=(3, 4)))[0][1] == 7.0


def test_places_stand_in_natural_order():
    found = ways(layout(w10=(0, 0), w2=(1, 0), w1=(4, 0)))
    assert found.places == ("w1", "w2", "w10")
    assert found.distance_m[0] == (0, 3, 4)


@pytest.mark.parametrize("distance", ["euclidean", "rectilinear"])
def test_distances_are_a_metric(distance):
    points = {f"p{i}": p for i, p in enumerate(np.random.default_rng(0).normal(size=(8, 2)).round(6))}
    d = np.array(distances_m(layout(distance, **points)))
    assert np.all(np.diag(d) == 0) and np.array_equal(d, d.T)
    assert np.all(d[:, :, None] <= d[:, None, :] + d.T[None, :, :] + 1e-12)


ROOMS = {"in": (0, 0), "door": (4, 0), "bench": (4, 3), "rack": (0, 3)}


def test_along_paths_it_is_as_far_as_the_paths_are_long():
    found = ways(layout("paths", [["in", "door", "bench"]], **{name: ROOMS[name] for name in ("in", "door", "bench")}))
    a, b = found.places.index("in"), found.places.index("bench")
    assert found.distance_m[a][b] == found.distance_m[b][a] == 7.0
    assert found.way("in", "bench") == ("in", "door", "bench")
    assert found.way("bench", "in") == ("bench", "door", "in")
    assert found.way("door", "door") == ("door",)


def test_a_one_way_path_is_walked_one_way_and_round_the_other():
    paths = [["in", "door", "bench", "rack"], {"from": "rack", "to": "in", "one_way": True}]
    found = ways(layout("paths", paths, **ROOMS))
    assert found.way("rack", "in") == ("rack", "in")
    assert found.way("in", "rack") == ("in", "door", "bench", "rack")
    rank = found.places.index
    assert found.distance_m[rank("rack")][rank("in")] == 3.0
    assert found.distance_m[rank("in")][rank("rack")] == 11.0


def test_a_length_that_is_given_counts_and_the_shorter_of_two_paths_is_walked():
    found = ways(
        layout(
            "paths",
            [{"from": "a", "to": "b", "length": "12 m"}, {"from": "b", "to": "a", "length": "9 m"}],
            a=(0, 0),
            b=(1, 0),
        )
    )
    assert found.distance_m == ((0, 9), (9, 0))


def test_a_path_of_no_length_is_a_path():
    found = ways(layout("paths", [["a", "b", "c"]], a=(0, 0), b=(0, 0), c=(1, 0)))
    assert found.distance_m[0] == (0, 0, 1)
    assert found.way("a", "c") == ("a", "b", "c")


def test_where_no_path_leads_it_is_infinitely_far():
    found = ways(layout("paths", [["a", "b"]], a=(0, 0), b=(1, 0), c=(2, 0)))
    assert found.distance_m[0][2] == inf
    with pytest.raises(ValueError, match="no path leads from 'a' to 'c'"):
        found.way("a", "c")


def test_without_paths_one_walks_straight_there():
    assert ways(layout(a=(0, 0), b=(1, 0))).way("a", "b") == ("a", "b")


def naive_distances_m(points, steps):
    """Floyd and Warshall's algorithm, as it is written in books."""
    d = {(a, b): 0.0 if a == b else inf for a in points for b in points}
    for a, b, length in steps:
        d[a, b] = min(d[a, b], length)
    for k in points:
        for a in points:
            for b in points:
                d[a, b] = min(d[a, b], d[a, k] + d[k, b])
    return d


NAMES = st.sampled_from("abcdef")
PATHS = st.lists(st.tuples(NAMES, NAMES, st.booleans(), st.integers(0, 9) | st.none()), min_size=1, max_size=12)


@given(st.tuples(*[st.tuples(st.integers(0, 9), st.integers(0, 9))] * 6), PATHS)
def test_the_shortest_ways_are_the_naive_ones_and_are_as_long_as_they_say(points, drawn):
    at = dict(zip("abcdef", points))
    told, steps = [], []
    for a, b, one_way, length in drawn:
        told.append({"from": a, "to": b, "one_way": one_way} | ({} if length is None else {"length": f"{length} m"}))
        long = hypot(at[a][0] - at[b][0], at[a][1] - at[b][1]) if length is None else length
        steps += [(a, b, long)] + ([] if one_way else [(b, a, long)])
    found, naive = ways(layout("paths", told, **at)), naive_distances_m("abcdef", steps)
    shortest = {(a, b): min(long for x, y, long in steps if (x, y) == (a, b)) for a, b, _ in steps}
    for i, a in enumerate("abcdef"):
        for j, b in enumerate("abcdef"):
            assert found.distance_m[i][j] == pytest.approx(naive[a, b], abs=1e-12)
            if found.distance_m[i][j] < inf:
                passed = found.way(a, b)
                walked = sum(shortest[step] for step in pairwise(passed))
                assert walked == pytest.approx(naive[a, b], abs=1e-12)
