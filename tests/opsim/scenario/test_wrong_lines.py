"""Paced lines that cannot be: each refused with its place and the way out."""

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: line
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m], b: [9 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {saw: {at: a, tasks: [t]}, s1: {at: a, tasks: [t]}, s2: {at: b, tasks: [t]}, pack: {at: b, tasks: [t]}}
products: {x: {route: [saw, s1, s2, pack]}}
release: {kind: poisson, every: 60 s}
workers:
  ana: {skills: {saw: 1.0, s1: 1.0, s2: 1.0, pack: 1.0}}
  joker: {skills: {s1: 1.0}}
  bob: {walk: 0.5 m/s, skills: {pack: 1.0}}
lines:
  final: {kind: indexed, stations: [s1, s2], takt: 60 s, andon: {workers: [joker], at: 50 s}}
"""
MOVING = ("kind: indexed, stations: [s1, s2], takt: 60 s", "kind: moving, length: 6 m, stations: [s1, s2], takt: 60 s")


def said(edits, tmp_path):
    text = TEXT
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), tmp_path / "line.yaml")
    return "\n".join(f"{p.line}: {p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


@pytest.mark.parametrize("edits", [[], [MOVING]])
def test_the_scenario_itself_is_good(edits, tmp_path):
    text = TEXT
    for old, new in edits:
        text = text.replace(old, new)
    assert "base" in scenarios_in(text.encode(), tmp_path / "line.yaml")


LINE = "kind: indexed, stations: [s1, s2], takt: 60 s"


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("stations: [s1, s2]", "stations: [s1, s3]",
     "15: lines.final.stations[1]: no station 's3' | known stations: pack, s1, s2, saw"),
    ("stations: [s1, s2]", "stations: [s1, s1]",
     "15: lines.final.stations[1]: 's1' is on final already | a station is on one line, once"),
    (LINE, "kind: indexed, stations: [s1, s2], takt: 60 s, length: 6 m",
     "15: lines.final.length: an indexed line has no 'length': its jobs stand at stations | remove it, or write 'kind: "
     "moving'"),
    (LINE, "kind: indexed, stations: [s1, s2], takt: 60 s, drift: 1 m",
     "15: lines.final.drift: an indexed line has no 'drift'"),
    (LINE, "kind: moving, stations: [s1, s2], takt: 60 s",
     "15: lines.final: a moving line needs to know how long a station's stretch is | add e.g. 'length: 6 m'"),
    (LINE, "kind: moving, length: 6 m, lengths: {pack: 3 m}, stations: [s1, s2], takt: 60 s",
     "15: lines.final.lengths: no station 'pack' on final"),
    (LINE, "kind: moving, length: 6 m, speed: 1.5 m/s, drift: 90 m, stations: [s1, s2], takt: 60 s",
     "11: workers.ana.walk: ana walks 1.2 m/s, and the line moves 1.5 m/s | he could not follow a job"),
    ("at: 50 s", "at: 60 s",
     "15: lines.final.andon: called at 60 s, when the 60 s that a job has there are over | call earlier"),
    ("workers: [joker]", "workers: [jokr]",
     "15: lines.final.andon.workers[0]: no worker 'jokr' | did you mean 'joker'?"),
    ("workers: [joker]", "workers: [bob]",
     "15: lines.final.andon.workers[0]: bob has no skill on this line | add e.g. 's1: 1.0' to his skills"),
    ("workers: [joker]", "workers: [ana, joker]",
     "15: lines.final.andon: only ana, joker can work at s1, and comes only when he is called | add 's1: 1.0' to the "
     "skills of somebody else"),
    ("s2: {at: b,", "s2: {at: b, buffer: 2,",
     "7: stations.s2.buffer: s2 is on the line final, and cannot say 'buffer': the line's own stretch is all the room "
     "there is | remove it"),
    ("s2: {at: b,", "s2: {at: b, servers: 2,",
     "7: stations.s2.servers: s2 is on the line final, which brings one job"),
    ("s2: {at: b,", "s2: {at: b, batch: {size: 2},",
     "7: stations.s2.batch: s2 is on the line final, and cannot say 'batch'"),
    ("s2: {at: b,", "s2: {at: b, inspect: {then: {rework: saw}},",
     "7: stations.s2.inspect.then: s2 is on the line final, and a job that is turned down cannot leave it there"),
    ("pack: {at: b,", "pack: {at: b, inspect: {then: {rework: s1}},",
     "7: stations.pack.inspect.then: a job cannot come back to 's1', on the line final"),
    ("saw: {at: a,", "saw: {at: a, blocking: before,",
     "7: stations.saw.blocking: no place on the line final can be kept: a job comes onto it when it moves"),
    ("workers:\n  ana", "flow: {blocking: before}\nworkers:\n  ana",
     "10: flow.blocking: on a paced line a job has its next place when the line moves"),
    ("route: [saw, s1, s2, pack]", "route: [saw, s2, s1, pack]",
     "8: products.x: x comes from saw to s2, and the line final goes s1, s2 | a way goes over all its stations in this "
     "order; one without work there has no tasks"),
    ("route: [saw, s1, s2, pack]", "route: [saw, s1, pack]",
     "8: products.x: x comes from s1 to pack, and the line final goes s1, s2"),
    ("route: [saw, s1, s2, pack]", "route: [s1]",
     "8: products.x: x leaves from s1, and the line final goes s1, s2"),
    ("route: [saw, s1, s2, pack]", "route: [s2, pack]",
     "8: products.x: x begins at s2"),
    ("route: [saw, s1, s2, pack]", "route: [saw, s1, [s2, pack]]",
     "8: products.x.route[2]: x goes to s2 or pack, and the line final leads to one of them alone | name one station"),
    ("route: [saw, s1, s2, pack]", "routing: {start: s1, s1: {s2: 0.5, pack: 0.5}, s2: pack, pack: out}",
     "8: products.x: x comes from s1 to pack, and the line final goes s1, s2"),
    ("pack]}}", "pack], carried: true}}",
     "8: products.x.carried: x goes over the line final, which moves it | remove 'carried'"),
    ("workers:\n  ana", "crews: {c: {kind: rabbit_chase, stations: [s1, s2], workers: [ana]}}\nworkers:\n  ana",
     "10: crews.c.stations[0]: s1 is on the line final, which moves the jobs | a crew or a line, not both"),
    ("workers:\n  ana", "cards: {k: {n: 2, from: s2, to: pack}}\nworkers:\n  ana",
     "10: cards.k.from: a card is taken before s2, and the line final waits for nobody there | take it before s1"),
    ("workers:\n  ana", "transporters: {cart: {at: a, speed: 1 m/s, legs: [[saw, s1]]}}\nworkers:\n  ana",
     "10: transporters.cart.legs[0]: cart would bring jobs to or from a station of the line final"),
])  # fmt: skip
def test_lines_that_cannot_be(old, new, answer, tmp_path):
    assert answer in said([(old, new)], tmp_path)


def test_who_walks_no_faster_than_the_line_moves_is_told(tmp_path):
    slow = ("joker: {skills", "joker: {walk: 0.1 m/s, skills")
    assert said([MOVING, slow], tmp_path) == (
        "12: workers.joker.walk: joker walks 0.1 m/s, and the line moves 0.1 m/s | he could not follow a job"
    )


def test_all_mistakes_of_a_line_are_told_at_once(tmp_path):
    found = said([("s2: {at: b,", "s2: {at: b, buffer: 2, servers: 2,"), ("[joker]", "[jokr]")], tmp_path)
    assert len(found.splitlines()) == 3
