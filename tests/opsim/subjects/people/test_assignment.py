"""Whose work it is: zones, floaters, priorities, rules, qualities, one operation a stop; times by hand."""

import numpy as np
import pytest
import simpy
from plans import plan, ran

from opsim.engine.floor.floor_state import DUTY
from opsim.engine.floor.run import FloorOfPlan
from opsim.engine.floor.state import Claim
from opsim.kpi import figures
from opsim.log import BAD, FINISH, WALK, WORK
from opsim.subjects.people.allocation import _walk_on
from opsim.subjects.people.worker import leave_those

TWO = """
opsim: 1
name: two stations
run: {horizon: 100 s, seed: 1}
layout: {places: {hall: [0 m, 0 m], far: [10 m, 0 m]}}
tasks: {first: {fixed: 10 s}, second: {fixed: 10 s}}
stations:
  a: {at: hall, tasks: [first], servers: 2}
  b: {at: hall, tasks: [second], servers: 2}
products: {pa: {route: [a]}, pb: {route: [b]}}
sources:
  sa: {kind: schedule, file: a.csv}
workers:
  w1: {skills: {a: 1.0, b: 1.0}}
  w2: {skills: {a: 1.0, b: 1.0}}
allocation: {rule: oldest_job}
"""


def arrivals(*orders):
    """A source for each (product, at): one job that comes in at this time."""
    sources = "\n".join(
        f"  s{n}: {{kind: renewal, every: {{fixed: {at} s}}, products: [{product}]}}"
        for n, (product, at) in enumerate(orders)
    )
    return "  sa: {kind: schedule, file: a.csv}", sources


def work(log, plan):
    """(worker, station, start) of each performance, by start."""
    rows = log.of(WORK)
    order = np.lexsort([rows["worker"], rows["start_s"]])
    names = [(plan.workers[w].name, plan.stations[s].name) for w, s in zip(rows["worker"], rows["station"])]
    return [(*names[i], float(rows["start_s"][i])) for i in order]


def first_work(*edits):
    log, plan = ran(TWO, *edits)
    return work(log, plan)


W1, W2 = "w1: {skills: {a: 1.0, b: 1.0}}", "w2: {skills: {a: 1.0, b: 1.0}}"
BOTH_AT_60 = arrivals(("pa", 60), ("pb", 60))
"""One job for a and one for b at 60 s."""


def test_without_zones_natural_order_decides():
    assert first_work(BOTH_AT_60) == [("w1", "a", 60), ("w2", "b", 60)]


def test_everybody_goes_to_his_own_zone_first():
    zones = ((W1, W1.replace("}}", "}, zone: [b]}")), (W2, W2.replace("}}", "}, zone: [a]}")))
    assert first_work(BOTH_AT_60, *zones) == [("w1", "b", 60), ("w2", "a", 60)]


def test_a_worker_helps_outside_his_zone_where_nobody_of_it_is_free():
    zones = ((W1, W1.replace("}}", "}, zone: [b]}")), (W2, W2.replace("}}", "}, zone: [b]}")))
    assert first_work(BOTH_AT_60, *zones) == [("w1", "b", 60), ("w2", "a", 60)]


def test_a_floater_goes_only_where_nobody_is_free_whose_own_station_it_is():
    floats = (W1, W1.replace("}}", "}, floater: true}"))
    assert first_work(arrivals(("pa", 60)), floats) == [("w2", "a", 60)]
    assert first_work(BOTH_AT_60, floats) == [("w1", "b", 60), ("w2", "a", 60)]


def test_a_floater_goes_before_people_are_drawn_out_of_their_zones():
    edits = ((W1, W1.replace("}}", "}, zone: [a]}")), (W2, W2.replace("}}", "}, floater: true}")))
    assert first_work(arrivals(("pb", 60)), *edits) == [("w2", "b", 60)]


def test_a_floater_leaves_a_zone_of_his_own_last_of_all():
    edits = ((W1, W1.replace("}}", "}, zone: [a], floater: true}")), (W2, W2.replace("}}", "}, zone: [a]}")))
    assert first_work(arrivals(("pb", 60)), *edits) == [("w2", "b", 60)]


ALONE = ("  " + W2 + "\n", "")
"""One worker alone, so that the order of his work is the order of the rule."""


