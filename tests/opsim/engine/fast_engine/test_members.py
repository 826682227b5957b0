"""Who is chosen for a team: by the rule, in natural order; nobody where too few are free."""

from twins import twins

from opsim.log import WORK

MANY = """
opsim: 1
name: members
run: {horizon: 600 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {carry: {fixed: 10 s, team: 3, per: lot, repeat: 2}, sort: {fixed: 7 s, team: 2}}
stations: {s: {at: a, tasks: [carry], servers: 2, buffer: 3}, t: {at: b, tasks: [sort], servers: 2, buffer: 3}}
products: {x: {share: 0.5, lot: 3, route: [s, t]}, y: {share: 0.5, route: [t, s]}}
release: {kind: renewal, every: {fixed: 25 s}}
workers: {WORKERS}
allocation: {rule: best_skill, priorities: [stations]}
"""


def team_rows(n, *edits):
    workers = ", ".join(
        f"m{i}: {{walk: 1 m/s, home: {'ab'[i % 2]}, skills: {{s: {1 - i / 20}, t: {0.5 + i / 20}}}}}" for i in range(n)
    )
    log = twins(MANY.replace("WORKERS", workers), *edits)
    return log.where((log["kind"] == WORK) & (log["job"] < 0))


def test_of_many_the_best_are_chosen():
    assert len(set(team_rows(7)["worker"].tolist())) == 7


def test_whoever_is_there_is_chosen_where_just_enough_are():
    assert len(team_rows(3)) > 30


def test_zones_and_floaters_choose_members_too():
    floats = ("m0: {", "m0: {floater: true, "), ("m1: {", "m1: {zone: [t], ")
    assert team_rows(5, *floats)["worker"].tolist() != team_rows(5)["worker"].tolist()
