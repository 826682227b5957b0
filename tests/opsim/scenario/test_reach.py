"""Hands that go to heights of places: what may be said, what is wrong with it, and what follows from it."""

import numpy as np
import pytest
from plans import answer, loaded, plan
from twins import of_both

from opsim.layout import distances_m
from opsim.study.assumptions import assumptions_of
from opsim.subjects.tasks.warnings import stretched

GOOD = """
opsim: 1
name: rack
run: {horizon: 20 min}
libraries: {bench: libraries/bench_work.npz, walking: libraries/walking.npz}
layout:
  places:
    rack: {at: [3 m, 1 m], levels: {low: 0.34 m, knee: 0.42 m}}
    bench: {at: [0 m, 0 m], surface: 1 m}
    door: [9 m, 0 m]
tasks:
  pick: {emulator: bench/lift, load: 6 kg, hands: {grasp: rack.low, set_down: bench.surface}}
  look: {fixed: 10 s}
  stroll: {emulator: walking/walk}
stations: {s1: {at: rack, tasks: [pick, look], buffer: 2}, s2: {at: door, tasks: [stroll]}}
products: {part: {route: [s1, s2]}}
release: {kind: saturated}
workers: {ana: {skills: {s1: 1, s2: 1}}}
allocation: {rule: oldest_job}
"""


def edited(*edits, text=GOOD):
    for old, new in edits:
        assert text.count(old) == 1, (old, text.count(old))
        text = text.replace(old, new)
    return text


RIGHT = [
    ("a height", ("grasp: rack.low", "grasp: 34 cm")),
    ("a depth", ("0.42 m}}", "0.42 m}, depth: 0.35 m}")),
    (
        "no heights",
        ("bench: {at: [0 m, 0 m], surface: 1 m}", "bench: {at: [0 m, 0 m]}"),
        (", set_down: bench.surface", ""),
    ),
    ("a level with a number", ("low: 0.34 m", "1: 0.34 m"), ("rack.low", "rack.1")),
    ("another layout", ("  places:", "  distance: paths\n  paths: [[rack, bench, door]]\n  places:")),
]


@pytest.mark.parametrize("edits", [edits for _, *edits in RIGHT], ids=[name for name, *_ in RIGHT])
def test_what_is_right_is_read(edits):
    assert answer(edited(*edits)) == "good"


HEIGHT = "tasks.pick.hands.grasp: "
WRONG = [
    ("level", [("grasp: rack.low", "grasp: rack.lwo")], [HEIGHT + "no height 'lwo' at the place 'rack'", "'low'?"]),
    ("place", [("grasp: rack.low", "grasp: rakc.low")], [HEIGHT + "no place 'rakc'", "did you mean 'rack'?"]),
    ("bare", [("grasp: rack.low", "grasp: door.low")], [HEIGHT + "the place 'door' has no heights", "levels: {low"]),
    ("only a place", [("grasp: rack.low", "grasp: rack")], [HEIGHT + "expected a height, found 'rack'", "rack.low"]),
    ("no unit", [("grasp: rack.low", "grasp: 0.3")], [HEIGHT + "0.3 has no unit; expected a length", "'0.3 m'"]),
    ("below", [("grasp: rack.low", "grasp: -3 cm")], [HEIGHT + "must be at least 0 m", "count from the floor"]),
    ("too high", [("grasp: rack.low", "grasp: 2.9 m")], [HEIGHT, "height 2.90 m", "far outside", "heights 0.2"]),
    ("level below", [("low: 0.34 m", "low: -0.34 m")], ["places.rack.levels.low: must be at least 0 m"]),
    ("far level", [("low: 0.34 m", "low: 1.4 m")], ["layout.places.rack.levels.low: tasks.pick: ", "far outside"]),
    ("far surface", [("surface: 1 m", "surface: 12 cm")], ["layout.places.bench.surface: tasks.pick: ", "at set_down"]),
    ("mark", [("{grasp:", "{gasp:")], ["tasks.pick.hands.gasp: no mark 'gasp' in this", "did you mean 'grasp'?"]),
    ("no body", [("look: {fixed: 10 s", "look: {fixed: 10 s, hands: {a: 1 m}")], ["tasks.look.hands: ", "has 'fixed'"]),
    ("no marks", [("walking/walk}", "walking/walk, hands: {a: 1 m}}")], ["tasks.stroll.hands.a: ", "no marks"]),
    ("no point", [("at: [3 m, 1 m], levels", "levels")], ["layout.places.rack: 'at' is missing", "at: [9 m, 1 m]"]),
    ("half a point", [("at: [3 m, 1 m]", "at: [3 m]")], ["layout.places.rack.at: expected a place as two lengths"]),
    ("key", [("levels:", "level:")], ["layout.places.rack.level: unknown key 'level'", "'levels'?"]),
    ("twice", [("0.42 m}}", "0.42 m, surface: 1 m}, surface: 1 m}")], ["rack.surface: two heights are called surface"]),
    ("depth", [("0.42 m}}", "0.42 m}, depth: 4 m}")], ["places.rack.depth: must be at most 2 m, found '4 m'"]),
]