def test_a_station_of_higher_priority_is_served_first_whatever_the_rule():
    assert served(ALONE, A_BEFORE_B) == [("a", 50), ("a", 60), ("b", 70)]
    assert served(ALONE, A_BEFORE_B, ("b: {at: hall, ", "b: {at: hall, priority: 1, ")) == B_FIRST
    other = ("a: {at: hall, ", "a: {at: hall, priority: -1, ")
    assert served(ALONE, A_BEFORE_B, other, ("rule: oldest_job", "rule: longest_queue")) == B_FIRST


def test_a_job_of_higher_priority_is_served_first_where_the_allocation_says_so():
    urgent = ("pb: {", "pb: {priority: 1, ")
    assert served(ALONE, A_BEFORE_B, urgent) == [("a", 50), ("a", 60), ("b", 70)]
    assert served(ALONE, A_BEFORE_B, urgent, ("{rule:", "{priorities: [products], rule:")) == B_FIRST


@pytest.mark.parametrize(("order", "second"), [("stations, products", "a"), ("products, stations", "b")])
def test_of_two_priorities_the_first_named_counts(order, second):
    both = (("pb: {", "pb: {priority: 1, "), ("a: {at: hall, ", "a: {at: hall, priority: 1, "))
    assert served(ALONE, A_BEFORE_B, *both, ("{rule:", f"{{priorities: [{order}], rule:"))[1] == (second, 60)


def test_best_skill_sends_everybody_where_he_is_best():
    skills = ((W1, W1.replace("b: 1.0", "b: 1.25")), (W2, W2.replace("a: 1.0", "a: 0.5")))
    assert first_work(BOTH_AT_60, *skills, ("oldest_job", "best_skill")) == [("w1", "b", 60), ("w2", "a", 60)]
    assert served(ALONE, A_BEFORE_B, skills[0], ("oldest_job", "best_skill")) == [("a", 50), ("b", 60), ("a", 68)]


@pytest.mark.parametrize(("rule", "second"), [("oldest_job", ("a", 60)), ("most_downstream", ("b", 60))])
def test_most_downstream_finishes_what_is_nearest_to_its_end(rule, second):
    """pa goes on to b at 60 s, when another one has called at a for 5 s."""
    way = ("pa: {route: [a]}", "pa: {route: [a, b]}")
    jobs = arrivals(("pa", 50), ("pa", 55))
    assert served(ALONE, jobs, way, ("oldest_job", rule))[1] == second


def served(*edits):
    """(station, start) of each performance of the worker who is alone."""
    return [(station, start_s) for _, station, start_s in first_work(*edits)]


A_BEFORE_B = arrivals(("pa", 50), ("pa", 55), ("pb", 60))
B_FIRST = [("a", 50), ("b", 60), ("a", 70)]


# -------------------------------------------------------------------------------------------------------------- quality
LEVELS = """
opsim: 1
name: levels
run: {horizon: 4 h, seed: 2}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {build: {fixed: 10 s}}
stations: {a: {at: hall, tasks: [build], buffer: 2}}
products: {p: {route: [a]}}
release: {kind: saturated}
skill_levels: {learner: {pace: 0.8, quality: 0.7}, expert: 1.25}
workers: {w: {skills: {a: learner}}}
"""
LEARNER = "{skills: {a: learner}}"


def good(*edits):
    """Jobs that left without a defect, and how many left in all."""
    log, _ = ran(LEVELS, *edits)
    finished = log.of(FINISH)
    return set(finished["job"][finished["cause"] != BAD].tolist()), len(finished)


def test_a_level_acts_on_the_pace_and_on_the_quality():
    without, n = good()
    assert n == 4 * 3600 / (10 / 0.8) - 1  # the last one ends at the horizon, which is exclusive
    assert abs(len(without) / n - 0.7) <= 4 * (0.7 * 0.3 / n) ** 0.5
    assert good((LEARNER, "{skills: {a: expert}}"))[1] == 4 * 3600 / 8 - 1


def test_quality_multiplies_the_yield_of_the_station_and_jobs_keep_their_luck():
    alone, n = good()
    both, _ = good(("tasks: [build]", "tasks: [build], yield: 0.9"))
    assert both < alone
    assert abs(len(both) / n - 0.63) <= 4 * (0.63 * 0.37 / n) ** 0.5
    better, _ = good(("quality: 0.7", "quality: 0.9"))
    assert alone < better


