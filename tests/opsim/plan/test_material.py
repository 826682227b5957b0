"""Stores, kits, splits, batches and lots as numbers.

Where a job has a card, as it is read from the points it was at.

What belts, vehicles and loads become as numbers.

Sources and loops of cards as numbers.

What rules know of the work ahead: by hand, and by the traffic equations where ways lead back.
"""

from math import inf

import pytest
from plans import CELL, line, plan

from opsim.engine.rules import source_in_turn, stock_wanted
from opsim.subjects.material.figures import has_card
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.release.plan import (
    INSIDE,
    SATURATED,
    SCHEDULE,
    OrderPlan,
    SourcePlan,
    due_of,
    late_orders,
    order_of,
)
from opsim.subjects.sequencing.plan import NO_SETUP, work_ahead

ROUTED = line(3, 1, horizon="1 h").replace("buffer: 1", "buffer: unlimited").replace("saturated", "poisson, every: 5 s")


def visits(way):
    return plan(ROUTED.replace("route: [s1, s2, s3]", way)).products[0].visits()


def test_a_route_visits_each_step_once():
    assert visits("route: [s2, s1, s2, s3]") == (1.0, 1.0, 1.0, 1.0)


@pytest.mark.parametrize("way", ["start: s1, s1: s2, s2: s3, s3: out", "start: s3, s3: s1, s1: s2, s2: out"])
def test_a_sure_routing_is_a_route_whatever_its_order(way):
    assert visits(f"routing: {{{way}}}") == (1.0, 1.0, 1.0)


def test_who_comes_back_is_counted_again():
    way = "routing: {start: s1, s1: s2, s2: {s1: 0.5, s3: 0.25, out: 0.25}, s3: out}"
    assert visits(way) == pytest.approx((2.0, 2.0, 0.5))  # v1 = 1 + v2 / 2, v2 = v1, v3 = v2 / 4


TEXT = """
opsim: 1
name: bikes
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 10 s, automatic: true, per: lot}}
stores: {rims: {at: here, initial: 3}, mixed: {at: here, capacity: 9, initial: {a: 1, b: 2}}}
stations:
  join: {at: here, tasks: [do], buffer: 4, batch: {size: 3, most_wait: 60 s, of: family}}
  saw: {at: here, tasks: [do], servers: 2}
products:
  a: {route: [mixed]}
  b: {routing: {start: saw, saw: {mixed: 0.5, out: 0.5}}}
  rim: {route: [rims]}
  bike: {lot: 5, family: big, route: [join], parts: {join: {rim: 2, a: 1}}}
  log: {lot: 2, family: big, route: [saw], split: {saw: {b: 3, chip: 1}}}
  chip: {lot: 4, route: [join], split: {join: {a: 2}}}
sources:
  logs: {kind: poisson, every: 60 s, products: [log]}
  bikes: {kind: poisson, every: 60 s, products: [bike]}
"""
PLAN = plan(TEXT)
PRODUCTS = [product.name for product in PLAN.products]
STATIONS = [station.name for station in PLAN.stations]
SOURCES = [source.name for source in PLAN.sources]


def test_named_sources_come_first_and_what_they_make_necessary_follows_in_natural_order():
    assert [*("bikes", "logs", "logs > b", "logs > chip", "logs > chip > a", "stock: mixed", "stock: rims")] == SOURCES
    assert {source.kind for source in PLAN.sources[2:]} == {INSIDE}
    mixed = PLAN.sources[SOURCES.index("stock: mixed")]
    assert mixed.mix == ((PRODUCTS.index("a"), 1 / 3), (PRODUCTS.index("b"), 2 / 3))


def test_a_number_alone_is_of_the_product_that_ends_there():
    rims = next(store for store in PLAN.stores if STATIONS[store.station] == "rims")
    assert rims.initial == ((PRODUCTS.index("rim"), 3),) and SOURCES[rims.source] == "stock: rims"


def test_a_store_is_a_point_without_servers():
    store = PLAN.stations[STATIONS.index("mixed")]
    assert (store.kind, store.servers, store.capacity, store.tasks) == ("store", 0, 9, ())
    assert PLAN.stations[STATIONS.index("rims")].capacity == inf


def test_parts_are_in_the_order_of_products():
    (kit,) = PLAN.kits
    assert (PRODUCTS[kit.product], STATIONS[kit.station]) == ("bike", "join")
    assert kit.parts == ((PRODUCTS.index("a"), 1), (PRODUCTS.index("rim"), 2))


def test_pieces_have_sources_of_their_own_by_the_source_of_the_job():
    """A lot of 2 logs is 6 single b, and 2 chips in one lot; 4 chips of a lot are 8 a."""
    found = {
        (PRODUCTS[split.product], SOURCES[of], PRODUCTS[piece], SOURCES[source], most)
        for split in PLAN.splits
        for of, piece, source, most in split.sources
    }
    assert found == {
        ("log", "logs", "b", "logs > b", 6),
        ("log", "logs", "chip", "logs > chip", 1),
        ("chip", "logs > chip", "a", "logs > chip > a", 8),
    }