@pytest.mark.parametrize(("edits", "says"), [case[1:] for case in WRONG], ids=[case[0] for case in WRONG])
def test_what_is_wrong_is_said_with_its_place(edits, says):
    said = answer(edited(*edits))
    assert all(words in said for words in says), said
    assert said.endswith("1 problem in line.yaml"), said


def test_all_mistakes_of_a_task_are_said_at_once():
    said = answer(edited(("grasp: rack.low, set_down", "grasp: rack.lo, setdown")))
    assert "'lo'" in said and "'setdown'" in said and said.endswith("2 problems in line.yaml")


def test_a_place_with_heights_is_where_one_without_is():
    bare = edited(("{at: [3 m, 1 m], levels: {low: 0.34 m, knee: 0.42 m}}", "[3 m, 1 m]"), ("rack.low", "0.34 m"))
    one, other = loaded(GOOD).scenario.layout, loaded(bare).scenario.layout
    assert one.places == other.places and distances_m(one) == distances_m(other)
    a, b = of_both(plan(GOOD)), of_both(plan(bare))
    assert all(np.array_equal(a[name], b[name]) for name in ("start_s", "end_s", "task"))


def mean_s(*edits):
    return next(task.mean_s() for task in plan(edited(*edits)).tasks if task.name == "pick")


def test_time_follows_the_height_and_off_means_off():
    plain = mean_s((", hands: {grasp: rack.low, set_down: bench.surface}", ""))
    low, knee = mean_s(), mean_s(("rack.low", "rack.knee"))
    assert len({plain, low, knee}) == 3
    assert mean_s(("rack.low", "rack.knee"), ("knee: 0.42 m", "knee: 0.34 m")) == low


def test_hands_are_where_the_scenario_says():
    task = next(task for task in plan(GOOD).tasks if task.name == "pick")
    drawn = task.model.sample(20, np.random.default_rng(4))
    names = drawn.skeleton.names
    wrists = [names.index("left_wrist"), names.index("right_wrist")]
    high_m = drawn.positions_m(drawn.mark_s)[:, :, wrists, 2].mean(axis=2)
    assert np.abs(high_m - [0.34, 1.0]).max() < 0.005


def test_what_is_far_from_the_recordings_is_warned_of_and_on_the_assumption_sheet():
    assert not list(stretched(plan(GOOD)))
    text = edited(("low: 0.34 m", "low: 0.5 m"))
    (said,) = stretched(plan(text))
    assert said.startswith("pick: ") and "height 0.50 m lies a little outside" in said
    reach = [words for topic, words in assumptions_of(loaded(text), plan(text)) if topic == "reach"]
    assert "(at grasp rack.low, 0.5 m, set_down bench.surface, 1 m)" in reach[0] and reach[1] == said


def test_a_body_that_is_far_from_the_recordings_is_warned_of():
    small = ("{ana: {skills", "{ana: {height: 1.45 m, skills")
    for variability in ("full", "none"):
        (said,) = stretched(plan(edited(small, ("horizon: 20 min", f"horizon: 20 min, variability: {variability}"))))
        assert said.startswith("pick: with the body of ana: ")
