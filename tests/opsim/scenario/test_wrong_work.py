"""Wrong words about loads, hands, scoring and the frontier: what is said of each, and where.

Wrong words about human effects: what is said of each, and where.

Wrong scenarios and the complete answer to each, in ``wrong_files.txt``: a claim, edits of ``good.yaml``, the answer.

After a change of words ``PYTHONPATH=tests:. python tests/opsim/scenario/test_wrong_work.py`` writes the answers anew;
read them before they are committed.
"""

import pickle
from pathlib import Path

import plans
import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.scenario.schema import Scenario
from opsim.subjects.human.catalogue import catalogue
from opsim.subjects.human.words import Human

GOOD = """
opsim: 1
name: hands
run: {horizon: 1 h, posture: on}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  make: {emulator: work/fasten, load: 2 kg, loaded: {from: start, to: stop}, handling: {grip: fair, sitting: false}}
  look: {fixed: 10 s, load: 0 kg, handling: {force: static, forearm: end, arms_supported: true, legs: balanced}}
  bake: {fixed: 9 s, automatic: true}
stations: {s1: {at: a, tasks: [make, look, bake]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s1: 1}}}
ergonomics:
  {rate: 12, arm_reference: gravity, rula: {table_a: worksheet2000, force: worksheet}, waiting: upright,
  owas: {disputed: ['3373', 4132]}, thresholds: {twist: 10 deg, side: 0.2 rad, across: 4 cm, spread: true}}
outputs: [throughput_per_h, trunk_beyond_60_min_per_h]
frontier: [throughput_per_h, trunk_beyond_60_min_per_h/ana]
"""
ON = 4, 8, 9, 10, 16, 17, 18, 19
"""The lines that these words stand on."""


def answer(*edits):
    return plans.answer(GOOD, *edits)


def test_what_is_right_is_read():
    assert answer() == "good"
    assert answer(("from: start, to: stop", "from: 0.1, to: 0.9")) == "good"
    assert answer(("posture: on", "posture: true")) == "good"
    usual = "defaults: {tasks: {handling: {grip: good}}}\ntasks:\n"
    assert answer(("tasks:\n", usual)) == "good"  # a machine among many tasks has no use for what is said of all


CASES = [
    ("no unit", [("load: 2 kg", "load: 2")], ["tasks.make.load: 2 has no unit; expected a mass", "'2 kg'"]),
    ("too much", [("load: 2 kg", "load: 6000 kg")], ["tasks.make.load: must be at most 500 kg, found '6000 kg'"]),
    ("a length", [("load: 2 kg", "load: 2 cm")], ["'2 cm' is a length; expected a mass"]),
    ("no load", [(" load: 2 kg,", "")], ["tasks.make.loaded: nothing says what is in the hands then", "load: 6 kg"]),
    ("mark", [("to: stop", "to: stpo")], ["tasks.make.loaded.to: no mark 'stpo' in this movement", "mean 'stop'?"]),
    ("no marks", [("load: 0 kg,", "load: 1 kg, loaded: {from: start},")], ["tasks.look.loaded.from: this task has no"]),
    ("turned", [("from: start, to: stop", "from: stop, to: start")], ["tasks.make.loaded.to: start comes before stop"]),
    (
        "grip",
        [("grip: fair", "grip: fare")],
        ["make.handling.grip: expected good, fair, poor or unacceptable", "did you mean 'fair'?"],
    ),
    ("key", [("grip: fair", "gripp: fair")], ["unknown key 'gripp'", "did you mean 'grip'?"]),
    ("sitting", [("sitting: false", "sitting: no")], ["make.handling.sitting: expected true or false, found 'no'"]),
    (
        "hands of a machine",
        [("automatic: true", "automatic: true, handling: {grip: fair}")],
        ["tasks.bake.handling: the station works alone: there are no hands", "remove 'handling'"],
    ),
    ("rate", [("rate: 12", "rate: 0.5")], ["ergonomics.rate: must be at least 1, found 0.5"]),
    ("arms", [("gravity", "gravitation")], ["ergonomics.arm_reference: expected trunk or gravity", "'gravity'?"]),
    ("method", [("{rate: 12", "{rulla: {}, rate: 12")], ["unknown key 'rulla'", "did you mean 'rula'?"]),
    ("table", [("worksheet2000", "worksheet")], ["rula.table_a: expected published or worksheet2000"]),
    ("code", [("'3373'", "'3374'")], ["owas.disputed[0]: no code '3374' whose category is disputed", "'3373'"]),
    ("angle", [("twist: 10 deg", "twist: 10")], ["thresholds.twist: 10 has no unit; expected an angle", "'10 deg'"]),
    ("degrees", [("twist: 10 deg", "twist: 10\u00b0")], ["thresholds.twist: unknown unit '\u00b0'", "write '10 deg'"]),
    (
        "out of range",
        [("twist: 10 deg", "trunk_upright: 25 deg")],
        ["thresholds.trunk_upright: expected 0 deg to 20 deg, found 25 deg", "next step of the trunk"],
    ),
    ("knee", [("twist: 10 deg", "owas_knee: 30 deg")], ["owas_knee: expected 90 deg to 179 deg, found 30 deg"]),
    ("order", [("twist: 10 deg", "abducted: 85 deg")], ["thresholds.abducted: thresholds out of order", "80 deg"]),
    ("length", [("across: 4 cm", "across: 2 m")], ["thresholds.across: expected 0 m to 0.5 m, found 2 m"]),
    ("off", [("posture: on", "posture: none")], ["run.posture: expected on or off, found 'none'"]),
    (
        "blind",
        [("posture: on", "posture: off")],
        ["outputs[1]: it is made from postures, and nobody", "frontier[1]: it"],
    ),
    ("blind too", [("posture: on", "posture: false")], ["outputs[1]: it is made from postures, and nobody looks"]),
    ("three", [("frontier: [", "frontier: [walked_m, ")], ["frontier: expected two figures, found 3"]),
    ("figure", [("h/ana]", "h, troughput_per_h]"), ("frontier: [throughput_per_h, ", "frontier: [")], ["frontier[1]"]),
    ("same", [("frontier: [throughput_per_h, trunk", "frontier: [trunk_beyond_60_min_per_h/ana, trunk")], ["the same"]),
    (
        "neither",
        [("frontier: [throughput_per_h", "frontier: [worker_states")],
        ["nothing says whether more or less of"],
    ),
]


