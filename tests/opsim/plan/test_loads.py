"""Loads by hand arithmetic: lots, rework, scrap, set-ups, breakdowns, parts, people, tools, transporters, cards."""

import pytest
from plans import plan

from opsim.plan.loads import bottleneck, crew_load, overloads, shared_loads, skill_loads, station_loads
from opsim.plan.loads.flows import visits_of
from opsim.plan.loads.work_sharing import best_share

BASE = """
opsim: 1
name: Loads
run: {horizon: 8 h}
layout: {places: {here: [0 m, 0 m], there: [60 m, 0 m]}}
tasks: {do: {fixed: 36 s, automatic: true}, hand: {fixed: 18 s}}
stations:
  cut: {at: here, tasks: [do]}
  drill: {at: there, tasks: [do]}
products: {a: {share: 0.5, route: [cut, drill]}, b: {share: 0.5, route: [cut, drill]}}
release: {kind: poisson, every: 72 s}
"""


def edited(*edits):
    text = BASE
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return plan(text)


def at(name, *edits):
    return next(load for load in station_loads(edited(*edits)) if load.station == name)


def test_a_plain_line_has_half_a_load():
    load = at("cut")
    assert (load.work_s, load.visits, load.arrivals_per_h, load.load, load.most_per_h) == (36, 1, 50, 0.5, 100)


def test_a_lot_takes_its_units_and_a_task_per_lot_only_once():
    assert at("cut", ("{a: {share", "{a: {lot: 3, share")).work_s == (3 * 36 + 36) / 2
    edits = (("{a: {share", "{a: {lot: 3, share"), ("automatic: true}", "automatic: true, per: lot}"))
    assert at("cut", *edits).work_s == 36


def test_a_batch_shares_its_time():
    assert at("cut", ("cut: {at: here, tasks: [do]", "cut: {at: here, tasks: [do], batch: {size: 4}")).work_s == 9


def test_scrap_thins_out_what_comes_after():
    edits = [("cut: {at: here, tasks: [do]", "cut: {at: here, tasks: [do], scrap: 0.2")]
    assert at("cut", *edits).visits == 1
    assert at("drill", *edits).visits == pytest.approx(0.8)


def test_rework_without_end_comes_back_by_the_geometric_law():
    edits = [
        ("cut: {at: here, tasks: [do]", "cut: {at: here, tasks: [do], yield: 0.8"),
        ("drill: {at: there, tasks: [do]", "drill: {at: there, tasks: [do], inspect: {then: {rework: cut}}"),
    ]
    assert at("cut", *edits).visits == pytest.approx(1 / 0.8)
    assert at("drill", *edits).visits == pytest.approx(1 / 0.8)


def test_rework_that_ends_and_false_alarms_are_counted():
    inspect = "inspect: {finds: 0.5, false_alarms: 0.1, most: 1, then: {rework: cut}}"
    edits = [
        ("cut: {at: here, tasks: [do]", "cut: {at: here, tasks: [do], yield: 0.8"),
        ("drill: {at: there, tasks: [do]", f"drill: {{at: there, tasks: [do], {inspect}"),
    ]
    sent_back = 0.2 * 0.5 + 0.8 * 0.1
    assert visits_of(edited(*edits), 0) == pytest.approx((1 + sent_back, 1 + sent_back))


def test_set_ups_are_those_of_an_order_drawn_at_random():
    setup = "setup: {times: {a: {b: 40 s}}, otherwise: 20 s, attended: false}"
    load = at("cut", ("cut: {at: here, tasks: [do]", f"cut: {{at: here, tasks: [do], {setup}"))
    assert load.setup_s == pytest.approx(0.25 * 40 + 0.25 * 20)
    assert load.most_per_h == pytest.approx(3600 / 51)


def test_a_sequence_says_which_set_ups_come():
    setup = "setup: {times: {a: {b: 40 s}}, otherwise: 20 s, attended: false}"
    edits = [
        ("cut: {at: here, tasks: [do]", f"cut: {{at: here, tasks: [do], {setup}"),
        ("every: 72 s", "every: 72 s, sequence: [a, a, a, b]"),
    ]
    assert at("cut", *edits).setup_s == pytest.approx((40 + 20) / 4)


