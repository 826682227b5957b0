"""Known answers by hand arithmetic: 20 m at 2 m/s are driven in 10 s; loading takes 3 s and unloading 2 s a job."""

from itertools import pairwise

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.log import FINISH, HELD, PICKUP, QUEUE, TRANSPORT, WAIT

TRUCK = """
opsim: 1
name: truck
run: {horizon: 200 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], c: [30 m, 0 m], dock: [0 m, 10 m]}}
tasks: {cut: {fixed: 5 s, automatic: true}, pack: {fixed: 1 s, automatic: true}}
stations: {saw: {at: a, tasks: [cut], buffer: 9}, packer: {at: b, tasks: [pack], buffer: 9}}
transporters: {truck: {at: dock, speed: 2 m/s, load: 3 s, unload: 2 s, legs: [[saw, packer]]}}
products: {x: {route: [saw, packer]}}
release: {kind: renewal, every: {fixed: 60 s}}
"""
BURST = TRUCK.replace("every: {fixed: 60 s}", "every: {fixed: 100 s}, at_once: 3").replace(
    "{at: a,", "{at: a, servers: 3,"
)


def logged(text):
    p = plan(text)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    return log, p


def spans(log):
    return list(zip(log["start_s"].tolist(), log["end_s"].tolist()))


def driven(log, p, vehicle=0):
    """(start, end, from, to) of all that a vehicle did."""
    mine = log.of(TRANSPORT).where((log.of(TRANSPORT)["job"] < 0) & (log.of(TRANSPORT)["k"] == vehicle))
    ends = [[p.places[rank] for rank in mine[column]] for column in ("place_from", "place_to")]
    return [(*span, *way) for span, *way in zip(spans(mine), *ends)]


def test_a_job_waits_on_its_server_until_the_vehicle_has_loaded_it():
    log, p = logged(TRUCK)
    # cut 60-65 s; the truck comes from the dock (10 m) in 5 s, loads until 73 s, drives 10 s, unloads until 85 s
    held = log.of(HELD)
    assert spans(held)[:1] == [(65.0, 73.0)] and held["cause"][0] == PICKUP
    jobs = log.of(TRANSPORT).where(log.of(TRANSPORT)["job"] >= 0)
    assert spans(jobs)[0] == (73.0, 85.0)
    assert log.of(FINISH)["end_s"].tolist() == [86.0, 151.0]
    # the second, cut at 125 s: 10 s back from b, where the truck stayed
    assert driven(log, p)[:8] == [
        (65.0, 70.0, "dock", "a"),
        (70.0, 73.0, "a", "a"),
        (73.0, 83.0, "a", "b"),
        (83.0, 85.0, "b", "b"),
        (125.0, 135.0, "b", "a"),
        (135.0, 138.0, "a", "a"),
        (138.0, 148.0, "a", "b"),
        (148.0, 150.0, "b", "b"),
    ]


def test_an_empty_vehicle_goes_home_where_it_is_told_to():
    log, p = logged(TRUCK.replace("unload: 2 s", "unload: 2 s, idle: home"))
    # b to the dock along the axes: 30 m in 15 s; so the second job is fetched from the dock again
    assert driven(log, p)[4] == (85.0, 100.0, "b", "dock")
    assert driven(log, p)[5] == (125.0, 130.0, "dock", "a")
    assert log.of(FINISH)["end_s"].tolist() == [86.0, 146.0]


@pytest.mark.parametrize(
    ("capacity", "finished"),
    [
        # one by one: 110 load 113 drive 123 unload 125, back 135; and so on, 25 s a round
        (1, [126.0, 151.0, 176.0]),
        # two: loaded 110-116, there 126, unloaded 128 and 130; back 140, loaded 143, there 153, unloaded 155
        (2, [129.0, 131.0, 156.0]),
        # three: loaded 110-119, there 129, unloaded 131, 133, 135
        (3, [132.0, 134.0, 136.0]),
    ],
)
def test_a_vehicle_takes_along_what_it_has_room_for(capacity, finished):
    log, _ = logged(BURST.replace("unload: 2 s", f"unload: 2 s, capacity: {capacity}"))
    assert log.of(FINISH)["end_s"].tolist() == finished


def test_several_vehicles_share_the_calls():
    log, p = logged(BURST.replace("at: dock, speed", "n: 3, at: dock, speed"))
    assert log.of(FINISH)["end_s"].tolist() == [126.0, 127.0, 128.0]
    assert all(len(driven(log, p, vehicle)) == 4 for vehicle in range(3))


def test_a_vehicle_fetches_a_job_only_when_its_place_is_sure():
    text = BURST.replace("{at: b, tasks: [pack], buffer: 9}", "{at: b, tasks: [pack], buffer: 0}")
    log, _ = logged(text.replace("pack: {fixed: 1 s", "pack: {fixed: 30 s").replace("200 s", "300 s"))
    # the first is packed 125-155 s, so the second is called for at 155 s: back at a 145 -> it drives 155-165 s
    waits = log.of(HELD).where(log.of(HELD)["cause"] == PICKUP)
    assert spans(waits)[:2] == [(105.0, 113.0), (155.0, 168.0)]


def test_roads_of_its_own_are_the_only_ways_a_vehicle_takes():
    roads = (
        "roads: [[dock, a], {from: a, to: c, length: 40 m}, [c, b], {from: b, to: dock, one_way: true, length: 50 m}], "
    )
    log, p = logged(TRUCK.replace("legs:", roads + "legs:"))
    # a to b leads by c: 50 m in 25 s; back it is 60 m by the dock, so by c again
    assert [row[:2] for row in driven(log, p)][2:5] == [(73.0, 98.0), (98.0, 100.0), (125.0, 150.0)]