def test_an_inspection_finds_what_a_worker_left():
    log, plan = ran(LEVELS, ("tasks: [build]", "tasks: [build], inspect: {then: scrap}"))
    found = {f.kpi: f.value for f in figures(log, plan) if not f.subject}
    assert 0.2 < found["scrap_share"] < 0.4
    assert not any(log.of(FINISH)["cause"] == BAD)


def test_of_a_team_the_lowest_quality_counts():
    edits = ((LEARNER, "{skills: {a: learner}}, x: {skills: {a: expert}}"), ("fixed: 10 s", "fixed: 10 s, team: 2"))
    without, n = good(*edits)
    assert abs(len(without) / n - 0.7) <= 4 * (0.7 * 0.3 / n) ** 0.5


def test_only_operations_of_the_one_who_leaves_defects_are_bad():
    log, plan = ran(
        LEVELS, (LEARNER, "{skills: {a: learner}}, x: {skills: {a: expert}}"), ("[build]", "[build], servers: 2")
    )
    rows, finished = log.of(WORK), log.of(FINISH)
    by = dict(zip(rows["job"].tolist(), rows["worker"].tolist()))
    bad = finished["job"][finished["cause"] == BAD].tolist()
    assert len(bad) > 100
    assert {plan.workers[by[job]].name for job in bad} == {"w"}


# --------------------------------------------------------------------------------------------------------------- patrol
ROUND = """
opsim: 1
name: round
run: {horizon: 70 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [3 m, 4 m]}}
tasks: {t: {fixed: 2 s}}
stations: {sa: {at: a, tasks: [t]}, sb: {at: b, tasks: [t]}, sc: {at: c, tasks: [t]}}
products: {x: {route: [sa, sb, sc]}}
release: {kind: renewal, every: {fixed: 40 s}, at_once: 2}
workers: {w: {walk: 1 m/s, home: a, patrol: [sa, sb, sc], skills: {sa: 1.0, sb: 1.0, sc: 1.0}}}
allocation: {idle: patrol}
"""


@pytest.mark.parametrize(
    ("serve", "starts"),
    [
        # a -> b 3 s, b -> c 4 s, c -> a 7 s; he comes to a at 42 s
        ("exhaustive", [("sa", 42), ("sa", 44), ("sb", 49), ("sb", 51), ("sc", 57), ("sc", 59)]),
        ("one", [("sa", 42), ("sb", 47), ("sc", 53), ("sa", 62), ("sb", 67)]),
    ],
)
def test_who_patrols_serves_a_station_empty_or_one_operation(serve, starts):
    log, plan = ran(ROUND, ("idle: patrol", f"idle: patrol, serve: {serve}"))
    assert [(station, start_s) for _, station, start_s in work(log, plan)] == starts


def test_one_operation_a_stop_is_all_its_tasks():
    log, plan = ran(
        ROUND, ("idle: patrol", "idle: patrol, serve: one"), ("sa: {at: a, tasks: [t]}", "sa: {at: a, tasks: [t, t]}")
    )
    assert [s for _, s, _ in work(log, plan)][:4] == ["sa", "sa", "sb", "sc"]


def test_stations_at_one_place_are_served_in_turn():
    log, plan = ran(
        ROUND,
        ("idle: patrol", "idle: patrol, serve: one"),
        ("b: [3 m, 0 m], c: [3 m, 4 m]", "b: [0 m, 0 m], c: [0 m, 0 m]"),
    )
    assert len(log.of(WALK)) == 0
    assert [s for _, s, _ in work(log, plan)] == ["sa", "sb", "sc", "sa", "sb", "sc"]


def test_a_call_that_somebody_may_not_serve_does_not_stop_him_on_his_round():
    """Else he would come to it for ever: his skills may be taken from him for a while, as before a break."""
    one_place = ROUND.replace("b: [3 m, 0 m], c: [3 m, 4 m]", "b: [0 m, 0 m], c: [0 m, 0 m]")
    one = FloorOfPlan(plan(one_place))
    one.open(simpy.Environment())
    floor = one.floor
    floor.stations[1].calling.append(Claim())
    assert _walk_on(floor)
    leave_those(floor, floor.workers[0], DUTY, [0])
    assert not _walk_on(floor)
