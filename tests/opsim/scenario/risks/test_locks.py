"""Rings over rooms, tools, cards and parts: those that can close are told with their reasons, others are not."""

from pathlib import Path

import pytest

from opsim.plan.warnings import risks_of
from opsim.scenario.read import scenarios_in

BASE = """
opsim: 1
name: Lock
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 3 s, automatic: true}}
stations:
  cut: {at: here, tasks: [do], buffer: 2}
  drill: {at: here, tasks: [do], buffer: 2}
products: {part: {route: [cut, drill]}}
release: {kind: poisson, every: 9 s}
"""
TOOLS = [
    ("release:", "tools: {fixture: {n: 2}}\nrelease:"),
    ("tasks: [do], buffer: 2}", "tasks: [do], buffer: 2, needs: {fixture: 1}}"),
]
KIT = """
opsim: 1
name: Kit
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 3 s, automatic: true}}
stations:
  prep: {at: here, tasks: [do], buffer: 2}
  fit: {at: here, tasks: [do], buffer: 2}
stores: {rack: {at: here, capacity: 4}, shelf: {at: here, capacity: 4}}
products:
  bike: {route: [fit], parts: {fit: {wheel: 2, frame: 1}}}
  wheel: {route: [prep, rack]}
  frame: {route: [prep, shelf]}
sources:
  calls: {kind: poisson, every: 9 s, products: [bike]}
  parts: {kind: poisson, every: 3 s, products: {wheel: 2/3, frame: 1/3}}
"""


def risks(text, *edits):
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return risks_of(scenarios_in(text.encode(), Path("lock.yaml"))["base"].scenario)


def test_a_fixture_held_at_two_stations_in_a_row_may_lock():
    (risk,) = risks(BASE, *TOOLS)
    assert risk == (
        "jobs may wait for each other for ever: fixture is held at cut, cut waits for room at drill, "
        "drill waits for fixture; more tools helps, or 'buffer: unlimited' at drill"
    )


@pytest.mark.parametrize(
    "edit",
    [("drill: {at: here, tasks: [do], buffer: 2,", "drill: {at: here, tasks: [do],"), ("[cut, drill]", "[cut]")],
    ids=["room", "one station"],
)
def test_a_fixture_is_no_risk_where_its_holder_can_always_move_on(edit):
    assert not [risk for risk in risks(BASE, *TOOLS, edit) if "for ever" in risk]


def test_cards_on_a_line_never_lock():
    cards = "cards: {all: {n: 2}, ahead: {n: 1, from: cut, to: drill}, last: {n: 1, from: drill}}\nrelease:"
    assert risks(BASE, ("release:", cards)) == []


def test_cards_of_two_loops_that_products_enter_from_either_side_may_lock():
    crossing = "products: {part: {share: 0.5, route: [cut, drill]}, back: {share: 0.5, route: [drill, cut]}}"
    cards = "cards: {left: {n: 1, from: cut, to: cut}, right: {n: 1, from: drill, to: drill}}\nrelease:"
    edits = [
        ("products: {part: {route: [cut, drill]}}", crossing),
        ("release:", cards),
        ("buffer: 2", "buffer: unlimited"),
    ]
    (risk,) = risks(BASE, *edits)
    assert risk.startswith(
        "jobs may wait for each other for ever: cards of left are at cut, cut waits for a card of right"
    )
    assert "more cards helps" in risk


def test_a_full_store_of_one_part_may_keep_the_other_part_back():
    (risk,) = risks(KIT)
    assert risk == (
        "jobs may wait for each other for ever: frame comes by prep, prep waits for room at rack, rack is full, wheel "
        "waits for fit to take it, fit waits for frame (1 more ring like it); more stock of parts helps, or "
        "'buffer: unlimited' at fit"
    )


def test_a_store_of_a_single_part_is_never_full_while_that_part_is_waited_for():
    edits = [
        ("{wheel: 2, frame: 1}", "{wheel: 2}"),
        ("frame: {route: [prep, shelf]}", "frame: {route: [fit]}"),
        (", shelf: {at: here, capacity: 4}", ""),
    ]
    assert not [risk for risk in risks(KIT, *edits) if "for ever" in risk]


