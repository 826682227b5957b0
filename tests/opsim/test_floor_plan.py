"""Who is at which post: by turns, with people missing, with people who cannot do everything.

Every second of every worker is accounted for, with a place; a hole, a jump or a place that is missing is found.
"""

import random
from itertools import pairwise, permutations
from math import hypot, inf
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import plan, ran

from emulator.covariates.body import RANGES
from emulator.people.new_people import BODY_KEYS as EMULATOR_KEYS
from opsim.external_worker import library_model
from opsim.history import NOWHERE, unaccounted, whereabouts
from opsim.layout import distances_m, given_out, reached, reverse, rings, turns_away, ways
from opsim.log import EventLog
from opsim.scenario.schema import Layout
from opsim.subjects.people.plan import Body
from opsim.task_model import BODY_KEYS, BODY_RANGES, keys_read
from opsim.tasks import Fixed, Lognormal, switched


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


def by_turns(n_posts, people, turn, can=lambda person, post: True):
    place = {person: number for number, person in enumerate(people)}
    n_slots = max(n_posts, len(people))
    return given_out(n_posts, people, can, lambda p, slot: (turns_away(place[p], turn, slot, n_slots), p))


def test_everybody_moves_up_by_one_post_and_the_last_to_the_first():
    assert [by_turns(3, [0, 1, 2], turn) for turn in range(4)] == [
        {0: 0, 1: 1, 2: 2},
        {0: 1, 1: 2, 2: 0},
        {0: 2, 1: 0, 2: 1},
        {0: 0, 1: 1, 2: 2},
    ]


def test_more_people_than_posts_are_two_at_the_first_ones_and_all_come_to_all_posts():
    assert by_turns(2, [0, 1, 2], 0) == {0: 0, 1: 1, 2: 0}
    assert by_turns(3, [0, 1, 2, 3, 4], 0) == {0: 0, 1: 1, 2: 2, 3: 0, 4: 1}
    assert [by_turns(2, [0, 1, 2], turn)[0] for turn in range(6)] == [0, 1, 0, 0, 1, 0]


def test_fewer_people_than_posts_go_on_to_the_empty_ones():
    assert [by_turns(2, [7], turn) for turn in range(3)] == [{7: 0}, {7: 1}, {7: 0}]
    assert [by_turns(3, [0, 1], turn) for turn in range(3)] == [{0: 0, 1: 1}, {0: 1, 1: 2}, {0: 2, 1: 0}]


def test_who_is_missing_leaves_no_post_empty_while_another_one_is_double():
    """Of four the second is missing: three men for three posts."""
    for turn in range(6):
        assert sorted(by_turns(3, [0, 2, 3], turn).values()) == [0, 1, 2]


def test_a_post_goes_to_somebody_who_can_even_where_another_one_has_to_move_for_him():
    """By turns the first is at post 0, where the second would be alone able to go."""
    assert by_turns(2, [0, 1], 0, lambda person, post: person == 0 or post == 0) == {1: 0, 0: 1}


def test_who_can_be_nowhere_has_no_post():
    assert by_turns(2, [0, 1], 0, lambda person, post: person == 1) == {1: 1}


def test_as_many_posts_are_manned_as_can_be_and_the_first_ones_first():
    """Against trying all ways to give the posts out, in 300 random cases; where fewer people can do anything
    than there are posts, it is those whose turn it is."""
    rng = random.Random(4)
    for _ in range(300):
        n_posts, n_people = rng.randint(1, 3), rng.randint(3, 5)
        can = {(p, post) for p in range(n_people) for post in range(n_posts) if rng.random() < 0.4}
        at = by_turns(n_posts, list(range(n_people)), rng.randint(0, 5), lambda p, post: (p, post) in can)  # noqa: B023
        assert all((p, post) in can for p, post in at.items())
        assert set(at) == {p for p, _ in can}
        best = max(
            tuple((p, post) in can for post, p in enumerate(way)) for way in permutations(range(n_people), n_posts)
        )
        manned = tuple(post in at.values() for post in range(n_posts))
        assert sum(manned) == sum(best)
        assert manned == best or len(at) < n_posts


TEXT = """
opsim: 1
name: places
run: {start: Mon 06:00, horizon: 5 h}
layout: {places: {in: [0 m, 0 m], bench: [60 m, 0 m], canteen: [0 m, 90 m]}}
shifts: {day: {from: 06:30, to: 10:00, breaks: {tea: {at: 08:00, lasts: 15 min, place: canteen}}}}
tasks: {t: {dist: lognormal, mean: 90 s, cv: 0.3}}
stations: {a: {at: in, tasks: [t]}, b: {at: bench, tasks: [t], buffer: 5}}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 4 min}
workers: {ana: {shift: day, skills: {a: 1.0, b: 1.0}}, ben: {skills: {b: 1.0}}}
"""