def test_what_goes_to_several_places_goes_to_the_nearest_first():
    text = BURST.replace("packer: {at: b", "far: {at: c, tasks: [pack]}, packer: {at: b").replace(
        "legs: [[saw, packer]]", "capacity: 3, legs: [[saw, packer], [saw, far]]"
    )
    two = "{x: {share: 0.5, route: [saw, packer]}, y: {share: 0.5, route: [saw, far]}}"
    log, _ = logged(
        text.replace("{x: {route: [saw, packer]}}", two).replace("at_once: 3", "at_once: 3, sequence: [y, y, x]")
    )
    # loaded 110-119 s; to b (10 s), the third job unloaded 131 s; on to c (5 s), 136, unloaded 138 and 140 s
    assert log.of(FINISH)["end_s"].tolist() == [132.0, 139.0, 141.0]
    assert log.of(FINISH)["job"].tolist()[0] == 2


def test_a_belt_is_left_by_vehicle_at_its_end():
    text = (
        TRUCK.replace("transporters:", "conveyors: {belt: {from: c, to: a, speed: 1 m/s, pitch: 1 m}}\ntransporters:")
        .replace("route: [saw, packer]", "route: [belt, packer]")
        .replace("[[saw, packer]]", "[[belt, packer]]")
    )
    log, _ = logged(text)
    # on the belt 60-90 s, the truck at its end a at 95 s, loaded 98 s, there 108 s, unloaded 110 s
    assert log.of(FINISH)["end_s"][0] == 111.0
    assert log.of(HELD)["cause"][0] == PICKUP


def test_nobody_stays_with_a_carried_job_that_a_vehicle_fetches():
    text = TRUCK.replace("cut: {fixed: 5 s, automatic: true}", "cut: {fixed: 5 s}").replace(
        "route: [saw, packer]}", "route: [saw, packer], carried: true}"
    )
    log, _ = logged(text + "workers: {w: {skills: {saw: 1.0}}}\n")
    assert not np.any(log.of(WAIT)["job"] >= 0)
    assert log.of(FINISH)["end_s"].tolist() == [86.0, 151.0]


def test_without_times_a_vehicle_at_hand_is_passing_on_at_once():
    near = (
        TRUCK.replace("load: 3 s, unload: 2 s, ", "").replace("at: dock", "at: a").replace("[20 m, 0 m]", "[0 m, 0 m]")
    )
    log, _ = logged(near)
    assert log.of(FINISH)["end_s"].tolist() == [66.0, 126.0, 186.0]
    assert len(log.of(TRANSPORT)) == len(log.of(HELD)) == len(log.of(QUEUE)) == 0


def test_at_the_horizon_a_vehicle_is_on_its_way():
    log, p = logged(TRUCK.replace("200 s", "80 s"))
    assert driven(log, p)[-1] == (73.0, 80.0, "a", "b")


def test_random_work_with_vehicles_keeps_every_law():
    text = BURST.replace("every: {fixed: 100 s}, at_once: 3", "every: {dist: exponential, mean: 20 s}, at_once: 2")
    text = text.replace("200 s", "8000 s").replace("buffer: 9}}", "buffer: 1}}")
    log, p = logged(
        text.replace("unload: 2 s", "unload: 2 s, n: 2, capacity: 2").replace(
            "pack: {fixed: 1 s", "pack: {dist: exponential, mean: 6 s"
        )
    )
    assert len(log.of(FINISH)) > 400
    for vehicle in range(2):
        mine = driven(log, p, vehicle)
        assert all(before[1] <= after[0] and before[3] == after[2] for before, after in pairwise(mine))


TWO_WAYS = """
opsim: 1
name: both
run: {horizon: 1000 s, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], c: [20 m, 20 m]}}
tasks: {t: {fixed: 4 s, automatic: true}}
stations:
  one: {at: a, servers: 2, tasks: [t], buffer: 2}
  two: {at: b, servers: 2, tasks: [t], buffer: 1}
  three: {at: c, tasks: [t], buffer: 1}
conveyors:
  belt1: {from: b, to: c, speed: 1 m/s, pitch: 2 m}
  belt2: {from: b, to: c, speed: 1 m/s, pitch: 2 m, accumulating: false}
transporters:
  cart1: {n: 2, at: a, speed: 2 m/s, capacity: 2, load: 1 s, legs: [[one, two], [three, one]]}
  cart2: {at: c, speed: 2 m/s, unload: 1 s, idle: home, legs: [[one, three]]}
products:
  x: {share: 0.5, route: [one, two, [belt1, belt2], three]}
  y: {share: 0.5, routing: {start: one, one: three, three: {one: 0.2, out: 0.8}}}
release: {kind: renewal, every: {fixed: 8 s}, when_full: lose}
"""


def test_the_order_of_declaration_decides_nothing():
    lines = TWO_WAYS.splitlines()
    pairs = [("  belt1:", "  belt2:"), ("  cart1:", "  cart2:"), ("  x:", "  y:"), ("  one:", "  three:")]
    at = {name: i for i, line in enumerate(lines) for pair in pairs for name in pair if line.startswith(name)}
    turned = list(lines)
    for one, two in pairs:
        turned[at[one]], turned[at[two]] = lines[at[two]], lines[at[one]]
    text = "\n".join(turned).replace("[[one, two], [three, one]]", "[[three, one], [one, two]]")
    log, p = logged(TWO_WAYS)
    other, _ = logged(text.replace("[belt1, belt2]", "[belt2, belt1]"))
    assert len(log.of(FINISH)) > 40 and len(driven(log, p, 2)) > 20
    assert all(np.array_equal(log[name], other[name], equal_nan=log[name].dtype.kind == "f") for name in log.columns)