@pytest.mark.parametrize("capacity", ["rack: {at: here, capacity: 4}", "shelf: {at: here, capacity: 4}"])
def test_parts_with_a_way_of_their_own_never_lock(capacity):
    assert (
        risks(
            KIT,
            ("wheel: {route: [prep", "wheel: {route: [press"),
            ("  fit:", "  press: {at: here, tasks: [do]}\n  fit:"),
        )
        == []
    )


def test_an_assembly_that_shares_a_station_with_its_parts_may_lock():
    edits = [("bike: {route: [fit]", "bike: {route: [prep, fit]"), (", capacity: 4", "")]
    assert any("fit waits for" in risk and "prep waits for room at fit" in risk for risk in risks(KIT, *edits))


def test_places_kept_before_work_begins_are_named_where_jobs_go_round():
    again = ("route: [cut, drill]", "routing: {start: cut, cut: drill, drill: {cut: 0.1, out: 0.9}}")
    first, *_ = risks(BASE, again, ("release:", "flow: {blocking: before}\nrelease:"))
    assert "cut and drill send jobs round" in first and "a place is kept before they begin" in first


KANBAN = ("sources:", "cards: {loop: {n: 2, from: prep, to: rack, products: [wheel]}}\nsources:")
ONE_STORE = (
    ("frame: {route: [prep, shelf]}", "frame: {route: [prep, rack]}"),
    (", shelf: {at: here, capacity: 4}", ""),
)


def test_a_kanban_card_on_a_piece_in_store_is_no_risk_while_one_piece_is_enough():
    own = ("wheel: {route: [prep", "wheel: {route: [press"), ("  fit:", "  press: {at: here, tasks: [do]}\n  fit:")
    kanban = ("from: prep", "from: press")
    assert risks(KIT, *own, KANBAN, kanban) == []
    (risk,) = risks(KIT, *own, KANBAN, kanban, ("n: 2, from", "n: 1, from"))
    assert "cards of loop are at rack" in risk and "fit waits for wheel, wheel waits for a card of loop" in risk


def test_a_store_of_two_parts_may_be_full_of_the_wrong_one():
    said = risks(KIT, *ONE_STORE)
    assert any("rack is full, wheel waits for fit to take it, fit waits for frame" in risk for risk in said)


def test_a_saturated_source_that_makes_its_parts_in_turn_may_keep_the_wanted_one_back():
    in_turn = (
        "kind: poisson, every: 3 s, products: {wheel: 2/3, frame: 1/3}",
        "kind: saturated, products: [wheel, frame]",
    )
    cards = "{w: {n: 2, from: prep, to: rack, products: wheel}, f: {n: 2, from: prep, to: rack, products: frame}}"
    edits = [*ONE_STORE, in_turn, ("capacity: 4", "capacity: 9"), ("sources:", f"cards: {cards}\nsources:")]
    (risk,) = risks(KIT, *edits)
    assert "fit waits for wheel, wheel comes after frame from parts" in risk
    each = (
        "  parts: {kind: saturated, products: [wheel, frame]}",
        "  a: {kind: saturated, products: [wheel]}\n  b: {kind: saturated, products: [frame]}",
    )
    assert risks(KIT, *edits, each) == []


@pytest.mark.parametrize(("pieces", "locks"), [(1, False), (2, True), (3, False)])
def test_a_lot_that_is_begun_keeps_its_only_card(pieces, locks):
    """Of a lot of 3, 1 is left when a job took 2: the next job waits for another, which has no card."""
    text = BASE.replace("products: {part: {route: [cut, drill]}}", "stores: {bin: {at: here}}\nproducts:")
    made = "  bolt: {share: 0.5, lot: 3, route: [cut, bin]}\n  part: {share: 0.5, route: [drill], PARTS}\n"
    text = text.replace("release:", made + "release:")
    text = text.replace("PARTS", f"parts: {{drill: {{bolt: {pieces}}}}}")
    text += "cards: {loop: {n: 1, from: cut, to: bin, products: [bolt]}}\n"
    assert any("bolt waits for a card of loop" in risk for risk in risks(text)) == locks
    full = text.replace("bin: {at: here}", "bin: {at: here, capacity: 1}").replace("cards: {loop", "#")
    assert any("bin is full" in risk for risk in risks(full)) == locks
