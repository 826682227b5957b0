"""What rules know of the work ahead: by hand, and by the traffic equations where ways lead back."""

import pytest
from plans import CELL, plan

from opsim.plan.sequence import work_ahead
from opsim.plan.tasks import NO_SETUP

HEAD = """
opsim: 1
name: shop
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 10 s, automatic: true}, drill: {fixed: 4 s, automatic: true, per: lot}}
release: {kind: poisson, every: 60 s}
"""
STATIONS = (
    "stations: {s1: {at: hall, tasks: [cut]}, s2: {at: hall, tasks: [drill]}, s3: {at: hall, tasks: [cut, drill]}}\n"
)


def ahead_of(product):
    made = plan(HEAD + STATIONS + f"products: {{a: {product}}}\nflow: {{dispatch: spt}}\n")
    return made.ahead


def test_work_of_a_route_is_summed_up_from_its_end():
    ahead = ahead_of("{route: [s1, [s2, s3], s3]}")
    assert ahead.at_s == ((10, 4, 14),)
    assert ahead.work_s == ((10, 9, 14),) and ahead.left_s == ((33, 23, 14),) and ahead.left_steps == ((3, 2, 1),)


def test_a_lot_takes_its_units_except_for_what_is_done_once():
    assert ahead_of("{route: [s1, s2, s3], lot: 5}").at_s == ((50, 4, 54),)


def test_a_batch_station_does_each_task_once_for_a_lot():
    text = HEAD + STATIONS.replace("tasks: [cut]}", "tasks: [cut], batch: {size: 2}}", 1)
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
