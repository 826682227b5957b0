"""Warnings about hands, exposure and human effects: said of what may not have been meant, and of nothing else."""

import plans
import pytest

from opsim.plan.warnings import risks_of
from opsim.subjects.tasks.warnings import unmoved_bodies

GOOD = """
opsim: 1
name: warned
run: {horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
shifts: {early: {from: '06:00', to: '14:00'}}
tasks: {make: {emulator: work/fasten, load: 2 kg}, look: {fixed: 9 s}}
stations: {s1: {at: a, tasks: [make, look]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {height: 1.7 m, mass: 70 kg, sex: f, shift: early, skills: {s1: 1}, experience: {make: 9}}}
human: {learning: {model: wright, measured_at: 500}, fatigue: {model: 3cc_r}, absence: 0.1}
outputs: [throughput_per_h, rula_mean]
"""


def loaded(*edits):
    text = GOOD
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return plans.loaded(text)


def test_nothing_is_said_of_what_is_plain():
    assert risks_of(loaded().scenario) == []


NO_BODY = [
    ("{emulator: work/fasten, load: 2 kg}", "{fixed: 3 s}"),
    (", fatigue: {model: 3cc_r}", ""),
    ("outputs:", "allocation: {rule: least_exposed}\noutputs:"),
    (", rula_mean", ""),
]
CASES = [
    ("load", [(", load: 2 kg", "")], "make: no load is said: RULA, REBA and OWAS are intervals over what is in the"),
    ("expert", [("measured_at: 500", "rate: 0.9")], "learning: the times of make are taken for those of a first rep"),
    ("mass", [("mass: 70 kg, sex: f, ", "")], "fatigue: mass and sex of ana not said: joints are as strong, and"),
    ("learns", [("learning: {model: wright, measured_at: 500}, ", "")], "the experience of ana changes nothing"),
    ("shift", [("shift: early, ", "")], "human.absence changes nothing: nobody has a shift that could be missed"),
    ("off", [("rula_mean", "rest_taken_min_per_h")], "outputs: rest_taken_min_per_h: there is none, as 'human.rest'"),
    ("bodies", NO_BODY, "allocation.rule: least_exposed goes by postures, and no task has a body"),
]


@pytest.mark.parametrize(("edits", "words"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_what_may_not_have_been_meant_is_said(edits, words):
    said = risks_of(loaded(*edits).scenario)
    assert any(words in one for one in said), said


def test_a_load_is_asked_for_only_where_a_figure_asks():
    assert risks_of(loaded((", load: 2 kg", ""), (", rula_mean", "")).scenario) == []


def test_bodies_that_do_not_follow_are_named():
    still = loaded(("run: {horizon: 1 h}", "run: {horizon: 1 h, variability: within_only}"))
    assert [one[:40] for one in unmoved_bodies(plans.compile_plan(still))] == [
        "fatigue: make: the emulator knows no shi"
    ]
    assert list(unmoved_bodies(plans.compile_plan(loaded()))) == []
    by_time = loaded(
        ("run: {horizon: 1 h}", "run: {horizon: 1 h, variability: within_only}"),
        ("human: {", "human: {acts_on: time, "),
    )
    assert list(unmoved_bodies(plans.compile_plan(by_time))) == []