def test_a_family_is_a_class_and_who_has_none_is_by_himself():
    (batch,) = PLAN.batches
    of = dict(zip(PRODUCTS, batch.class_of))
    assert of["bike"] == of["log"] and len(set(of.values())) == 5
    assert (batch.size, batch.most_wait_s) == (3, 60.0)


def test_a_routing_ends_in_a_store():
    b = PLAN.products[PRODUCTS.index("b")]
    assert [step.name for step in b.route] == ["mixed", "saw"]
    assert b.onward == (((1.0, -1),), ((0.5, 0), (1.0, -1))) and b.visits() == (0.5, 1.0)


def test_lots_and_what_is_done_once_for_them():
    assert [product.lot for product in PLAN.products] == [1, 1, 5, 4, 2, 1] and PLAN.tasks[0].per_lot


def test_so_many_jobs_may_share_a_server():
    """Three of a batch, each of which may become 8 pieces; 7 pieces of a log on the saw."""
    assert [jobs_on_a_server(PLAN, STATIONS.index(name)) for name in ("join", "saw", "rims")] == [24, 7, 1]


FLOOR = """
opsim: 1
name: ways
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {a: {at: hall, tasks: [t]}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [END]}, d: {at: hall, tasks: [t]}}
products: {p: {route: [a, b, c, d]}}
cards: {loop: {n: 1, from: b, to: c}}
release: {kind: poisson, every: 5 s}
"""
A, B, C, D = range(4)


@pytest.mark.parametrize(
    "end, points, has",
    [
        ("t", [A, B, B, C, D], [0, 1, 1, 1, 0]),
        ("t", [A, B, A, B, C, D], [0, 1, 1, 1, 1, 0]),  # sent back from within the loop
        ("", [A, B, D], [0, 1, 0]),  # c was passed between
        ("", [A, B, A, B, D], [0, 1, 0, 1, 0]),
    ],
)
def test_a_card_is_had_from_where_the_loop_begins_until_its_end_is_left_or_passed(end, points, has):
    p = plan(FLOOR.replace("END", end))
    assert has_card(p.cards[0], 0, p, points) == [bool(one) for one in has]


TRANSPORT_TEXT = """
opsim: 1
name: moves
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 4 m], c: [20 m, 0 m], dock: [0 m, 20 m]}}
tasks: {t: {fixed: 5 s, automatic: true}}
stations: {one: {at: a, tasks: [t], buffer: 1}, two: {at: c, tasks: [t], buffer: 1}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
transporters: {truck: {at: dock, speed: 2 m/s, legs: [[belt, two], [one, two]]}}
products: {x: {route: [one, belt, two], mass: 500 g}, y: {share: 1, route: [one, two]}}
release: {kind: saturated}
workers: {w: {most_load: 12 kg, home: a}}
""".replace("x: {route", "x: {share: 0.5, route").replace("share: 1,", "share: 0.5,")


def test_a_belt_is_the_straight_line_between_its_ends_and_stands_among_the_stations():
    p = plan(TRANSPORT_TEXT)
    (belt,) = p.conveyors
    assert (p.stations[belt.station].name, p.stations[belt.station].kind) == ("belt", "conveyor")
    assert (belt.travel_s, belt.headway_s, p.places[belt.place_to]) == (10.0, 2.0, "b")


@pytest.mark.parametrize(
    ("length", "pitch", "capacity"), [("5 m", "1 m", 5), ("5 m", "0.9 m", 6), ("0.3 m", "0.1 m", 3), ("1 m", "1 m", 1)]
)
def test_a_belt_holds_its_length_over_its_pitch_rounded_up(length, pitch, capacity):
    p = plan(TRANSPORT_TEXT.replace("pitch: 1 m", f"pitch: {pitch}, length: {length}"))
    assert p.conveyors[0].capacity == p.stations[p.conveyors[0].station].capacity == capacity


def test_a_leg_from_a_belt_begins_where_jobs_get_off():
    p = plan(TRANSPORT_TEXT)
    names = [station.name for station in p.stations]
    legs = {(names[leg.before], names[leg.after]): leg for leg in p.transporters[0].legs}
    assert p.places[legs["belt", "two"].place_from] == "b" and p.places[legs["belt", "two"].place_to] == "c"
    assert p.places[legs["one", "two"].place_from] == "a"


def test_vehicles_drive_as_people_walk_or_along_roads_of_their_own():
    p = plan(TRANSPORT_TEXT)
    a, b, c, dock = (p.places.index(name) for name in ("a", "b", "c", "dock"))
    assert p.transporters[0].drive_s(dock, c) == 20.0
    own = plan(TRANSPORT_TEXT.replace("legs:", "roads: [[dock, a, b], {from: a, to: c, length: 60 m}], legs:"))
    assert own.transporters[0].drive_s(dock, c) == 40.0 and own.transporters[0].drive_s(dock, b) == 12.5
    assert own.distance_m == p.distance_m and own.transporters[0].drive_s(c, a) == 30.0


def test_loads_and_masses_stand_with_workers_and_products():
    p = plan(TRANSPORT_TEXT)
    assert p.workers[0].most_load_kg == 12.0
    assert [product.mass_kg for product in p.products] == [0.5, None]


