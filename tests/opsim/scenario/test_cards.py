"""Loops of cards that let nothing in, lead nowhere, or hold only some of alternative stations."""

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: loops
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}, s3: {at: hall, tasks: [t]}}
products:
  a: {share: 0.5, route: [s1, [s2, s3], s1]}
  b: {share: 0.5, routing: {start: s2, s2: {s3: 0.5, s2: 0.5}, s3: out}}
release: {kind: poisson, every: 60 s}
"""


def read(cards, tmp_path, text=TEXT):
    return scenarios_in(f"{text}cards: {cards}\n".encode(), tmp_path / "loops.yaml")["base"]


def said(cards, tmp_path, text=TEXT):
    with pytest.raises(ScenarioError) as caught:
        read(cards, tmp_path, text)
    return "\n".join(f"{p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


@pytest.mark.parametrize("cards", [
    "{conwip: {n: 3}}",
    "{loop: {n: 1, from: s1, to: [s2, s3], products: a}}",
    "{loop: {n: 1, from: s1, to: s1}}",
    "{loop: {n: 2, from: [s2, s3]}, other: {n: 2, to: s3, products: [b]}}",
])  # fmt: skip
def test_loops_along_the_way_of_a_product_are_read(cards, tmp_path):
    read(cards, tmp_path)


@pytest.mark.parametrize(("cards", "expected"), [
    ("{k: {n: 0}}", "cards.k.n: a loop of 0 cards lets no job in | give it at least one: 'n: 1'"),
    ("{k: {n: -2}}", "cards.k.n: a loop of -2 cards lets no job in"),
    ("{k: {from: s1}}", "cards.k: 'n' is missing | add e.g. 'n: 8'"),
    ("{k: {n: 2.5}}", "cards.k.n: expected a whole number, found 2.5"),
    ("{k: {n: 2, form: s1}}", "cards.k.form: unknown key 'form' | did you mean 'from'?"),
    ("{k: {n: 2, from: s4}}", "cards.k.from: no station 's4' | known stations: s1, s2, s3"),
    ("{k: {n: 2, products: [c]}}", "cards.k.products: no product 'c'"),
    ("{k: {n: 2, to: []}}", "cards.k.to: expected a station or a list of them, found an empty list"),
    ("{k: {n: 2, from: s3, to: s2, products: b}}", "cards.k: no product of b goes from 's3' to 's2' | a loop goes"),
    ("{k: {n: 2, from: s1, products: b}}", "cards.k: no product of b comes to 's1'"),
    ("{k: {n: 2, from: s2, products: a}}", "cards.k.from: a may go to s2 or s3, and the loop has only some"),
])  # fmt: skip
def test_what_is_wrong_with_a_loop_is_told_at_its_place(cards, expected, tmp_path):
    assert expected in said(cards, tmp_path)


def test_a_saturated_source_into_an_endless_buffer_ends_where_cards_limit_it(tmp_path):
    text = TEXT.replace("release: {kind: poisson, every: 60 s}", "release: {kind: saturated, products: [b]}")
    read("{conwip: {n: 5}}", tmp_path, text)
    read("{kanban: {n: 5, from: s2, to: s3, products: b}}", tmp_path, text)
    assert "never ends" in said("{conwip: {n: 5, products: a}}", tmp_path, text)
    assert "never ends" in said("{kanban: {n: 5, from: s3}}", tmp_path, text)


STORE = """
opsim: 1
name: stock
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}}
stores: {rack: {at: hall, initial: {a: 3, b: 2}}}
products: {a: {route: [s1, rack]}, b: {route: [s1, rack]}, c: {route: [s2], parts: {s2: {a: 1, b: 1}}}}
release: {kind: poisson, every: 60 s, products: [c]}
"""


@pytest.mark.parametrize(("cards", "n"), [
    ("{k: {n: 2, from: s1, to: rack, products: a}}", 3),
    ("{k: {n: 4, from: s1, to: rack}}", 5),
    ("{k: {n: 4}}", 5),
])  # fmt: skip
def test_more_pieces_at_the_start_than_cards_for_them_are_refused(cards, n, tmp_path):
    assert f"{n} pieces lie inside the loop 'k' at the start" in said(cards, tmp_path, STORE)
    read(cards.replace("n: 2", "n: 5").replace("n: 4", "n: 5"), tmp_path, STORE)
    read("{k: {n: 1, to: s2, products: c}}", tmp_path, STORE)
