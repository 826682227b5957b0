"""Crews that cannot work: members, stations and ways that do not fit."""

import pytest
from plans import loaded

from opsim.problems import ScenarioError

TEXT = """
opsim: 1
name: crews
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}, big: {fixed: 10 s, team: 2}}
stations: {a: {at: hall, tasks: [t]}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [t]}}
products: {bag: {route: [a, b, c]}, bit: {route: [c]}}
release: {kind: poisson, every: 60 s, products: [bag]}
workers:
  ana: {skills: {a: 1, b: 1, c: 1}}
  ben: {skills: {a: 1, b: 1, c: 1}}
  cem: {skills: {a: 1, c: 1}}
crews: CREWS
"""
ONE = "{row: {kind: bucket_brigade, stations: [a, b, c], workers: [ana, ben]}}"


def read(crews=ONE, *edits):
    text = TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return loaded(text.replace("CREWS", crews))


def said(crews=ONE, *edits):
    with pytest.raises(ScenarioError) as caught:
        read(crews, *edits)
    return "\n".join(f"{p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


@pytest.mark.parametrize("crews", [
    ONE,
    "{row: {kind: rabbit_chase, stations: [b], workers: [ben]},"
    " end: {kind: bucket_brigade, stations: [c], workers: [cem]}}",
])  # fmt: skip
def test_crews_along_a_line_are_read(crews):
    read(crews)


@pytest.mark.parametrize(("old", "new", "expected"), [
    ("bucket_brigade", "bucket_chain", "crews.row.kind: expected bucket_brigade or rabbit_chase, found 'bucket_chain'"),
    ("[a, b, c]", "[a, d]", "crews.row.stations[1]: no station 'd' | known stations: a, b, c"),
    ("[ana, ben]", "[ana, bben]", "crews.row.workers[1]: no worker 'bben' | did you mean 'ben'?"),
    ("[a, b, c]", "[a, b, a]", "crews.row.stations[2]: a is twice here | a station has one place in one crew"),
    ("[ana, ben]", "[]", "crews.row.workers: "),
    ("ben]}}", "ben]}, x: {kind: rabbit_chase, stations: [c], workers: [ana]}}",
     "crews.x.stations[0]: c is in crew row already"),
    ("ben]}}", "ben]}, x: {kind: rabbit_chase, stations: [c], workers: [ana]}}",
     "crews.x.workers[0]: ana is in crew row already"),
    ("[ana, ben]", "[ana, cem]",
     "crews.row.workers[1]: cem has no skill at 'b', where his job may take him | add 'b: 1.0' to the skills of cem"),
    ("[a, b, c]", "[b, a, c]", "products.bag.route[1]: 'b' comes after 'a'; in crew row it comes before"),
])  # fmt: skip
def test_what_does_not_fit_is_told_with_its_place(old, new, expected):
    assert old in ONE
    assert expected in said(ONE.replace(old, new))


@pytest.mark.parametrize(("old", "new", "expected"), [
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t], batch: 2}",
     "crews.row.stations[1]: b has 'batch', whose jobs"),
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t], preempt: resume}",
     "crews.row.stations[1]: b has 'preempt'"),
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t, big]}",
     "crews.row.stations[1]: b has task 'big' of a team"),
    ("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t]}, d: {at: hall, tasks: [t], share: {tasks: [t], with: a}}",
     "crews.row.stations[0]: a has tasks that it shares with another station"),
    ("bag: {route: [a, b, c]}", "bag: {route: [a, b, c], split: {c: {bit: 2}}}",
     "crews.row.stations[2]: c has a split"),
    ("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t], inspect: {then: {rework: a}}}",
     "stations.c.inspect.then.rework: jobs would go back from 'c' to 'a', and those of crew row never do"),
    ("bag: {route: [a, b, c]}", "bag: {routing: {start: a, a: b, b: {a: 0.5, c: 0.5}, c: out}}",
     "products.bag.routing.b.a: jobs would go back from 'b' to 'a'"),
    ("workers:", "allocation: {idle: patrol}\nworkers:",
     "allocation.idle: with idle workers on patrol there can be no crews"),
    ("workers:", "rotations: {r: {workers: [ana, cem], posts: [a, c], every: 1 h}}\nworkers:",
     "crews.row.workers[0]: ana changes posts in rotation r, and a crew keeps its members"),
    ("workers:", "lines: {l: {kind: indexed, stations: [a, b], takt: 60 s, unfinished: stop}}\nworkers:",
     "crews.row.stations[0]: a is part of the paced line l, which moves by itself"),
])  # fmt: skip
def test_what_a_crew_cannot_do_is_refused(old, new, expected):
    assert expected in said(ONE, (old, new))


def test_a_station_beside_a_crew_needs_somebody_of_its_own():
    text = TEXT.replace("bag: {route: [a, b, c]}", "bag: {route: [a, b, c, d]}").replace("c: 1}}", "c: 1, d: 1}}")
    text = text.replace("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t]}, d: {at: hall, tasks: [t]}")
    loaded(text.replace("CREWS", ONE))  # cem is in no crew
    with pytest.raises(ScenarioError) as caught:
        loaded(text.replace("cem: {skills: {a: 1, c: 1, d: 1}}", "cem: {skills: {a: 1}}").replace("CREWS", ONE))
    (problem,) = caught.value.problems
    assert problem.message.startswith("task 't' needs a worker, and all with the skill 'd' work for crew row")


def test_all_mistakes_are_told_at_once():
    told = said("{row: {kind: bucket_brigade, stations: [a, d], workers: [ana, eve, ana]}}")
    assert all(word in told for word in ("no station 'd'", "no worker 'eve'", "ana is twice here"))
