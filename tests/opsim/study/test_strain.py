"""What figures of lifting, holding, energy and rest say that they take as given."""

import pytest
from plans import loaded

from opsim.plan import compile_plan
from opsim.study.assumptions import assumptions_of

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


def test_who_told_nothing_of_himself_is_named():
    lines = [line for topic, line in said(CELL.replace("OUT", "energy_kcal_per_min")) if topic == "energy"]
    assert any("75 kg are taken for ben" in line for line in lines)
    assert any("range, for ben" in line for line in lines)
    assert not any("ana" in line for line in lines)


def test_nobody_looks_nothing_is_assumed():
    off = CELL.replace("600 s}", "600 s, posture: off}").replace("OUT", "throughput_per_h")
    assert not {"lifting", "limits", "energy", "rest"} & {topic for topic, _ in said(off)}
