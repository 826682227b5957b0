"""What the sheet says of scoring, of hands that nobody described, and of human effects."""

import plans
import pytest

from opsim.ergonomics.options import NOT_SEEN, RULES
from opsim.study.assumptions.ergonomics import ergonomics
from opsim.study.assumptions.human import human
from opsim.study.assumptions.sheet import assumptions_of

CELL = """
opsim: 1
name: sheet
run: {horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
shifts: {early: {from: '06:00', to: '14:00'}}
tasks:
  make: {emulator: work/fasten, load: 2 kg, loaded: {from: 0.2, to: 0.8}, handling: {grip: fair, force: static}}
  wait: {fixed: 9 s}
stations: {s1: {at: a, tasks: [make, wait]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {shift: early, skills: {s1: 1}, experience: {make: 40}}}
outputs: [rula_mean]
"""
EFFECTS = ("outputs:", "human: {learning: {model: wright, rate: 0.9}, fatigue: {model: lffrm}, absence: 0.1}\noutputs:")


def said(part, *edits):
    text = CELL
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    loaded = plans.loaded(text)
    return [f"{topic}: {words}" for topic, words in part(loaded, plans.compile_plan(loaded))]


def test_nothing_is_said_of_scores_that_nobody_asks_for():
    assert said(ergonomics, ("rula_mean", "walked_m")) == []


def test_the_ways_taken_where_methods_part_are_named():
    usual = " ".join(said(ergonomics))
    assert "12 postures a second; upper arms are measured against the trunk" in usual
    assert "twisted from 10, bent sideways from 10, arm abducted from 30" in usual
    options = (
        "ergonomics: {arm_reference: gravity, rula: {table_a: worksheet2000, force: worksheet}, waiting: upright, "
    )
    options += "owas: {disputed: ['3373']}, thresholds: {twist: 15 deg, spread: true}}\noutputs:"
    other = " ".join(said(ergonomics, ("outputs:", options)))
    for words in (
        "gravity: hanging",
        "worksheet of 2000",
        "always 3)",
        "category for 3373",
        "upright with",
        "twisted from 15",
    ):
        assert words in other, words
    assert "over all from 5 to 20" in other


def test_what_nobody_said_is_listed_by_task_with_the_score_that_it_leaves_open():
    lines = said(ergonomics)
    assert "loads: in the hands, as the scenario says: make 2 kg between two moments of each performance" in lines
    assert "not said: make: forearm: RULA is an interval over the twist of the forearm" in lines
    assert not any("grip" in line or line.startswith("not said: make: load") for line in lines)
    bare = said(ergonomics, (", load: 2 kg, loaded: {from: 0.2, to: 0.8}, handling: {grip: fair, force: static}", ""))
    assert [line.split(":")[2].strip() for line in bare if line.startswith("not said")] == [
        *("load", "grip", "force", "forearm", "arms supported", "sitting", "legs", "rapid")
    ]


def test_what_no_skeleton_shows_is_listed_in_full():
    assert [line for line in said(ergonomics) if line.startswith("not seen")] == [
        f"not seen: {one}" for one in NOT_SEEN
    ]
    assert [line for line in said(ergonomics) if line.startswith("by rule")] == [f"by rule: {one}" for one in RULES]


def test_posture_off_is_said():
    off = said(ergonomics, ("horizon: 1 h", "horizon: 1 h, posture: off"), ("rula_mean", "walked_m"))
    assert off == [
        "postures: posture: off: nobody looks at postures, and there is no figure of them; times are as ever"
    ]


def test_each_effect_has_its_source_and_says_which_parameters_nobody_gave():
    learning, fatigue, shift, still, *_ = said(human, EFFECTS)
    assert learning.startswith("human effects: learning, wright (rate 0.9, measured_at 1 by default): each doubling")
    assert "Wright, T. P. (1936)" in learning
    assert "fatigue, lffrm (tires_half_in 4 h by default" in fatigue and "Jaber" in fatigue
    assert "is an assumption" in fatigue
    assert "an extrapolation" in shift
    assert still == "human effects: wait: the time alone follows the shift of pace; there is no body that could"


def test_experience_and_absence_of_everybody_are_said():
    lines = said(human, EFFECTS)
    assert "absence: ana: 0.1 of their shifts, as the scenario says of everybody" in lines
    assert any(
        line.startswith("experience: repetitions behind them at the start: ana make 40; whoever") for line in lines
    )


def test_by_time_alone_postures_stay():
    (line,) = said(human, ("outputs:", "human: {acts_on: time, fatigue: {model: lffrm}}\noutputs:"))[1:2]
    assert "effects change times alone" in line


@pytest.mark.parametrize("edits", [(), (EFFECTS,)])
def test_nobody_is_called_fresh_who_tires(edits):
    told = " ".join(said(assumptions_of, *edits))
    assert ("no fatigue" in told) is (not edits) and ("no learning" in told) is (not edits)


def test_nothing_is_said_where_no_effect_is_on():
    assert said(human) == []
