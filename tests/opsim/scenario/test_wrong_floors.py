"""Stores, bills of material, splits and batches that cannot be: refused with their place and a way out.

Paced lines that cannot be: each refused with its place and the way out.

Belts, vehicles and loads that cannot be: each refused with its place and the way out.

Floors that would wait for ever, or for which no way leads: refused by the checks.
"""

from pathlib import Path

import pytest

from opsim.plan.warnings import risks_of
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

BIKES = """
opsim: 1
name: bikes
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 10 s, automatic: true}}
stores: {wheels: {at: here, capacity: 5, initial: 2}, frames: {at: here}}
stations:
  weld: {at: here, tasks: [do], buffer: 2}
  join: {at: here, tasks: [do], buffer: 4}
  saw: {at: here, tasks: [do]}
products:
  wheel: {route: [wheels]}
  frame: {routing: {start: weld, weld: frames}}
  bike: {route: [weld, join], parts: {join: {wheel: 2, frame: 1}}}
  tube: {route: [saw], split: {saw: {wheel: 3}}}
sources:
  all: {kind: poisson, every: 60 s, products: [wheel, frame, bike, tube]}
"""


def said(*edits: tuple[str, str]) -> str:
    text = BIKES
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("bikes.yaml"))
    return str(caught.value)


def test_the_scenario_itself_is_right():
    assert set(scenarios_in(BIKES.encode(), Path("bikes.yaml"))) == {"base"}


@pytest.mark.parametrize(("edit", "words"), [
    (("wheels: {at: here", "wheels: {at: hree"), ["stores.wheels.at: no place 'hree'", "did you mean 'here'?"]),
    (("capacity: 5", "capacity: 0"), ["a store has from 1 to 1,000,000,000 places, found 0"]),
    (("initial: 2", "initial: -1"), ["stores.wheels.initial: must be from 0 to 100,000, found -1"]),
    (("initial: 2", "initial: 6"), ["6 lie here at the start, and 5 have room", "raise the capacity"]),
    (("initial: 2", "initial: {wheal: 2}"), ["no way of 'wheal' ends in 'wheels'", "did you mean 'wheel'?"]),
    (("{route: [wheels]}", "{route: [frames]}"), ["the way of no product ends in the store 'wheels'"]),
    (("[wheels]", "[wheels, weld]"), ["route[0]", "no way leads on from it"]),
    (("[wheels]", "[[wheels, frames]]"), ["a way ends in one store, and 'wheels' stands among others"]),
    (("weld: frames}", "weld: frames, frames: out}"), ["routing.frames", "no way leads on from it"]),
])  # fmt: skip
def test_a_store_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_a_number_alone_needs_one_product_to_be_of():
    two = ("[wheels]}", "[wheels]}\n  rim: {route: [wheels]}")
    assert "rim and wheel end in 'wheels': of which are these?" in said(two)


@pytest.mark.parametrize(("edit", "words"), [
    (("{wheel: 2, frame: 1}", "{wheal: 2, frame: 1}"), ["join.wheal: no product 'wheal'", "did you mean 'wheel'?"]),
    (("{wheel: 2, frame: 1}", "{wheel: 0}"), ["products.bike.parts.join.wheel: must be at least 1, found 0"]),
    (("{wheel: 2, frame: 1}", "{tube: 1}"), ["no 'tube' can be taken as a part: its way ends in no store", "[..., "]),
    (("parts: {join", "parts: {joint"), ["parts.joint: no station 'joint'", "did you mean 'join'?"]),
    (("parts: {join", "parts: {wheels"), ["no station 'wheels'"]),
    (("[weld, join]", "[weld]"), ["the way of 'bike' skips 'join', where parts go in", "add join to its route"]),
    (("[weld, join]", "[weld, [join, saw]]"), ["a job that goes to 'saw' instead would skip 'join'"]),
    (("split: {saw", "split: {weld"), ["the way of 'tube' skips 'weld', where it is split"]),
    (("[saw]", "[saw, weld]"), ["after 'saw' there is no 'tube' any more, and its way goes on to 'weld'"]),
    (("{route: [saw]", "{routing: {start: saw, saw: {weld: 0.5, out: 0.5}, weld: out}"), ["goes on to 'weld'"]),
    (("{saw: {wheel: 3}}", "{saw: {tube: 3}}"), ["splitting never comes to an end: tube becomes tube"]),
])  # fmt: skip
def test_a_bill_of_material_or_a_split_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_a_bill_of_material_in_a_circle_is_refused_once_with_the_circle():
    answer = said(
        ("frame: {routing: {start: weld, weld: frames}}", "frame: {route: [weld, frames], parts: {weld: {bike: 1}}}"),
        ("[weld, join], parts", "[join, wheels], parts"),
        ("wheel: 2, frame: 1", "frame: 1"),
    )
    assert answer.count("goes round in a circle") == 1
    assert "the bill of material goes round in a circle: bike needs frame needs bike" in answer
    assert "take bike out of 'products.frame.parts', or break the circle elsewhere" in answer


