"""Wrong words about loads, hands, scoring and the frontier: what is said of each, and where."""

import plans
import pytest

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
