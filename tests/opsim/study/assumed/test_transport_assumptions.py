"""What the assumption sheet says of vehicles, belts and loads."""

from plans import loaded

from opsim.plan import compile_plan
from opsim.study.assumptions.flow import flow

TEXT = """
opsim: 1
name: moves
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {saw: {at: a, tasks: [t]}, drill: {at: b, tasks: [t]}, pack: {at: c, tasks: [t]}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
transporters: {truck: {at: c, speed: 2 m/s, legs: [[drill, pack]]}}
products: {x: {route: [saw, belt, drill, pack], carried: true, mass: 8 kg}}
release: {kind: poisson, every: 60 s}
workers: {ana: {most_load: 9 kg, skills: {saw: 1.0}}, bo: {skills: {drill: 1.0, pack: 1.0}}}
"""


def said(text=TEXT):
    one = loaded(text)
    return [words for topic, words in flow(one, compile_plan(one)) if topic == "transport"]


def test_vehicles_and_belts_say_what_is_left_out():
    lines = said()
    assert any(line.startswith("truck: drivers and batteries always there") for line in lines)
    assert any(line.startswith("truck: called when a job's next place is sure") for line in lines)
    assert any(line.startswith("belt: belts run all the time") for line in lines)


def test_who_has_a_load_limit_and_who_has_none_is_said():
    lines = said()
    assert "ana: as many walks as the load limit asks for, with whole pieces of x" in lines
    assert "bo: no load limit is given; they carry all of a job at once" in lines
    assert "x: no mass is given, and anybody carries all of a job at once" in said(TEXT.replace(", mass: 8 kg", ""))


def test_nothing_is_said_of_loads_where_nobody_carries():
    assert not [line for line in said(TEXT.replace(", carried: true", "")) if "load" in line or "carr" in line]