@pytest.mark.parametrize(("edit", "words"), [
    (("buffer: 4}", "buffer: 3, batch: {size: 4}}"), ["a batch of 4 never comes together in a buffer of 3"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 1}}"), ["batch.size: must be at least 2, found 1"]),
    (("buffer: 4}", "buffer: 4, batch: {siz: 4}}"), ["unknown key 'siz'", "did you mean 'size'?"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 4, of: famly}}"), ["did you mean 'family'?"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 4, most_wait: 10}}"), ["stations.join.batch.most_wait"]),
    (("frame: 1}}", "frame: 1}}, lot: 0"), ["products.bike.lot: must be at least 1, found 0"]),
    (("automatic: true", "automatic: true, per: batch"), ["tasks.do.per: expected unit or lot, found 'batch'"]),
])  # fmt: skip
def test_a_batch_or_a_lot_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_nobody_carries_a_batch():
    batch, carried = ("buffer: 4}", "buffer: 4, batch: {size: 2}}"), ("frame: 1}}", "frame: 1}}, carried: true")
    assert "'bike' comes to 'join', whose batches nobody can carry on" in said(batch, carried)


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


def wrong_lines_said(edits, tmp_path):
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
    assert answer in wrong_lines_said([(old, new)], tmp_path)


def test_who_walks_no_faster_than_the_line_moves_is_told(tmp_path):
    slow = ("joker: {skills", "joker: {walk: 0.1 m/s, skills")
    assert wrong_lines_said([MOVING, slow], tmp_path) == (
        "12: workers.joker.walk: joker walks 0.1 m/s, and the line moves 0.1 m/s | he could not follow a job"
    )


def test_all_mistakes_of_a_line_are_told_at_once(tmp_path):
    found = wrong_lines_said([("s2: {at: b,", "s2: {at: b, buffer: 2, servers: 2,"), ("[joker]", "[jokr]")], tmp_path)
    assert len(found.splitlines()) == 3


WRONG_TRANSPORT_TEXT = """
opsim: 1
name: moves
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 0 m], door: [3 m, 3 m]}}
tasks: {t: {fixed: 10 s}}
stations: {saw: {at: a, tasks: [t]}, drill: {at: b, tasks: [t]}, pack: {at: c, tasks: [t]}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
transporters: {truck: {at: door, speed: 2 m/s, legs: [[drill, pack]]}}
products: {x: {route: [saw, belt, drill, pack], carried: true, mass: 8 kg}}
release: {kind: poisson, every: 60 s}
workers: {ana: {most_load: 9 kg, skills: {saw: 1.0, drill: 1.0, pack: 1.0}}}
"""


