"""Stops of stations as a Plan has them: natural order, a task each, models of what counts and of what is done."""

from plans import plan

from opsim.plan.resources import NO_TEAM
from opsim.tasks import Exponential, Fixed, Geometric
from opsim.tasks.model import UniformCount

SHOP = """
opsim: 1
name: shop
run: {horizon: 8 h, variability: none}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations:
  p10:
    at: hall
    tasks: [press]
    breakdowns: {wear: {every: {dist: uniform, low: 4, high: 9}, by: cycles, repair: {dist: exponential, mean: 1 min}}}
    maintenance: {oil: {every: 4 h, lasts: 9 min, team: b}}
  p2:
    at: hall
    tasks: [press]
    breakdowns:
      jam10: {every: {dist: geometric, mean: 50}, by: cycles, repair: {fixed: 1 min}, team: a10, job: scrap}
      jam9: {every: {dist: exponential, mean: 4 h}, by: busy, repair: {fixed: 2 min}, team: a9}
    maintenance: {clean: {every: 4 h, first: 1 h, lasts: {fixed: 7 min}, when: at_once}}
products: {part: {route: [p2, p10]}}
release: {kind: poisson, every: 1 min}
repair_teams: {b: {n: 3}, a10: {}, a9: {}}
"""
PLAN = plan(SHOP)


def test_stops_stand_in_natural_order_each_with_its_station_team_and_task():
    found = [(one.name, one.station, one.team, PLAN.tasks[one.task].name) for one in PLAN.stops]
    assert found == [
        ("p2: jam9", 0, 0, "p2: jam9"),
        ("p2: jam10", 0, 1, "p2: jam10"),
        ("p10: wear", 1, NO_TEAM, "p10: wear"),
        ("p2: clean", 0, NO_TEAM, "p2: clean"),
        ("p10: oil", 1, 2, "p10: oil"),
    ]
    assert [(team.name, team.n) for team in PLAN.repair_teams] == [("a9", 1), ("a10", 1), ("b", 3)]


def test_what_counts_is_a_time_or_a_number_of_cycles():
    assert [(one.by, one.every) for one in PLAN.breakdowns] == [
        ("busy", Exponential(14400.0)),
        ("cycles", Geometric(50.0, 1.0)),
        ("cycles", UniformCount(4, 9)),
    ]
    assert [(one.first_s, one.every_s, one.after_job) for one in PLAN.maintenance] == [
        (3600.0, 14400.0, False),
        (14400.0, 14400.0, True),
    ]


def test_repairs_keep_their_luck_where_the_variability_of_tasks_is_switched_off():
    models = {task.name: task.model for task in PLAN.tasks}
    assert models["p10: wear"] == Exponential(60.0)
    assert [models[name] for name in ("p10: oil", "p2: clean")] == [Fixed(540.0), Fixed(420.0)]


def test_a_scenario_without_stops_has_none_in_its_plan():
    lines = [line for line in SHOP.split("\n") if not any(word in line for word in ("breakd", "maint", "jam", "teams"))]
    bare = plan("\n".join(lines))
    assert bare.stops == bare.repair_teams == ()
    assert [task.name for task in bare.tasks] == ["press"]
