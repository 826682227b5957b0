"""What the assumption sheet says of people: how they differ, and what is known of them."""

import pytest
from plans import CELL, loaded

from opsim.plan import compile_plan
from opsim.study.assumptions.sheet import assumptions_of


def sheet(text):
    """topic -> everything said under it."""
    one = loaded(text)
    said = {}
    for topic, says in assumptions_of(one, compile_plan(one)):
        said[topic] = f"{said[topic]}; {says}" if topic in said else says
    return said


def with_variability(word):
    return CELL.replace("seed: 5", f"seed: 5, variability: {word}")


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("none", "none: a task takes the same time whoever does it"),
        ("within_only", "within_only: every worker has the same mean time"),
        ("between_only", "between_only: a worker takes the same time whenever he does a task"),
        (
            "shuffled",
            "shuffled: times are as they were drawn, each with the body of another performance of the same worker",
        ),
    ],
)
def test_a_switch_of_variability_is_said_first(word, says):
    said = sheet(with_variability(word))
    assert next(iter(said)) == "variability" and said["variability"].startswith(says)


def test_full_variability_is_no_assumption():
    assert "variability" not in sheet(with_variability("full"))


@pytest.mark.parametrize(("word", "differ"), [("full", True), ("between_only", True), ("within_only", False)])
def test_own_pace_is_said_where_people_differ_in_it(word, differ):
    assert ("a worker's own pace is drawn once" in sheet(with_variability(word))["workers"]) is differ


BODIES = """
opsim: 1
name: cell
run: {horizon: 30 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks: {squat: {emulator: moves/deep_squat}, raise: {emulator: moves/shoulder_scaption}, label: {fixed: 3 s}}
stations: {low: {at: a, tasks: [squat], buffer: 2}, high: {at: a, tasks: [raise]}, desk: {at: a, tasks: [label]}}
products: {box: {route: [low, high, desk]}}
release: {kind: saturated}
workers:
  ana: {height: 1.62 m, pace: 1.1, skills: {low: 1, high: 1, desk: 1}}
  ben: {mass: 70 kg, age: 30, person: s05, skills: {low: 1, high: 1}}
"""


def test_what_a_body_changes_and_where_is_said():
    says = sheet(BODIES)["bodies"]
    assert "height of ana: bones are scaled to it in raise, squat, not in label" in says
    both = sheet(BODIES.replace("person: s05, skills: {low: 1, high: 1}", "pace: 1.2, skills: {desk: 1}"))["bodies"]
    assert "pace of ana: moving times" in both and "pace of ben: kept with the worker" in both
    assert "pace of ana: moving times of the typical person are divided by it in raise, squat" in says
    assert "mass, age: kept with the worker; no task there changes pace or posture with it" in says


@pytest.mark.parametrize(
    ("word", "says"), [("none", "its mean"), ("within_only", "his own spread about it"), ("between_only", None)]
)
def test_a_pace_that_is_asked_for_stays_under_every_switch_and_is_said(word, says):
    said = sheet(BODIES.replace("seed: 5", f"seed: 5, variability: {word}"))
    mean = "pace of ana: the mean of everybody's times is divided by it in raise, squat, not in label"
    assert (mean in said["bodies"]) is (says is not None)
    line = f"{says}; ana: divided by the pace asked for in tasks that read it; arrivals"
    assert line in said["variability"] if says else "pace" not in said["variability"]
    assert "pace" not in sheet(with_variability(word))["variability"]


def test_the_pace_of_a_recorded_person_is_said_to_be_of_his_own_times():
    says = sheet(BODIES.replace("person: s05", "person: s05, pace: 1.2"))["bodies"]
    assert "pace of ana, ben: moving times of the typical person, or of the recorded one who is named, are" in says


def test_bones_are_scaled_to_heights_whether_or_not_recordings_explain_by_height(monkeypatch):
    line = "height_m: asked 1.62, recorded 1.5 to 1.9, used 1.62 (as asked)"
    plain = sheet(BODIES)["bodies"]
    assert "bones are scaled to it in raise, squat, not in label" in plain and "explain them" not in plain
    one = loaded(BODIES)
    plan = compile_plan(one)
    squat = next(task.model for task in plan.tasks if task.name == "squat")
    monkeypatch.setattr(type(squat), "draw_worker", lambda model, *_, **__: Effect(line) if model is squat else None)
    says = next(said for topic, said in assumptions_of(one, plan) if said.startswith("height of ana"))
    assert says.startswith("height of ana: bones are scaled to it in raise, squat, not in label")
    assert says.endswith("; pace and posture change as the recordings explain them by it in squat")


def test_who_moves_as_a_recorded_person_is_said_and_where_not():
    says = sheet(BODIES)["workers"]
    assert "move as people who were recorded, in emulated tasks and in every replication: ben as s05" in says
    assert "not everybody in raise, where some move as people drawn from the population" in says
    assert "not everybody" not in sheet(BODIES.replace("s05", "s03"))["workers"]


def test_a_body_that_the_emulator_had_to_clamp_is_said(monkeypatch):
    line = "height_m: asked 1.62, recorded 1.7 to 1.9, used 1.7 (clamped)"
    one = loaded(BODIES)
    plan = compile_plan(one)
    for task in plan.tasks:
        if task.name == "squat":
            monkeypatch.setattr(type(task.model), "draw_worker", lambda *given, **more: Effect(line))
    says = [said for topic, said in assumptions_of(one, plan) if topic == "bodies"][-1]
    assert says.startswith("unlike the bodies that were recorded; what these explain is as with the nearest of them:")
    assert f"ana in squat: {line}" in says


def test_skill_levels_are_said_not_to_be_measured():
    text = BODIES.replace("workers:", "skill_levels: {learner: 0.8, expert: 1.15}\nworkers:").replace(
        "desk: 1}", "desk: expert}"
    )
    assert sheet(text)["skills"].endswith("the scenario's own, not measured: learner 0.8, expert 1.15")
    assert "skills" not in sheet(BODIES)


def test_workers_who_are_nobody_in_particular_are_said():
    says = sheet(BODIES + "workforce: {n: 3}\n")["workers"]
    assert "w1 to w3: nobody in particular, drawn from the population" in says
    assert "w1 to w3: skills not given; everybody can work at every station, with the rating 1" in says
    recorded = sheet(BODIES + "workforce: {n: 3, from: recorded, like: ana}\n")["workers"]
    assert "nobody in particular" not in recorded and "skills not given" not in recorded
    assert "ben as s05, w1 as s01, w2 as s02, w3 as s03" in recorded


class Effect:
    def __init__(self, line):
        self.said = (line, "mass_kg: asked 58, recorded 50 to 90, used 58 (as asked)")