def wrong_transport_said(edits, tmp_path):
    text = WRONG_TRANSPORT_TEXT
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), tmp_path / "moves.yaml")
    return "\n".join(f"{p.line}: {p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


def test_the_scenario_itself_is_good_of_wrong_transport(tmp_path):
    assert "base" in scenarios_in(WRONG_TRANSPORT_TEXT.encode(), tmp_path / "moves.yaml")


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("{from: a, to: b,", "{from: a, to: bb,",
     "8: conveyors.belt.to: no place 'bb' | did you mean 'b'?"),
    ("{from: a, to: b,", "{from: a, to: a,",
     "8: conveyors.belt: from 'a' to 'a' it is 0 m: no room for a job of 1 m | add e.g. 'length: 6 m'"),
    ("b: [6 m, 0 m]", "b: {at: [60 cm, 0 m], levels: {low: 1 m}}",
     "8: conveyors.belt: from 'a' to 'b' it is 0.6 m: no room for a job of 1 m | add e.g. 'length: 6 m'"),
    ("pitch: 1 m", "pitch: 1 m, length: 60 cm",
     "8: conveyors.belt.length: a belt of 0.6 m has no room for a job of 1 m | make the belt longer or the pitch "
     "smaller"),
    ("pitch: 1 m", "pitch: 0 m",
     "8: conveyors.belt.pitch: must be at least 0.001 m, found '0 m' | "),
    ("pitch: 1 m", "pich: 1 m",
     "8: conveyors.belt.pich: unknown key 'pich' | did you mean 'pitch'?"),
    ("belt: {from", "drill: {from",
     "8: conveyors.drill: 'drill' is the name of one of the stations too | a route could not tell them apart\n"
     "10: products.x.route[1]: no station 'belt' | known stations: drill, pack, saw"),
    ("drill: 1.0", "belt: 1.0, drill: 1.0",
     "12: workers.ana.skills.belt: no station 'belt' | known stations: drill, pack, saw"),
])  # fmt: skip
def test_belts_that_cannot_be(old, new, answer, tmp_path):
    assert wrong_transport_said([(old, new)], tmp_path) == answer


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("at: door", "at: dor",
     "9: transporters.truck.at: no place 'dor' | did you mean 'door'?"),
    ("[[drill, pack]]", "[[drill, pak]]",
     "9: transporters.truck.legs[0]: no station 'pak' | did you mean 'pack'?"),
    ("[[drill, pack]]", "[drill, pack]",
     "9: transporters.truck.legs[0]: expected a leg as two stations, found 'drill' | such as [drill, paint]\n"
     "9: transporters.truck.legs[1]: expected a leg as two stations, found 'pack' | such as [drill, paint]"),
    ("[[drill, pack]]", "[[drill, drill]]",
     "9: transporters.truck.legs[0]: a leg from 'drill' to itself | such as [drill, paint]"),
    (", legs: [[drill, pack]]}", ", legs: [[drill, pack]]}, cart: {at: a, speed: 1 m/s, legs: [[drill, pack]]}",
     "9: transporters.cart.legs[0]: truck already goes from 'drill' to 'pack' | one kind of vehicle goes a leg"),
    (", legs: [[drill, pack]]", "",
     "9: transporters.truck: 'legs' is missing | add e.g. 'legs: [[drill, paint], [paint, pack]]'"),
    ("[[drill, pack]]", "[]",
     "9: transporters.truck.legs: expected at least one entry, found none | "
     "such as [[drill, paint], [paint, pack]]"),
    ("[[drill, pack]]", "[[drill, pack]], capacity: 0",
     "9: transporters.truck.capacity: must be at least 1, found 0 | write 1 or more"),
    ("[[drill, pack]]", "[[drill, pack]], roads: [[door, b]]",
     "9: transporters.truck.roads: no road leads from 'b' to 'c', and truck has to drive there | add e.g. [c, ...]\n"
     "9: transporters.truck.roads: no road leads from 'c' to 'b', and truck has to drive there | add e.g. [c, ...]"),
    ("[[drill, pack]]", "[[drill, pack]], roads: [[b, c]]",
     "9: transporters.truck.roads: no road leads from 'door' to 'b', and truck has to drive there | add e.g. "
     "[door, ...]"),
    ("[[drill, pack]]", "[[drill, pack]], roads: [[door, b], {from: b, to: c, one_way: true}]",
     "9: transporters.truck.roads: no road leads from 'c' to 'b', and truck has to drive there | is a road missing, or "
     "'one_way' too much?"),
    ("[[drill, pack]]", "[[drill, pack]], idle: home, roads: [{from: door, to: b, one_way: true}, [b, c]]",
     "9: transporters.truck.roads: no road leads from 'b' to 'door', and truck has to drive there | is a road missing, "
     "or 'one_way' too much?"),
    ("[[drill, pack]]", "[[drill, pack]], roads: [[door, hall, b, c]]",
     "9: transporters.truck.roads[0][1]: no place 'hall' | known places: a, b, c, door"),
])  # fmt: skip
def test_vehicles_that_cannot_be(old, new, answer, tmp_path):
    assert wrong_transport_said([(old, new)], tmp_path) == answer


def test_vehicles_without_roads_of_their_own_need_the_paths_of_the_layout(tmp_path):
    paths = ("door: [3 m, 3 m]}}", "door: [3 m, 3 m]}, distance: paths, paths: [[a, b, c]]}")
    assert wrong_transport_said([paths], tmp_path) == (
        "9: transporters.truck: no path leads from 'door' to 'b', and truck has to drive there | add e.g. [door, ...]"
    )


