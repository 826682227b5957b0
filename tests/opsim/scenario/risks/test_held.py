"""Workers who all stay with blocked jobs: over belts, over several stations, before stores, in teams."""

from pathlib import Path

from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.kpi.deadlock import locked
from opsim.plan.warnings import risks_of
from opsim.scenario.read import scenarios_in

HEAD = """
opsim: 1
name: held
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {do: {fixed: 3 s}, slow: {fixed: 30 s}, pair: {fixed: 30 s, team: 2}}
release: {kind: poisson, every: 9 s}
"""
BELT = """
conveyors: {belt: {from: a, to: b, speed: 1 m/s, pitch: 1 m}}
stations: {cut: {at: a, tasks: [do]}, drill: {at: b, tasks: [slow], buffer: 1}}
products: {x: {route: [cut, belt, drill], carried: true}}
workers: {ana: {skills: {cut: 1, drill: 1}}}
"""
CROSSED = """
stations:
  a1: {at: a, tasks: [do], buffer: 0}
  a2: {at: a, tasks: [slow], buffer: 0}
  b1: {at: b, tasks: [do], buffer: 0}
  b2: {at: b, tasks: [slow], buffer: 0}
products: {x: {share: 0.5, route: [a1, a2]}, y: {share: 0.5, route: [b1, b2]}}
workers: {ana: {skills: {b1: 1, a2: 1}}, ben: {skills: {a1: 1, b2: 1}}}
allocation: {when_blocked: held}
"""
STORE = """
stations: {cut: {at: a, tasks: [do], buffer: 1}, join: {at: b, tasks: [slow]}}
stores: {shelf: {at: b, capacity: 2}}
products: {part: {share: 0.5, route: [cut, shelf]}, x: {share: 0.5, route: [join], parts: {join: {part: 1}}}}
workers: {ana: {skills: {cut: 1, join: 1}}}
allocation: {when_blocked: held, rule: nearest}
"""


def held(body, *edits):
    text = HEAD + body
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    risks = risks_of(scenarios_in(text.encode(), Path("held.yaml"))["base"].scenario)
    return [risk for risk in risks if "can all be held" in risk], plan(text)


def locks(p):
    return locked(run_plan(p), p) is not None


def test_a_belt_between_does_not_take_the_risk_away():
    (risk,), p = held(BELT)
    assert risk.startswith("with carried: true, ana can all be held at cut while drill is full")
    assert locks(p)


def test_somebody_who_works_behind_the_belt_alone_takes_it_away():
    risks, p = held(BELT, ("workers: {", "workers: {ben: {skills: {drill: 1}}, "))
    assert risks == [] and not locks(p)


def test_two_who_wait_for_each_other_over_two_lines_are_told():
    risks, _ = held(CROSSED)
    assert any(risk.startswith("with when_blocked: held, ana can all be held at b1 while a2 is full") for risk in risks)
    assert any(risk.startswith("with when_blocked: held, ben can all be held at a1 while b2 is full") for risk in risks)


def test_two_who_stay_on_their_own_lines_are_not():
    risks, p = held(CROSSED, ("{b1: 1, a2: 1}}", "{a2: 1}}, cai: {skills: {b1: 1}}"))
    assert risks == [] and not locks(p)


def test_a_team_lacks_hands_as_soon_as_one_is_held():
    body = BELT.replace("tasks: [slow]", "tasks: [pair]").replace("workers: {", "workers: {ben: {skills: {drill: 1}}, ")
    (risk,), _ = held(body)
    assert "ana and ben can all be held at cut" in risk
    assert held(body, ("workers: {", "workers: {cai: {skills: {drill: 1}}, "))[0] == []


def test_who_is_held_before_a_full_store_is_missed_where_parts_are_taken():
    (risk,), p = held(STORE, ("every: 9 s", "every: 2 s"))
    assert risk.startswith("with when_blocked: held, ana can all be held at cut while work at join waits for one of")
    assert locks(p)
    assert held(STORE, ("capacity: 2", "capacity: unlimited"))[0] == []