@pytest.mark.parametrize(
    ("stop", "up"),
    [
        ("every: {dist: exponential, mean: 50 min}, repair: {fixed: 10 min}", 5 / 6),
        ("every: {dist: exponential, mean: 50 min}, by: busy, repair: {fixed: 10 min}", 5 / 6),
        ("every: 100, by: cycles, repair: {fixed: 30 min}", 1 / 1.5),
    ],
)
def test_breakdowns_take_their_share_of_the_time(stop, up):
    stops = f"breakdowns: {{jam: {{{stop}}}}}"
    load = at("cut", ("cut: {at: here, tasks: [do]", f"cut: {{at: here, tasks: [do], {stops}"))
    assert load.up == pytest.approx(up) and load.most_per_h == pytest.approx(100 * up)


def test_maintenance_takes_its_share_of_the_time():
    oil = "maintenance: {oil: {every: 2 h, lasts: 30 min}}"
    assert at("cut", ("cut: {at: here, tasks: [do]", f"cut: {{at: here, tasks: [do], {oil}")).up == 0.75


def test_parts_come_as_fast_as_they_are_used():
    edits = [
        ("stations:", "stores: {rack: {at: here, capacity: 9}}\nstations:"),
        ("release: {kind: poisson, every: 72 s}", ""),
        ("a: {share: 0.5, route: [cut, drill]}", "a: {lot: 2, route: [cut, rack]}"),
        ("b: {share: 0.5, route: [cut, drill]}", "b: {route: [drill], parts: {drill: {a: 3}}}"),
    ]
    calls = "{kind: poisson, every: 72 s, products: [b]}"
    sources = f"sources: {{calls: {calls}, refill: {{kind: base_stock, store: rack, level: 4}}}}"
    p = edited(*edits, ("opsim: 1", f"opsim: 1\n{sources}"))
    loads = {load.station: load for load in station_loads(p)}
    assert loads["drill"].arrivals_per_h == 50
    assert loads["cut"].arrivals_per_h == pytest.approx(50 * 3 / 2)


def test_what_is_split_off_comes_on():
    edits = [
        ("a: {share: 0.5, route: [cut, drill]}", "a: {share: 1, route: [cut], split: {cut: {b: 3}}}"),
        ("b: {share: 0.5, route: [cut, drill]}", "b: {route: [drill]}"),
        ("release: {kind: poisson, every: 72 s}", "sources: {s: {kind: poisson, every: 72 s, products: [a]}}"),
    ]
    assert at("drill", *edits).arrivals_per_h == pytest.approx(150)


PEOPLE = [
    ("tasks: [do]", "tasks: [do, hand]"),
    ("release:", "workers: {ana: {skills: {cut: 1, drill: 1}}, ben: {skills: {cut: 1}}}\nrelease:"),
]


def test_skills_and_the_people_together():
    p = edited(*PEOPLE)
    cut, drill = skill_loads(p)
    assert (cut.skill, cut.able, cut.work_s, cut.wanted, cut.load) == ("cut", 2, 18, 0.25, 0.125)
    assert (drill.able, drill.load) == (1, 0.25)
    crew = crew_load(p)
    assert crew.share == pytest.approx(0.25) and set(crew.workers) == {"ana", "ben"}


def test_a_team_wants_everybody_of_it_and_an_attended_machine_its_worker():
    edits = [
        *PEOPLE,
        ("hand: {fixed: 18 s}", "hand: {fixed: 18 s, team: 2}"),
        (" drill: 1}", " drill: 1}}, cai: {skills: {drill: 1}"),
    ]
    assert skill_loads(edited(*edits))[0].work_s == 36
    assert skill_loads(edited(*PEOPLE, ("automatic: true", "automatic: attended")))[0].work_s == 54


def test_work_is_shared_as_well_as_it_can_be():
    assert best_share({0: 1.0, 1: 0.2}, {0: {0: 1.0}, 1: {0: 1.0, 1: 1.0}}) == (1.0, (0,))
    ring = {kind: {kind: 1.0, (kind + 1) % 3: 1.0} for kind in range(3)}
    share, kinds = best_share({0: 1.0, 1: 1.0, 2: 1.0}, ring)
    assert share == pytest.approx(1) and kinds == (0, 1, 2)


