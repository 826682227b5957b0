"""The assumption sheet says of paced lines what happens to what is not done, and no longer what does not hold there."""

from plans import loaded, plan

from opsim.plan import compile_plan
from opsim.study.assumptions.flow import flow, lines
from opsim.study.assumptions.people import people

TEXT = """
opsim: 1
name: line
run: {horizon: 1000 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 50 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: a, tasks: [t]}}
lines: {final: {kind: indexed, stations: [s1, s2], takt: 60 s, andon: {workers: [joker], at: 50 s}}}
products: {x: {route: [s1, s2]}}
release: {kind: saturated}
workers: {ana: {skills: {s1: 1.0, s2: 1.0}}, joker: {skills: {s1: 1.0}}}
"""
MOVING = TEXT.replace("indexed,", "moving, length: 6 m, unfinished: send_on,").replace(
    "at: 50 s}}", "at: 50 s, does: help}}"
)


def test_a_line_that_stops_and_one_that_sends_on_are_told_apart():
    assert any("the line stands and all other work goes on" in said for _, said in lines(plan(TEXT)))
    assert any("goes on as it is and is bad" in said for _, said in lines(plan(MOVING)))


def test_how_it_moves_and_who_is_called_are_told():
    assert any("moving on takes no time" in said for _, said in lines(plan(TEXT)))
    assert any("the line moves 0.1 m/s" in said for _, said in lines(plan(MOVING)))
    assert any(
        said.startswith("final: joker only when called; who comes takes a time") for _, said in lines(plan(TEXT))
    )
    assert any("takes his own share of what is left" in said for _, said in lines(plan(MOVING)))


def test_jobs_on_a_line_do_not_pass_without_time_and_no_buffer_in_front_is_unlimited():
    said = " ".join(text for _, text in flow(loaded(MOVING), plan(MOVING)))
    assert "without time" not in said.replace("moving on takes no time", "")
    assert "unlimited" not in said


def test_people_on_a_moving_line_walk_at_a_speed_that_is_told():
    def told(text):
        read = loaded(text)
        return " ".join(said for _, said in people(read, compile_plan(read)))

    assert "ana, joker: walking speed not given" in told(MOVING).replace(" and ", ", ")
    assert "walking speed" not in told(TEXT)
