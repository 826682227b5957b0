"""Wrong words about human effects: what is said of each, and where."""

import pickle

import plans
import pytest

from opsim.human.catalogue import catalogue
from opsim.scenario.schema import Scenario
from opsim.scenario.schema.human import Human

GOOD = """
opsim: 1
name: people
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 10 s}}
stations: {s1: {at: a, tasks: [make]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s1: 1}, experience: {make: 200}}}
human: {acts_on: time, learning: {model: wright, rate: 0.85, measured_at: 9}, forgetting: {forgotten_in: never},
  state_pace: {faster: 0.2}, circadian: {amplitude: 0.1, peak: '16:00'}}
"""
FATIGUE = ("human: {", "human: {fatigue: {model: lffrm, recovers_half_in: 20 min}, ")


def answer(*edits):
    return plans.answer(GOOD, *edits)


def test_what_is_right_is_read():
    assert answer() == "good"
    assert (
        answer(("human: {acts_on", "overrides: {off: {human: null}}\nscenarios: {off: [off]}\nhuman: {acts_on"))
        == "good"
    )
    assert (
        answer(FATIGUE, ("acts_on: time,", "rest: {above: 0.5, until: 0.2}, errors: {at_full_fatigue: 0.1},")) == "good"
    )


CASES = [
    ("model", [("model: wright", "model: write")], ["human.learning.model: no model of learning is called 'write'"]),
    ("near", [("model: wright", "model: write")], ["did you mean 'wright'?"]),
    ("no model", [("model: wright, ", "")], ["human.learning: nothing says which model of learning"]),
    ("a word", [("{model: wright, rate: 0.85, measured_at: 9}", "wright")], ["learning: expected a block of keys"]),
    ("of another", [("rate: 0.85", "floor: 0.3")], ["human.learning.floor: unknown key 'floor'"]),
    ("key", [("rate: 0.85", "rat: 0.85")], ["human.learning.rat: unknown key 'rat'", "did you mean 'rate'?"]),
    ("rate", [("rate: 0.85", "rate: 0.4")], ["human.learning.rate: must be more than 0.5, found 0.4"]),
    ("effect", [("learning: {", "lerning: {")], ["human.lerning: unknown key 'lerning'", "did you mean 'learning'?"]),
    ("unit", [("forgotten_in: never", "forgotten_in: 90")], ["forgetting.forgotten_in: 90 has no unit"]),
    ("clock", [("'16:00'", "4 pm")], ["human.circadian.peak: expected a time of the day, found '4 pm'", "write 16:00"]),
    (
        "in an effect",
        [("rate: 0.85", "rate: 0.85, acts_on: time")],
        ["human.learning.acts_on: unknown key 'acts_on'", "'acts_on' stands under 'human' itself, beside 'learning'"],
    ),
    ("measured", [("measured_at: 9", "measured_at: 1e9")], ["human.learning.measured_at: must be at most 1"]),
    ("acts", [("acts_on: time", "acts_on: times")], ["human.acts_on: expected posture or time"]),
    ("absence", [("acts_on: time", "absence: 5 %")], ["human.absence: expected a probability, found '5 %'", "0.05"]),
    ("task", [("{make: 200}", "{mkae: 200}")], ["workers.ana.experience.mkae: no task 'mkae'", "did you mean 'make'?"]),
    ("less", [("{make: 200}", "{make: -2}")], ["workers.ana.experience.make: must be at least 0"]),
    (
        "rest",
        [("acts_on: time", "rest: {above: 0.5, until: 0.2}")],
        ["human.rest: nobody tires, and nobody rests from it", "fatigue: {model: lffrm}"],
    ),
    ("errors", [("acts_on: time", "errors: {}")], ["human.errors: nobody tires, and nobody errs by it"]),
    (
        "forgetting",
        [("learning: {model: wright, rate: 0.85, measured_at: 9}, ", "")],
        ["human.forgetting: nobody learns what could be forgotten"],
    ),
    (
        "until",
        [FATIGUE, ("acts_on: time", "rest: {above: 0.2, until: 0.5}")],
        ["human.rest.until: found 0.5, expected less than above"],
    ),
    (
        "no body",
        [("acts_on: time", "fatigue: {model: 3cc_r}")],
        ["human.fatigue.model: 3cc_r tires muscles by the torque of joints, and no task has a body"],
    ),
    (
        "nobody",
        [FATIGUE, ("acts_on: time", "errors: {}"), ("fixed: 10 s", "fixed: 10 s, automatic: true")],
        ["human.errors: every task is automatic: nobody is there to err"],
    ),
]


@pytest.mark.parametrize(("edits", "words"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_each_mistake_is_named_where_it_stands(edits, words):
    said = answer(*edits)
    assert all(word in said for word in words), said
    assert any(f"line.yaml:{line}:" in said for line in (10, 11, 12))


def test_all_mistakes_are_told_at_once():
    said = answer(("rate: 0.85", "rate: 2"), ("faster: 0.2", "faster: -1"), ("{make: 200}", "{mak: 2}"))
    assert "3 problems in line.yaml" in said, said


@pytest.mark.parametrize("one", list(catalogue()), ids=lambda one: f"{one.effect}-{one.model}")
def test_every_model_of_the_catalogue_is_a_block_with_its_parameters_and_defaults(one):
    given = {p.name.removesuffix("_s"): "1 h" if p.unit == "s" else 1 for p in one.parameters if p.required}
    block = getattr(Human.model_validate({one.effect: {"model": one.model, **given}}), one.effect)
    needed = {p.name: 3600.0 if p.unit == "s" else 1 for p in one.parameters if p.required}
    wanted = {p.name: p.default for p in one.parameters} | needed
    assert {name: getattr(block, name) for name in type(block).model_fields if name != "model"} == wanted
    assert all(field.description for field in type(block).model_fields.values())


def test_a_scenario_with_effects_can_be_sent_to_another_process():
    sent = plans.loaded(GOOD.replace(*FATIGUE))
    assert pickle.loads(pickle.dumps(sent)) == sent


def test_every_effect_is_off_unless_it_is_named():
    human = Scenario.model_fields["human"].get_default(call_default_factory=True)
    assert {name for name in Human.model_fields if getattr(human, name) is not None} == {"acts_on"}
