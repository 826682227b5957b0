"""Batches that never fill, products that are never made or finished, distances that are slips, things nobody uses."""

from pathlib import Path

import pytest

from opsim.plan.warnings import risks_of
from opsim.scenario.read import scenarios_in

LINE = """
opsim: 1
name: Line
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m], far: [9 m, 3 m]}}
tasks: {do: {fixed: 3 s, automatic: true}}
stations:
  cut: {at: here, tasks: [do]}
  bake: {at: there, tasks: [do], servers: 1, buffer: 4, batch: {size: 3}}
products: {a: {share: 0.5, route: [cut, bake]}, b: {share: 0.5, route: [cut, bake]}}
release: {kind: poisson, every: 9 s}
"""
STORE = [
    ("stations:", "stores: {rack: {at: far, capacity: 3}}\nstations:"),
    ("{a: {share: 0.5, route: [cut, bake]}", "{a: {share: 0.5, route: [cut, rack]}"),
    ("b: {share: 0.5, route: [cut, bake]}", "b: {share: 0.5, route: [cut, bake], parts: {cut: {a: 2}}}"),
]


def risks(*edits):
    text = LINE
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return risks_of(scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario)


def test_a_scenario_without_slips_has_no_risks():
    assert risks() == []


def test_a_batch_by_product_may_never_fill_where_there_is_little_room():
    (risk,) = risks(("{size: 3}", "{size: 3, of: product}"))
    assert risk == (
        "bake may fill up with jobs of different kinds, up to 4 of them, none of which is a batch of 3: then nothing "
        "moves any more; give the batch a 'most_wait', or more room"
    )
    assert risks(("{size: 3}", "{size: 3, of: product, most_wait: 1 min}")) == []
    assert risks(("{size: 3}", "{size: 3, of: product}"), ("buffer: 4", "buffer: 5")) == []


def test_a_batch_may_never_fill_with_too_few_cards():
    (risk,) = risks(("release:", "cards: {conwip: {n: 2}}\nrelease:"))
    assert risk.startswith("2 cards of conwip may all wait at bake for a batch of 3 that never fills")
    assert risks(("release:", "cards: {conwip: {n: 3}}\nrelease:")) == []


def test_what_no_source_makes_is_said():
    only_b = "sources: {calls: {kind: poisson, every: 9 s, products: [b]}}"
    assert "a is never made: no source makes it, and nothing is split into it" in risks(
        ("release: {kind: poisson, every: 9 s}", only_b)
    )


def test_an_assembly_without_parts_cannot_be_finished():
    only_b = "sources: {calls: {kind: poisson, every: 9 s, products: [b]}}"
    said = risks(*STORE, ("release: {kind: poisson, every: 9 s}", only_b))
    assert "b cannot be finished: at cut it waits for a, which is never made" in said


def test_more_parts_at_once_than_a_store_holds_are_said():
    said = risks(*STORE, ("{a: 2}", "{a: 4}"))
    assert "b cannot be finished: at cut it takes 4 a at once, and 3 fit in store" in said


def test_a_batch_that_takes_more_parts_at_once_than_a_store_holds_is_said():
    batch = *STORE, ("{at: here, tasks: [do]}", "{at: here, tasks: [do], batch: {size: 2}}")
    assert (
        "2 b in one batch at cut take 4 a at once, and 3 fit in store: such a batch waits for ever; make room for "
        "more, or smaller batches"
    ) in risks(*batch)
    assert not any("in one batch" in risk for risk in risks(*batch, ("capacity: 3", "capacity: 4")))


def test_what_ends_in_a_store_and_is_part_of_nothing_piles_up():
    said = risks(*STORE, (", parts: {cut: {a: 2}}", ""))
    assert "a ends in rack, from which nothing takes it: it piles up there and is never finished" in said


@pytest.mark.parametrize(
    ("places", "said"),
    [
        ("[900 m, 3 m]", "far is 896.005 m from the nearest other place, others 4 m: is it in metres?"),
        ("[4 m, 0 m]", "far and there are in one and the same point: no way between them"),
    ],
)
def test_a_place_far_away_or_twice_is_suspicious(places, said):
    assert risks(("far: [9 m, 3 m]", f"far: {places}")) == [said]


def test_a_layout_the_size_of_a_table_is_suspicious():
    edits = (("there: [4 m, 0 m]", "there: [0.4 m, 0 m]"), ("far: [9 m, 3 m]", "far: [0 m, 0.3 m]"))
    assert risks(*edits) == ["all places lie within 0.5 m: are they in metres?"]


@pytest.mark.parametrize(
    ("length", "said"), [("3 m", "nothing is shorter than straight"), ("80 m", "is it in metres?")]
)
def test_a_path_of_an_impossible_length_is_suspicious(length, said):
    path = f"{{distance: paths, paths: [{{from: here, to: there, length: {length}}}, [there, far]], places"
    (risk,) = risks(("{places", path))
    assert risk.startswith("the path from here to there is") and risk.endswith(said)


def test_a_belt_of_an_impossible_length_is_suspicious():
    belt = "conveyors: {belt: {from: here, to: there, length: 2 m, speed: 1 m/s, pitch: 1 m}}\nstations:"
    assert "conveyor belt, from here to there is 2 m long, the straight line 4 m: nothing is shorter than straight" in (
        risks(("stations:", belt), ("route: [cut, bake]", "route: [cut, belt, bake]"))
    )


def test_what_nobody_uses_is_said():
    unused = "tools: {gun: {n: 1}}\nrepair_teams: {mechanics: {n: 1}}\nstations:\n  idle: {at: far, tasks: [do]}"
    assert risks(("stations:", unused)) == [
        "no product comes to idle: nothing will happen there",
        "tool gun: nothing needs it",
        "repair team mechanics: nothing needs it",
    ]
