"""What figures of lifting, holding, energy and rest say that they take as given."""

import pytest
from plans import loaded

from opsim.plan import compile_plan
from opsim.study.assumptions.sheet import assumptions_of

CELL = """
opsim: 1
name: cell
run: {horizon: 600 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, load: 5 kg}}
stations: {s: {at: a, tasks: [t], buffer: 1}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {mass: 60 kg, sex: f, skills: {s: 1.0}}, ben: {skills: {s: 1.0}}}
outputs: [OUT]
"""
"""OUT: what is asked for."""


def said(text):
    made = loaded(text)
    return assumptions_of(made, compile_plan(made))


@pytest.mark.parametrize(
    ("asked", "topics"),
    [
        ("throughput_per_h", set()),
        ("lifting_index", {"lifting"}),
        ("iso_11226_min_per_h", {"limits"}),
        ("energy_kcal_per_min", {"energy"}),
        ("rest_allowance_share", {"energy", "rest"}),
    ],
)
def test_each_figure_says_its_own(asked, topics):
    found = {topic for topic, _ in said(CELL.replace("OUT", asked))}
    assert found & {"lifting", "limits", "energy", "rest"} == topics


@pytest.mark.parametrize(
    ("asked", "topic", "words"),
    [
        ("iso_11226_min_per_h", "limits", "5 degrees backward are upright"),
        ("iso_11226_min_per_h", "limits", "each judged at its mean angle"),
        ("iso_11226_min_per_h", "limits", "each zone at the edge at which it begins"),
        ("rest_allowance_share", "rest", "of the time at work (there, and in no break)"),
    ],
)
def test_what_was_decided_is_said(asked, topic, words):
    assert any(words in line for one, line in said(CELL.replace("OUT", asked)) if one == topic)


def test_what_is_repeated_is_said_where_scores_are_asked_for():
    text = CELL.replace("OUT", "rula_mean").replace("fixed: 10 s", "emulator: bench/stoop")
    lines = said(text + "libraries: {bench: libraries/bench_work.npz}\n")
    assert any(
        "a cycle of 15 s or less (4 beginnings within 45 s)" in line for topic, line in lines if topic == "scores"
    )


def test_who_told_nothing_of_himself_is_named():
    lines = [line for topic, line in said(CELL.replace("OUT", "energy_kcal_per_min")) if topic == "energy"]
    assert any("75 kg are taken for ben" in line for line in lines)
    assert any("range, for ben" in line for line in lines)
    assert not any("ana" in line for line in lines)


def test_nobody_looks_nothing_is_assumed():
    off = CELL.replace("600 s}", "600 s, posture: off}").replace("OUT", "throughput_per_h")
    assert not {"lifting", "limits", "energy", "rest"} & {topic for topic, _ in said(off)}


@pytest.mark.parametrize(
    ("asked", "topic", "edit", "words"),
    [
        ("lifting_index", "lifting", (), ": no shifts: lifting lasts at least as long as in the run, and at most 8 h"),
        ("lifting_index", "lifting", (), "the duration of lifting is that of the shift"),
        ("lifting_index", "lifting", (), "no bound there"),
        ("lifting_index", "lifting", ("5 kg}", "5 kg, handling: {sitting: true}}"), "t: done sitting, for which"),
        ("lifting_index", "lifting", ("5 kg}", "5 kg, team: 2}"), "t: load is what each member of the team"),
        ("energy_kcal_per_min", "energy", ("5 kg}", "5 kg, team: 2}"), "t: load is what each member of the team"),
        ("energy_kcal_per_min", "energy", (), "each way down and up without a load (hands below 81 cm"),
        ("energy_kcal_per_min", "energy", (), "who walks has empty hands, but for the job of a product that is"),
        ("energy_kcal_per_min", "energy", ("[s]}", "[s], carried: true}"), "; p: no mass told, so nothing"),
    ],
)
def test_what_loads_and_hands_are_taken_for_is_said(asked, topic, edit, words):
    text = CELL.replace("OUT", asked)
    found = said(text.replace(*edit) if edit else text)
    assert any(words in line for one, line in found if one == topic)
