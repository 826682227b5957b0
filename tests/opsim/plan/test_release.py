"""Sources and loops of cards as numbers."""

import pytest
from plans import plan

from opsim.engine.rules import source_in_turn, stock_wanted
from opsim.plan.sources import SATURATED, SCHEDULE, OrderPlan, SourcePlan, due_of, late_orders, order_of

TEXT = """
opsim: 1
name: plans
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}, s3: {at: hall, tasks: [t]}}
products: {a: {route: [s1, s2, s3, s1]}, b: {routing: {start: s2, s2: {s3: 0.5, out: 0.5}, s3: s2}}}
sources: {w10: {kind: poisson, every: 5 s, products: [a]}, w2: {kind: poisson, every: 5 s, products: {b: 1}}}
"""


def steps(cards):
    return {card.name: (card.steps, card.back) for card in plan(f"{TEXT}cards: {cards}\n").cards}


def test_sources_stand_in_natural_order_with_the_ranks_of_what_they_make():
    assert [(source.name, source.mix) for source in plan(TEXT).sources] == [("w2", ((1, 1.0),)), ("w10", ((0, 1.0),))]


def test_a_card_is_taken_before_the_steps_from_which_a_way_leads_to_where_it_is_given_back():
    assert steps("{c: {n: 1}}") == {"c": (((0,), (0,)), ())}
    assert steps("{c: {n: 1, from: s1, to: s3}}") == {"c": (((0,), ()), (2,))}
    assert steps("{c: {n: 1, from: s1}}") == {"c": (((0, 3), ()), ())}
    assert steps("{c: {n: 1, from: s3, to: s2}}") == {"c": (((), (1,)), (1,))}
    assert steps("{c: {n: 1, to: s3, products: b}}") == {"c": (((), (0,)), (2,))}


def test_what_only_a_split_makes_needs_a_card_at_its_first_station_only_where_a_loop_names_it():
    text = TEXT.replace("{route: [s1, s2, s3, s1]}", "{route: [s1, s2], split: {s2: {b: 2}}}")
    text = text.replace(", w2: {kind: poisson, every: 5 s, products: {b: 1}}", "")
    cards = "{all: {n: 1}, named: {n: 1, products: [b]}, from: {n: 1, from: s2, products: [b]}}"
    steps = {card.name: card.steps for card in plan(f"{text}cards: {cards}\n").cards}
    assert steps == {"all": ((0,), ()), "named": ((), (0,)), "from": ((), (0,))}


ORDERS = (OrderPlan(0.0, 0, 2, 0, 50.0), OrderPlan(5.0, 2, 1, 1), OrderPlan(5.0, 3, 4, 0, 60.0, 2))


@pytest.mark.parametrize(("n", "order"), [(0, 0), (1, 0), (2, 1), (3, 2), (6, 2)])
def test_the_nth_job_belongs_to_the_order_that_counts_it(n, order):
    assert order_of(ORDERS, n) is ORDERS[order]


def test_what_a_schedule_says_of_due_dates_and_of_what_comes_too_late():
    class Planned:
        sources = (
            SourcePlan("x", SATURATED, 0.0, "wait", ((0, 1.0),)),
            SourcePlan("y", SCHEDULE, 0.0, "wait", ((0, 1.0),), orders=ORDERS, n_late=3),
        )

    assert [due_of(Planned, 1, n) for n in (1, 2, 5)] == [50.0, float("inf"), 60.0]
    assert due_of(Planned, 0, 7) == float("inf")
    assert list(late_orders(Planned)) == ["y: 3 of 6 orders come at or after the horizon and are never released"]


def test_rates_are_known_where_the_source_decides():
    saturated, schedule, lots = (
        SourcePlan("x", SATURATED, 0.0, "wait", ()),
        SourcePlan("y", SCHEDULE, 0.0, "wait", (), orders=ORDERS),
        SourcePlan("z", "poisson", 6.0, "wait", (), at_once=3),
    )
    assert [source.job_every_s(70.0) for source in (saturated, schedule, lots)] == [None, 10.0, 2.0]
    assert [source.jobs_per_s(70.0) for source in (saturated, schedule, lots)] == [None, 0.1, 0.5]


def test_of_saturated_sources_the_one_that_made_fewest_is_next():
    assert min([(3, 0), (2, 1), (2, 2)], key=lambda pair: source_in_turn(*pair)) == (2, 1)


@pytest.mark.parametrize(("n_on_floor", "n_waited_for", "level", "wanted"), [
    (4, 0, 4, 0), (3, 0, 4, 1), (4, 2, 4, 2), (6, 2, 4, 0), (7, 0, 4, 0), (0, 1, 0, 1),
])  # fmt: skip
def test_a_stock_wants_what_it_lacks_of_its_level_with_what_is_waited_for(n_on_floor, n_waited_for, level, wanted):
    assert stock_wanted(n_on_floor, n_waited_for, level) == wanted
