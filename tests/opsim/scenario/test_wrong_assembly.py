"""Stores, bills of material, splits and batches that cannot be: refused with their place and a way out."""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

BIKES = """
opsim: 1
name: bikes
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 10 s, automatic: true}}
stores: {wheels: {at: here, capacity: 5, initial: 2}, frames: {at: here}}
stations:
  weld: {at: here, tasks: [do], buffer: 2}
  join: {at: here, tasks: [do], buffer: 4}
  saw: {at: here, tasks: [do]}
products:
  wheel: {route: [wheels]}
  frame: {routing: {start: weld, weld: frames}}
  bike: {route: [weld, join], parts: {join: {wheel: 2, frame: 1}}}
  tube: {route: [saw], split: {saw: {wheel: 3}}}
sources:
  all: {kind: poisson, every: 60 s, products: [wheel, frame, bike, tube]}
"""


def said(*edits: tuple[str, str]) -> str:
    text = BIKES
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("bikes.yaml"))
    return str(caught.value)


def test_the_scenario_itself_is_right():
    assert set(scenarios_in(BIKES.encode(), Path("bikes.yaml"))) == {"base"}


@pytest.mark.parametrize(("edit", "words"), [
    (("wheels: {at: here", "wheels: {at: hree"), ["stores.wheels.at: no place 'hree'", "did you mean 'here'?"]),
    (("capacity: 5", "capacity: 0"), ["a store has from 1 to 1,000,000,000 places, found 0"]),
    (("initial: 2", "initial: -1"), ["stores.wheels.initial: must be from 0 to 100,000, found -1"]),
    (("initial: 2", "initial: 6"), ["6 lie here at the start, and 5 have room", "raise the capacity"]),
    (("initial: 2", "initial: {wheal: 2}"), ["no way of 'wheal' ends in 'wheels'", "did you mean 'wheel'?"]),
    (("{route: [wheels]}", "{route: [frames]}"), ["the way of no product ends in the store 'wheels'"]),
    (("[wheels]", "[wheels, weld]"), ["route[0]", "no way leads on from it"]),
    (("[wheels]", "[[wheels, frames]]"), ["a way ends in one store, and 'wheels' stands among others"]),
    (("weld: frames}", "weld: frames, frames: out}"), ["routing.frames", "no way leads on from it"]),
])  # fmt: skip
def test_a_store_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_a_number_alone_needs_one_product_to_be_of():
    two = ("[wheels]}", "[wheels]}\n  rim: {route: [wheels]}")
    assert "rim and wheel end in 'wheels': of which are these?" in said(two)


@pytest.mark.parametrize(("edit", "words"), [
    (("{wheel: 2, frame: 1}", "{wheal: 2, frame: 1}"), ["join.wheal: no product 'wheal'", "did you mean 'wheel'?"]),
    (("{wheel: 2, frame: 1}", "{wheel: 0}"), ["products.bike.parts.join.wheel: must be at least 1, found 0"]),
    (("{wheel: 2, frame: 1}", "{tube: 1}"), ["no 'tube' can be taken as a part: its way ends in no store", "[..., "]),
    (("parts: {join", "parts: {joint"), ["parts.joint: no station 'joint'", "did you mean 'join'?"]),
    (("parts: {join", "parts: {wheels"), ["no station 'wheels'"]),
    (("[weld, join]", "[weld]"), ["the way of 'bike' skips 'join', where parts go in", "add join to its route"]),
    (("[weld, join]", "[weld, [join, saw]]"), ["a job that goes to 'saw' instead would skip 'join'"]),
    (("split: {saw", "split: {weld"), ["the way of 'tube' skips 'weld', where it is split"]),
    (("[saw]", "[saw, weld]"), ["after 'saw' there is no 'tube' any more, and its way goes on to 'weld'"]),
    (("{route: [saw]", "{routing: {start: saw, saw: {weld: 0.5, out: 0.5}, weld: out}"), ["goes on to 'weld'"]),
    (("{saw: {wheel: 3}}", "{saw: {tube: 3}}"), ["splitting never comes to an end: tube becomes tube"]),
])  # fmt: skip
def test_a_bill_of_material_or_a_split_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_a_bill_of_material_in_a_circle_is_refused_once_with_the_circle():
    answer = said(
        ("frame: {routing: {start: weld, weld: frames}}", "frame: {route: [weld, frames], parts: {weld: {bike: 1}}}"),
        ("[weld, join], parts", "[join, wheels], parts"),
        ("wheel: 2, frame: 1", "frame: 1"),
    )
    assert answer.count("goes round in a circle") == 1
    assert "the bill of material goes round in a circle: bike needs frame needs bike" in answer
    assert "take bike out of 'products.frame.parts', or break the circle elsewhere" in answer


@pytest.mark.parametrize(("edit", "words"), [
    (("buffer: 4}", "buffer: 3, batch: {size: 4}}"), ["a batch of 4 never comes together in a buffer of 3"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 1}}"), ["batch.size: must be at least 2, found 1"]),
    (("buffer: 4}", "buffer: 4, batch: {siz: 4}}"), ["unknown key 'siz'", "did you mean 'size'?"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 4, of: famly}}"), ["did you mean 'family'?"]),
    (("buffer: 4}", "buffer: 4, batch: {size: 4, most_wait: 10}}"), ["stations.join.batch.most_wait"]),
    (("frame: 1}}", "frame: 1}}, lot: 0"), ["products.bike.lot: must be at least 1, found 0"]),
    (("automatic: true", "automatic: true, per: batch"), ["tasks.do.per: expected unit or lot, found 'batch'"]),
])  # fmt: skip
def test_a_batch_or_a_lot_that_cannot_be_is_refused(edit, words):
    answer = said(edit)
    assert all(word in answer for word in words), answer


def test_nobody_carries_a_batch():
    batch, carried = ("buffer: 4}", "buffer: 4, batch: {size: 2}}"), ("frame: 1}}", "frame: 1}}, carried: true")
    assert "'bike' comes to 'join', whose batches nobody can carry on" in said(batch, carried)
