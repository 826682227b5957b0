"""Belts, vehicles and loads that cannot be: each refused with its place and the way out."""

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.scenario.warnings import risks_of

TEXT = """
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


def said(edits, tmp_path):
    text = TEXT
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), tmp_path / "moves.yaml")
    return "\n".join(f"{p.line}: {p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


def test_the_scenario_itself_is_good(tmp_path):
    assert "base" in scenarios_in(TEXT.encode(), tmp_path / "moves.yaml")


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("{from: a, to: b,", "{from: a, to: bb,",
     "8: conveyors.belt.to: no place 'bb' | did you mean 'b'?"),
    ("{from: a, to: b,", "{from: a, to: a,",
     "8: conveyors.belt: from 'a' to 'a' it is 0 m: no room for a job of 1 m | add e.g. 'length: 6 m'"),
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
    assert said([(old, new)], tmp_path) == answer


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
    assert said([(old, new)], tmp_path) == answer


def test_vehicles_without_roads_of_their_own_need_the_paths_of_the_layout(tmp_path):
    paths = ("door: [3 m, 3 m]}}", "door: [3 m, 3 m]}, distance: paths, paths: [[a, b, c]]}")
    assert said([paths], tmp_path) == (
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
    assert said(edits, tmp_path) == answer


def test_a_leg_that_no_product_goes_is_told_as_a_risk(tmp_path):
    text = TEXT.replace("[[drill, pack]]", "[[drill, pack], [saw, drill]]")
    risks = risks_of(scenarios_in(text.encode(), tmp_path / "moves.yaml")["base"].scenario)
    assert "no product goes from saw to drill: truck has nothing to bring there" in risks
    assert not any(
        "truck" in risk for risk in risks_of(scenarios_in(TEXT.encode(), tmp_path / "m.yaml")["base"].scenario)
    )


def test_what_a_vehicle_brings_may_be_too_heavy_for_who_works_there(tmp_path):
    text = TEXT.replace("most_load: 9 kg, skills: {saw: 1.0, drill: 1.0, pack: 1.0}", "skills: {saw: 1.0, pack: 1.0}")
    text = text.replace("workers: {", "workers: {bo: {most_load: 2 kg, skills: {drill: 1.0}}, ")
    assert "base" in scenarios_in(text.encode(), tmp_path / "moves.yaml")
