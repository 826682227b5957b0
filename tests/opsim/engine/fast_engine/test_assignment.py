"""Zones, floaters, priorities, the way ahead and stops of one operation: the pairs that SimPy's engine finds."""

import pytest
from twins import twins

from opsim.log import WALK, WORK

SHOP = """
opsim: 1
name: assignment
run: {horizon: 900 s, seed: 5}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]}}
tasks: {cut: {fixed: 6 s}, weld: {fixed: 9 s}}
defaults: {stations: {servers: 2, buffer: 9}}
stations: {a: {at: p, tasks: [cut]}, b: {at: q, tasks: [weld]}, c: {at: r, tasks: [cut]}}
products: {x: {share: 0.5, route: [a, b, c]}, y: {share: 0.5, priority: 1, route: [c, a]}}
release: {kind: renewal, every: {fixed: 6 s}, at_once: 1}
workers:
  w1: {walk: 1 m/s, skills: {a: 1.0, b: 1.0, c: 1.0}}
  w2: {walk: 1 m/s, skills: {a: 1.0, b: 0.5, c: 1.0}}
  w3: {walk: 1 m/s, skills: {a: 0.5, b: 1.0, c: 1.0}}
allocation: {rule: oldest_job}
"""
PRIOR = "cut", "weld"
"""Tasks of the stations that have a priority."""


def served(log):
    """Where who works, in turn."""
    rows = log.of(WORK)
    return list(zip(rows["worker"].tolist(), rows["station"].tolist(), rows["start_s"].tolist()))


def test_zones_and_floaters_come_before_the_rule():
    plain = twins(SHOP)
    zones = (
        ("w1: {", "w1: {zone: [b], "),
        ("w2: {", "w2: {zone: [a], floater: true, "),
        ("w3: {", "w3: {floater: true, "),
    )
    assert served(twins(SHOP, *zones)) != served(plain)


@pytest.mark.parametrize("first", ["", "stations", "products", "products, stations", "stations, products"])
def test_priorities_count_in_the_order_that_is_said(first):
    edits = [("rule: oldest_job", f"rule: oldest_job, priorities: [{first}]")]
    edits += [(f"tasks: [{task}]}}, ", f"tasks: [{task}], priority: 1}}, ") for task in PRIOR if "stations" in first]
    assert (served(twins(SHOP, *edits)) == served(twins(SHOP))) == (not first)


@pytest.mark.parametrize("rule", ["most_downstream", "best_skill", "nearest", "longest_queue"])
def test_rules_choose_the_same_pairs(rule):
    assert served(twins(SHOP, ("oldest_job", rule))) != served(twins(SHOP))


@pytest.mark.parametrize("serve", ["one", "exhaustive"])
@pytest.mark.parametrize(
    "places", ["p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]", "p: [0 m, 0 m], q: [0 m, 0 m], r: [1 m, 0 m]"]
)
def test_who_patrols_serves_the_same_stops(serve, places):
    rounds = [(f"{w}: {{walk", f"{w}: {{patrol: [a, b, c], walk") for w in ("w1", "w2", "w3")]
    at = ("p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]", places)
    log = twins(SHOP, *rounds, at, ("rule: oldest_job", f"rule: oldest_job, idle: patrol, serve: {serve}"))
    assert len(log.of(WALK)) > 20