@pytest.fixture(scope="module")
def run():
    return ran(TEXT)


def changed(log, row, **values):
    columns = {name: column.copy() for name, column in log.columns.items()}
    for name, value in values.items():
        columns[name][row] = value
    return EventLog(log.replication, log.horizon_s, columns, log.names)


def test_the_whereabouts_of_a_worker_cover_the_run_and_hang_together(run):
    log, p = run
    assert list(unaccounted(log, p)) == []
    seen = whereabouts(log, p)
    for rank in range(2):
        own = seen.worker == rank
        assert (seen.end_s - seen.start_s)[own].sum() == p.horizon_s
    assert seen.start_s.size == seen.row.size == np.unique(seen.row).size


def test_who_is_off_is_nowhere_and_who_rests_in_the_canteen_is_there(run):
    log, p = run
    seen = whereabouts(log, p)
    kinds = np.array(log.names["kind"])[seen.kind]
    assert set(seen.place_from[kinds == "off"]) == {NOWHERE}
    assert p.places.index("canteen") in seen.place_from[kinds == "break"]
    assert np.all(seen.place_from[kinds != "off"] >= 0)


@pytest.mark.parametrize("kind", ["work", "walk", "wait", "off", "break"])
def test_a_row_that_is_missing_is_found(run, kind):
    log, p = run
    row = np.flatnonzero((log["kind"] == log.names["kind"].index(kind)) & (log["worker"] == 0))[0]
    (complaint, *_) = unaccounted(log.where(np.arange(len(log)) != row), p)
    assert complaint.startswith("worker ana: nothing is known of him from ")


def test_two_things_at_once_are_found(run):
    log, p = run
    row = np.flatnonzero((log["kind"] == log.names["kind"].index("wait")) & (log["worker"] == 0))[1]
    (complaint, *_) = unaccounted(changed(log, row, start_s=log["start_s"][row] - 1), p)
    assert "two things at once" in complaint


def test_who_stands_somewhere_else_without_a_walk_is_found(run):
    log, p = run
    walk = np.flatnonzero((log["kind"] == log.names["kind"].index("walk")) & (log["worker"] == 0))[1]
    assert "and no walk led there from" in next(unaccounted(changed(log, walk, place_to=0, place_from=0), p))
    wait = np.flatnonzero((log["kind"] == log.names["kind"].index("wait")) & (log["worker"] == 0))[1]
    assert "at no place" in next(unaccounted(changed(log, wait, place_from=-1, place_to=-1), p))
    assert (
        "moves without a walk"
        in list(unaccounted(changed(log, wait, place_to=(log["place_from"][wait] + 1) % 3), p))[-1]
    )


def test_a_floor_without_workers_has_nothing_to_account_for():
    text = TEXT[: TEXT.index("workers:")].replace("cv: 0.3}", "cv: 0.3, automatic: true}")
    log, p = ran(text)
    assert list(unaccounted(log, plan(text))) == [] and whereabouts(log, p).row.size == 0


@pytest.mark.parametrize("variant", ["base", "flu"])
def test_every_second_of_everybody_in_the_shipped_plant_is_accounted_for(variant):
    from opsim.engine.floor.run import run_plan
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    plant = Path(__file__).parents[2] / "scenarios/two_shift_plant.yaml"
    p = compile_plan(read_scenarios(plant, [variant])[variant])
    log = run_plan(p)
    seen = whereabouts(log, p)
    assert list(unaccounted(log, p)) == [] and len(p.workers) == 18
    assert (seen.end_s - seen.start_s).sum() == 18 * p.horizon_s


def test_a_scenario_and_an_emulator_take_the_same_bodies():
    assert {name: (low, high) for name, (low, high, _) in RANGES.items()} == BODY_RANGES
    assert EMULATOR_KEYS == BODY_KEYS


def test_what_is_known_of_a_body_is_said_by_the_names_that_models_read():
    assert Body().said == ()
    assert Body(height_m=1.7, sex="f").said == ("height_m", "sex")
    assert Body(1.7, 60.0, 41.0, "f", 1.1, "s03").said == BODY_KEYS


def test_times_read_nothing_of_a_body_and_emulators_say_what():
    assert keys_read(Fixed(1.0)) == keys_read(switched(Lognormal(1.0, 0.2, 0.5), "none")) == ()
    squat = library_model("public_movements/deep_squat")
    assert {"height_m", "pace", "person"} <= set(keys_read(squat)) <= set(BODY_KEYS)
    assert keys_read(switched(squat, "within_only")) == keys_read(squat)


def test_a_model_that_does_not_say_may_read_anything():
    assert keys_read(SimpleNamespace()) == BODY_KEYS


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
