from pathlib import Path

import pytest

from opsim.plan.warnings import risks_of
from opsim.scenario.read import scenarios_in

LINE = """
opsim: 1
name: Rework
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 3 s, automatic: true}}
stations:
  cut: {at: here, tasks: [do], buffer: 2}
  drill: {at: here, tasks: [do], buffer: 2}
  out: {at: here, tasks: [do], buffer: 2}
products: {part: {route: [cut, drill, out]}}
release: {kind: saturated}
"""


def risks(*edits):
    text = LINE
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return risks_of(scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario)


def test_a_line_has_no_risks():
    assert risks() == []


def test_a_route_that_comes_back_through_finite_buffers_may_lock():
    assert risks(("[cut, drill, out]", "[cut, drill, cut, out]")) == [
        "cut and drill send jobs round in a circle through buffers with limits: when all are full, nothing moves any "
        "more; give one of them 'buffer: unlimited'"
    ]


def test_two_products_that_cross_may_lock():
    crossing = "{a: {share: 0.5, route: [cut, drill]}, b: {share: 0.5, route: [[drill, out], cut]}}"
    (risk,) = risks(("{part: {route: [cut, drill, out]}}", crossing))
    assert risk.startswith("cut and drill send jobs round")


def test_a_station_that_sends_to_itself_does_not_lock():
    assert risks(("[cut, drill, out]", "[cut, drill, drill, out]")) == []


@pytest.mark.parametrize("station", ["cut", "drill"])
def test_one_buffer_without_limit_takes_the_risk_away(station):
    edits = [("[cut, drill, out]", "[out, cut, drill, cut]")]
    edits += [(f"{station}: {{at: here, tasks: [do], buffer: 2}}", f"{station}: {{at: here, tasks: [do]}}")]
    assert risks(*edits) == []


def test_rework_by_probability_through_finite_buffers_may_lock():
    first, second = risks(
        ("route: [cut, drill, out]", "routing: {start: cut, cut: drill, drill: {cut: 0.1, out: 0.9}}"),
        ("  out: {at", "  paint: {at"),
    )
    assert first.startswith("cut and drill send jobs round")
    assert second == "no product comes to paint: nothing will happen there"


def test_a_patrol_while_idle_workers_stay_is_said_to_mean_nothing():
    (risk,) = risks(("release:", "workers: {ana: {skills: {cut: 1}, patrol: [cut]}}\nrelease:"))
    assert risk == "ana has a patrol, which means nothing while idle workers stay"


HELD = [
    ("fixed: 3 s, automatic: true", "fixed: 3 s"),
    ("release:", "allocation: {when_blocked: held}\nworkers: {ana: {skills: {cut: 1, drill: 1, out: 1}}}\nrelease:"),
]


def test_a_rotation_by_count_may_leave_a_station_to_somebody_who_is_held():
    """Three people for three stations in a row can never all be held; but he can whose post it is now."""
    three = (
        "ana: {skills: {cut: 1, drill: 1, out: 1}}",
        "ana: {skills: {cut: 1, drill: 1, out: 1}}, ben: {like: ana}, cem: {like: ana}",
    )
    rotation = "rotations: {r: {workers: [ana, ben, cem], posts: [cut, drill, out], WHEN}}\nworkers: {"
    assert risks(*HELD, three) == risks(*HELD, three, ("workers: {", rotation.replace("WHEN", "every: 1 h"))) == []
    first, second = risks(*HELD, three, ("workers: {", rotation.replace("WHEN", "after: 9")))
    assert first.startswith(
        "with when_blocked: held, those of ana, ben and cem whose post it is can all be held at cut"
    )
    assert second.startswith(
        "with when_blocked: held, those of ana, ben and cem whose post it is can all be held at drill"
    )


def test_a_crew_goes_with_its_jobs_and_is_held_by_none_of_them():
    crew = (
        "workers: {",
        "crews: {all: {kind: rabbit_chase, stations: [cut, drill, out], workers: [ana, ben]}}\nworkers: {",
    )
    two = ("ana: {skills: {cut: 1, drill: 1, out: 1}}", "ana: {skills: {cut: 1, drill: 1, out: 1}}, ben: {like: ana}")
    assert [risk for risk in risks(*HELD, two) if "can all be held" in risk]
    assert risks(*HELD, two, crew) == []


def test_one_worker_held_between_two_stations_may_lock():
    first, second = risks(*HELD)
    assert first.startswith("with when_blocked: held, ana can all be held at cut while drill is full")
    assert second.startswith("with when_blocked: held, ana can all be held at drill while out is full")


@pytest.mark.parametrize(
    "edit",
    [
        ("when_blocked: held", "when_blocked: free"),
        ("{ana: {", "{ben: {skills: {drill: 1}}, cai: {skills: {out: 1}}, ana: {"),
        ("buffer: 2", "buffer: unlimited"),
    ],
    ids=["free", "others", "room"],
)
def test_nobody_is_held_for_ever(edit):
    edits = [*HELD, edit] if edit[0] != "buffer: 2" else [*HELD, edit, ("kind: saturated", "kind: poisson, every: 9 s")]
    assert risks(*edits) == []


def test_one_worker_who_carries_between_two_stations_may_lock():
    carried = [HELD[0], (HELD[1][0], HELD[1][1].replace("held", "free")), ("out]}", "out], carried: true}")]
    first, _ = risks(*carried)
    assert first.startswith("with carried: true, ana can all be held at cut while drill is full")
    assert "take 'carried: false'" in first


def test_postures_of_times_without_a_body_are_warned_of():
    asked = "release: {kind: saturated}\noutputs: [trunk_beyond_60_min_per_h, walked_m]"
    assert risks(("release: {kind: saturated}", asked)) == [
        "outputs: trunk_beyond_60_min_per_h made from postures, and no task has an emulator: nothing will be measured"
    ]
    assert risks(("release: {kind: saturated}", asked), ("fixed: 3 s", "plugin: exponential, with: {mean: 3 s}")) == []


def test_figures_of_walking_without_walking_are_warned_of():
    asked = "release: {kind: saturated}\noutputs: [steps_per_h, walking_min_per_h, walked_m]"
    (said,) = risks(("release: {kind: saturated}", asked))
    assert said.startswith("outputs: steps_per_h and walking_min_per_h made from postures of walking, and nothing says")
    assert "walking: {emulator: walking/walk}" in said