@pytest.mark.parametrize(("edits", "words"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_each_mistake_is_named_where_it_stands(edits, words):
    said = answer(*edits)
    assert all(word in said for word in words), said
    assert any(f"line.yaml:{line}:" in said for line in ON), said


def test_all_mistakes_are_told_at_once():
    said = answer(
        ("load: 2 kg", "load: 2"),
        ("to: stop", "to: stpo"),
        ("twist: 10 deg", "twist: 10"),
        ("automatic: true", "automatic: true, handling: {}, loaded: {from: 0.5}"),
    )
    assert "5 problems in line.yaml" in said, said


WRONG_HUMAN_GOOD = """
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


def wrong_human_answer(*edits):
    return plans.answer(WRONG_HUMAN_GOOD, *edits)


def test_what_is_right_is_read_of_wrong_human():
    assert wrong_human_answer() == "good"
    assert (
        wrong_human_answer(
            ("human: {acts_on", "overrides: {off: {human: null}}\nscenarios: {off: [off]}\nhuman: {acts_on")
        )
        == "good"
    )
    assert (
        wrong_human_answer(
            FATIGUE, ("acts_on: time,", "rest: {above: 0.5, until: 0.2}, errors: {at_full_fatigue: 0.1},")
        )
        == "good"
    )


WRONG_HUMAN_CASES = [
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


@pytest.mark.parametrize(
    ("edits", "words"), [case[1:] for case in WRONG_HUMAN_CASES], ids=[case[0] for case in WRONG_HUMAN_CASES]
)
def test_each_mistake_is_named_where_it_stands_of_wrong_human(edits, words):
    said = wrong_human_answer(*edits)
    assert all(word in said for word in words), said
    assert any(f"line.yaml:{line}:" in said for line in (10, 11, 12))


def test_all_mistakes_are_told_at_once_of_wrong_human():
    said = wrong_human_answer(("rate: 0.85", "rate: 2"), ("faster: 0.2", "faster: -1"), ("{make: 200}", "{mak: 2}"))
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
    sent = plans.loaded(WRONG_HUMAN_GOOD.replace(*FATIGUE))
    assert pickle.loads(pickle.dumps(sent)) == sent


def test_every_effect_is_off_unless_it_is_named():
    human = Scenario.model_fields["human"].get_default(call_default_factory=True)
    assert {name for name in Human.model_fields if getattr(human, name) is not None} == {"acts_on"}


HERE = Path(__file__).parent
WRONG_FILES_GOOD = (HERE / "good.yaml").read_text(encoding="utf-8")
WRONG_FILES = HERE / "wrong_files.txt"


def cases():
    """(claim, edits, answer) of every case; an edit replaces one text by another, backslash-n is a new line."""
    for block in WRONG_FILES.read_text(encoding="utf-8").removeprefix("# ").split("\n# "):
        claim, *lines = block.rstrip("\n").split("\n")
        n_edits = sum(1 for line in lines if line[:2] == "- ")
        edits = [
            (lines[2 * i][2:].replace("\\n", "\n"), lines[2 * i + 1][2:].replace("\\n", "\n")) for i in range(n_edits)
        ]
        yield claim, edits, "\n".join(lines[2 * n_edits :])


def wrong_files_answer(edits):
    """What the reader says of the good scenario with these edits."""
    text = WRONG_FILES_GOOD
    for old, new in edits:
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in good.yaml"
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("line.yaml"))
    return str(caught.value)


def renew():
    """Write every answer anew."""
    blocks = []
    for claim, edits, _ in cases():
        pairs = [f"{sign} {text}".replace("\n", "\\n") for pair in edits for sign, text in zip("-+", pair)]
        blocks.append("\n".join([f"# {claim}", *pairs, wrong_files_answer(edits)]) + "\n")
    WRONG_FILES.write_text("".join(f"{block}\n" for block in blocks).rstrip("\n") + "\n", encoding="utf-8")


@pytest.mark.parametrize(("claim", "edits", "expected"), [pytest.param(*case, id=case[0]) for case in cases()])
def test_a_wrong_file_gets_its_whole_answer(claim, edits, expected):
    assert wrong_files_answer(edits) == expected


def test_the_good_file_is_good():
    assert list(scenarios_in(WRONG_FILES_GOOD.encode(), Path("line.yaml"))) == ["base", "near"]


def test_no_answer_speaks_the_schema_s_own_language():
    said = WRONG_FILES.read_text(encoding="utf-8")
    assert not [word for word in ("Input should", "type=", "valid dictionary", "pydantic", "None") if word in said]


if __name__ == "__main__":
    renew()