@pytest.mark.parametrize("alike", [True, False], ids=["each as fast in all he does", "faster in some work"])
def test_no_way_of_sharing_work_asks_for_less(alike):
    import numpy as np

    rng = np.random.default_rng(5)
    for _ in range(20):
        n_kinds, n_people = rng.integers(1, 6, 2)
        able = {k: sorted(rng.choice(n_people, rng.integers(1, n_people + 1), replace=False)) for k in range(n_kinds)}
        work = {k: float(rng.random()) for k in range(n_kinds)}
        speed, own = rng.uniform(0.5, 2, n_people), rng.uniform(0.5, 2, (n_kinds, n_people))
        seconds = {k: {p: 1 / (speed[p] if alike else own[k, p]) for p in able[k]} for k in able}
        assert best_share(work, seconds)[0] == pytest.approx(naive_share(work, seconds, n_people), abs=1e-7)


def naive_share(work, seconds, n_people):
    """The linear programme as it stands in a textbook."""
    from scipy.optimize import linprog

    pairs = [(k, person) for k in seconds for person in seconds[k]]
    done = [[float(k == kind) for k, _ in pairs] + [0.0] for kind in seconds]
    spent = [[(p == person) * seconds[k][p] for k, p in pairs] + [-1.0] for person in range(n_people)]
    return linprog([0.0] * len(pairs) + [1.0], spent, [0.0] * n_people, done, list(work.values())).fun


def test_tools_transporters_cards_and_repair_teams():
    jam = "{every: {fixed: 3 h}, repair: {fixed: 1 h}, team: crew}"
    cart = "at: here, speed: 2 m/s, load: 3 s, unload: 3 s"
    edits = [
        ("release:", "tools: {jig: {n: 2}}\ncards: {loop: {n: 4}}\nrepair_teams: {crew: {n: 1}}\nrelease:"),
        ("cut: {at: here, tasks: [do]", "cut: {at: here, tasks: [do], needs: {jig: 1}"),
        (
            "drill: {at: there, tasks: [do]",
            f"drill: {{at: there, tasks: [do], breakdowns: {{jam: {jam}}}",
        ),
        (
            "products:",
            f"transporters: {{cart: {{{cart}, legs: [[cut, drill]]}}}}\nproducts:",
        ),
    ]
    jig, crew, cart, loop = shared_loads(edited(*edits))
    assert (jig.name, jig.load) == ("jig", pytest.approx(50 * 36 / 3600 / 2))
    assert (crew.name, crew.load) == ("crew", pytest.approx(0.25))
    assert (cart.name, cart.load) == ("cart", pytest.approx(50 * (30 + 6) / 3600))
    assert (loop.name, loop.load) == ("loop", pytest.approx(50 * 72 / 3600 / 4))


def test_the_bottleneck_is_what_the_most_is_wanted_of():
    first, second = bottleneck(edited(("drill: {at: there, tasks: [do]", "drill: {at: there, tasks: [do, do]")))
    assert (first.what, first.load, first.most_per_h) == ("drill", 1.0, 50)
    assert (second.what, second.most_per_h) == ("cut", 100)


def test_where_the_floor_decides_the_bottleneck_says_how_many_jobs_pass():
    saturated = ("{kind: poisson, every: 72 s}", "{kind: saturated}")
    room = ("cut: {at: here, tasks: [do]", "cut: {at: here, buffer: 1, tasks: [do]")
    first, *_ = bottleneck(edited(saturated, room, ("drill: {at: there", "drill: {servers: 2, at: there")))
    assert (first.what, first.load, first.most_per_h) == ("cut", None, 100)


def test_what_cannot_be_done_is_said():
    edits = [*PEOPLE, ("every: 72 s", "every: 12 s")]
    assert overloads(edited(*edits)) == [
        "cut cannot keep up: it would need 450% of its time",
        "drill cannot keep up: it would need 450% of its time",
        "work at drill cannot be done: 150% of the time of the 1 worker who can, walks not counted",
    ]


def test_people_who_cannot_share_all_their_work_are_said():
    edits = [*PEOPLE, ("every: 72 s", "every: 16 s"), ("ben: {skills: {cut: 1}}", "ben: {skills: {cut: 1, drill: 1}}")]
    edits += [("cut: {at: here", "cut: {servers: 9, at: here"), ("drill: {at: there", "drill: {servers: 9, at: there")]
    (said,) = overloads(edited(*edits))
    assert said.startswith(
        "the 2 workers of 2 stations cannot keep up: shared as evenly as can be, it takes 112% of their time"
    )


def test_products_that_are_always_late_or_never_done_are_said():
    assert overloads(edited(("a: {share", "a: {due: 70 s, share"))) == [
        "a is late: due after 70 s, and its work alone takes 72 s"
    ]
    assert "no a is finished: its work takes 72 s, the run 60 s" in overloads(edited(("8 h", "60 s")))