def test_without_belts_and_vehicles_a_plan_has_none():
    text = "\n".join(line for line in TRANSPORT_TEXT.splitlines() if not line.startswith(("conveyors", "transporters")))
    p = plan(text.replace("[one, belt, two]", "[one, two]"))
    assert p.conveyors == p.transporters == ()


RELEASE_TEXT = """
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
    return {card.name: (card.steps, card.back) for card in plan(f"{RELEASE_TEXT}cards: {cards}\n").cards}


def test_sources_stand_in_natural_order_with_the_ranks_of_what_they_make():
    assert [(source.name, source.mix) for source in plan(RELEASE_TEXT).sources] == [
        ("w2", ((1, 1.0),)),
        ("w10", ((0, 1.0),)),
    ]


def test_a_card_is_taken_before_the_steps_from_which_a_way_leads_to_where_it_is_given_back():
    assert steps("{c: {n: 1}}") == {"c": (((0,), (0,)), ())}
    assert steps("{c: {n: 1, from: s1, to: s3}}") == {"c": (((0,), ()), (2,))}
    assert steps("{c: {n: 1, from: s1}}") == {"c": (((0, 3), ()), ())}
    assert steps("{c: {n: 1, from: s3, to: s2}}") == {"c": (((), (1,)), (1,))}
    assert steps("{c: {n: 1, to: s3, products: b}}") == {"c": (((), (0,)), (2,))}


def test_what_only_a_split_makes_needs_a_card_at_its_first_station_only_where_a_loop_names_it():
    text = RELEASE_TEXT.replace("{route: [s1, s2, s3, s1]}", "{route: [s1, s2], split: {s2: {b: 2}}}")
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


HEAD = """
opsim: 1
name: shop
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 10 s, automatic: true}, drill: {fixed: 4 s, automatic: true, per: lot}}
release: {kind: poisson, every: 60 s}
"""
SEQUENCE_STATIONS = (
    "stations: {s1: {at: hall, tasks: [cut]}, s2: {at: hall, tasks: [drill]}, s3: {at: hall, tasks: [cut, drill]}}\n"
)


def ahead_of(product):
    made = plan(HEAD + SEQUENCE_STATIONS + f"products: {{a: {product}}}\nflow: {{dispatch: spt}}\n")
    return made.ahead


def test_work_of_a_route_is_summed_up_from_its_end():
    ahead = ahead_of("{route: [s1, [s2, s3], s3]}")
    assert ahead.at_s == ((10, 4, 14),)
    assert ahead.work_s == ((10, 9, 14),) and ahead.left_s == ((33, 23, 14),) and ahead.left_steps == ((3, 2, 1),)


def test_a_lot_takes_its_units_except_for_what_is_done_once():
    assert ahead_of("{route: [s1, s2, s3], lot: 5}").at_s == ((50, 4, 54),)


def test_a_batch_station_does_each_task_once_for_a_lot():
    text = HEAD + SEQUENCE_STATIONS.replace("tasks: [cut]}", "tasks: [cut], batch: {size: 2}}", 1)
    assert plan(text + "products: {a: {route: [s1, s2, s3], lot: 5}}\nflow: {dispatch: spt}\n").ahead.at_s == (
        (10, 4, 54),
    )


def test_ways_that_lead_back_are_passed_as_often_as_the_traffic_equations_say():
    """s1 until it is good, with probability 1/4 again: 4/3 visits; then s2."""
    ahead = ahead_of("{routing: {start: s1, s1: {s1: 1/4, s2: 3/4}, s2: out}}")
    assert ahead.left_steps[0] == pytest.approx((4 / 3 + 1, 1))
    assert ahead.left_s[0] == pytest.approx((40 / 3 + 4, 4))


def test_ways_that_branch_forward_only_are_weighed():
    ahead = ahead_of("{routing: {start: s1, s1: {s2: 0.5, out: 0.5}, s2: s3, s3: out}}")
    assert ahead.left_steps[0] == pytest.approx((2.0, 2.0, 1.0))


def test_nobody_looks_ahead_where_no_rule_asks():
    made = plan(CELL)
    assert made.ahead is None and made.queues == () and made.setups == ()
    assert work_ahead(made.stations, made.products, made.tasks).at_s[0][0] == 40 + 30 + 10  # the first is repack1


def test_setups_know_the_products_that_come_and_what_they_change_to():
    text = """
stations:
  s1: {at: hall, tasks: [cut], setup: {times: {a: {b: 90 s}}, otherwise: drill, attended: false}}
  s2: {at: hall, tasks: [cut]}
products: {a: {share: .25, route: [s1]}, b: {share: .5, route: [s1]}, c: {share: .25, route: [s2]}}
"""
    made = plan(HEAD + text)
    (setup,) = made.setups
    names = [task.name for task in made.tasks]
    assert setup.class_of == (0, 1, -1)
    assert setup.task == ((NO_SETUP, names.index("setup: 90 s")), (names.index("drill"), NO_SETUP))
    assert setup.mean_s == ((0, 90), (4, 0)) and setup.needed(0, 1) == (names.index("setup: 90 s"), 90)