@pytest.mark.parametrize(("edits", "answer"), [
    ([("most_load: 9 kg", "most_load: 7 kg")],
     "12: workers.ana.most_load: ana may have to carry 'x' (8 kg) on from 'saw', and cannot lift it | let a "
     "transporter bring it, or somebody stronger work there"),
    ([("most_load: 9 kg", "most_load: 0 kg")],
     "12: workers.ana.most_load: must be more than 0 kg, found '0 kg' | such as '6 kg'"),
    ([("mass: 8 kg", "mass: 8 m")],
     "10: products.x.mass: '8 m' is a length; expected a mass | such as '6 kg'"),
])  # fmt: skip
def test_loads_that_nobody_can_carry(edits, answer, tmp_path):
    assert wrong_transport_said(edits, tmp_path) == answer


def test_a_leg_that_no_product_goes_is_told_as_a_risk(tmp_path):
    text = WRONG_TRANSPORT_TEXT.replace("[[drill, pack]]", "[[drill, pack], [saw, drill]]")
    risks = risks_of(scenarios_in(text.encode(), tmp_path / "moves.yaml")["base"].scenario)
    assert "no product goes from saw to drill: truck has nothing to bring there" in risks
    assert not any(
        "truck" in risk
        for risk in risks_of(scenarios_in(WRONG_TRANSPORT_TEXT.encode(), tmp_path / "m.yaml")["base"].scenario)
    )


def test_what_a_vehicle_brings_may_be_too_heavy_for_who_works_there(tmp_path):
    text = WRONG_TRANSPORT_TEXT.replace(
        "most_load: 9 kg, skills: {saw: 1.0, drill: 1.0, pack: 1.0}", "skills: {saw: 1.0, pack: 1.0}"
    )
    text = text.replace("workers: {", "workers: {bo: {most_load: 2 kg, skills: {drill: 1.0}}, ")
    assert "base" in scenarios_in(text.encode(), tmp_path / "moves.yaml")


TWO = """
opsim: 1
name: two
run: {horizon: 1 h}
layout: {distance: paths, places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [3 m, 0 m]}, paths: [[a, c]]}
tasks: {t: {fixed: 10 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: b, tasks: [t]}}
products: {p: {route: [s1, s2], carried: true}}
release: {kind: renewal, every: {fixed: 30 s}}
workers: {w: {skills: {s1: 1}}, v: {skills: {s2: 1}}}
"""
ROUTING = "routing: {start: s1, s1: {s2: 0.5, out: 0.5}, s2: out}"


def wrong_ways_said(text: str) -> str:
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("two.yaml"))
    return str(caught.value)


@pytest.mark.parametrize("way", ["route: [s1, s2]", ROUTING])
def test_who_carries_needs_a_way_to_where_he_carries(way):
    assert "no path leads from 'a' to 'b', and w has to walk there" in wrong_ways_said(
        TWO.replace("route: [s1, s2]", way)
    )
    assert set(scenarios_in(TWO.replace("true", "false").encode(), Path("two.yaml"))) == {"base"}
    assert set(scenarios_in(TWO.replace("[[a, c]]", "[[a, c, b]]").encode(), Path("two.yaml"))) == {"base"}


def test_a_station_that_no_round_comes_by_is_refused():
    text = TWO.replace("[[a, c]]", "[[a, c, b]]").replace("s1: 1}", "s1: 1, s2: 1}, patrol: [s1]")
    text = text.replace(", v: {skills: {s2: 1}}", "") + "allocation: {idle: patrol}\n"
    assert "task 't' needs a worker, and nobody goes round by 's2'" in wrong_ways_said(text)
    mended = text.replace("patrol: [s1]", "patrol: [s1, s2]")
    assert set(scenarios_in(mended.encode(), Path("two.yaml"))) == {"base"}


@pytest.mark.parametrize("stop", ["[]", "[s1]", "{s1: 1}", "null", "7"])
def test_a_stop_of_a_round_that_is_no_name_is_refused(stop):
    text = TWO.replace("[[a, c]]", "[[a, c, b]]").replace(
        "{skills: {s1: 1}}", f"{{skills: {{s1: 1}}, patrol: [{stop}]}}"
    )
    assert "patrol" in wrong_ways_said(text + "allocation: {idle: patrol}\n")
