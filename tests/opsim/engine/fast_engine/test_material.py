"""Conveyors on both engines: those that accumulate, and those that stand as a whole.

Vehicles on both engines: who is fetched by which, in what order, and where they go.

Stores: what came first is taken first, and of lots in part, as SimPy's engine does.

Bills of material: who has his parts first, as SimPy's engine gives them out.

Stores that are kept filled, as SimPy's engine asks for pieces.

Jobs come in as SimPy's engine lets them in: some at once, where nothing else happens, others by their claims.

Where jobs come to in time, on both engines, with more questions than answers are kept.

Places that are asked for before, and buffers behind: kept, given up and cleared as SimPy's engine does.
"""

import pytest
from engine_evidence.rows import first_difference
from opsim.engine.fast_engine.overtime import MOST_KNOWN
from plans import plan
from twins import twins

from opsim.engine.fast_engine.run import Machine
from opsim.engine.floor.run import run_plan
from opsim.log import AFTER as AFTER_of_places
from opsim.log import (
    BAD,
    BLOCKED,
    CREATE,
    FINISH,
    HELD,
    JOIN,
    NO_PARTS,
    NO_PLACE,
    OFF,
    PICKUP,
    QUEUE,
    REWORK,
    SCRAP,
    STOCK,
    TRANSPORT,
    WAIT,
)

BELT = """
opsim: 1
name: belt
run: {horizon: 400 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 0 m]}}
tasks: {feed: {dist: exponential, mean: 3 s, automatic: true}, pack: {dist: exponential, mean: 4 s, automatic: true}}
stations: {feeder: {at: a, tasks: [feed], servers: 2, buffer: 2}, packer: {at: c, tasks: [pack], buffer: 1}}
conveyors:
  belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m, accumulating: FIRST}
  then: {from: b, to: c, speed: 0.7 m/s, pitch: 1.3 m, accumulating: SECOND}
products: {x: {route: [feeder, belt, then, packer]}, y: {route: [then, packer], priority: 1}}
sources: {s: {kind: saturated, products: [x]}, t: {kind: poisson, every: 25 s, products: [y]}}
"""
PACE = (
    ("feed: {dist: exponential, mean: 3 s,", "feed: {fixed: 2 s,"),
    ("pack: {dist: exponential, mean: 4 s,", "pack: {fixed: 2 s,"),
)


@pytest.mark.parametrize("first", ["true", "false"])
@pytest.mark.parametrize("second", ["true", "false"])
def test_jobs_ride_queue_and_get_off(first, second):
    log = twins(BELT, ("FIRST", first), ("SECOND", second))
    assert min(len(log.of(kind)) for kind in (FINISH, QUEUE, TRANSPORT)) > 40


@pytest.mark.parametrize("kind", ["true", "false"])
def test_what_gets_on_and_off_at_one_instant_does_so_in_one_order(kind):
    log = twins(BELT, ("FIRST", kind), ("SECOND", kind), ("0.7 m/s, pitch: 1.3 m", "0.5 m/s, pitch: 1 m"), *PACE)
    assert len(log.of(FINISH)) > 80


def test_a_belt_before_a_station_that_breaks_down_fills_and_empties():
    jam = "buffer: 1, breakdowns: {jam: {every: {fixed: 60 s}, repair: {fixed: 30 s}}}"
    log = twins(BELT, ("FIRST", "true"), ("SECOND", "false"), ("buffer: 1", jam))
    assert len(log.of(FINISH)) > 30


TRUCK = """
opsim: 1
name: trucks
run: {horizon: 900 s, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], c: [30 m, 0 m], dock: [0 m, 10 m]}}
tasks: {cut: {dist: exponential, mean: 9 s}, pack: {dist: exponential, mean: 7 s, automatic: true}}
stations:
  saw: {at: a, tasks: [cut], servers: 2, buffer: 4, BEHIND}
  packer: {at: b, tasks: [pack], buffer: 3}
  store: {at: c, tasks: [pack], buffer: 3}
transporters:
  truck: {at: dock, n: 2, speed: 2 m/s, load: 3 s, unload: 2 s, capacity: LOAD, legs: [[saw, packer], [saw, store]]}
  cart: {at: c, speed: 1 m/s, load: 0 s, unload: 0 s, legs: [[packer, store]], idle: home}
products: {x: {route: [saw, packer, store], share: 0.6}, y: {route: [saw, store], priority: 1, share: 0.4}}
release: {kind: poisson, every: 14 s, at_once: 2}
workers: {ana: {skills: {saw: 1.0}}, ben: {skills: {saw: 0.8}}}
allocation: {when_blocked: free}
"""
PLAIN = "buffer: 4, BEHIND", "buffer: 4"
AFTER = "BEHIND", "buffer_after: 2"


@pytest.mark.parametrize("load", ["1", "3"])
@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("behind", [PLAIN, AFTER])
def test_vehicles_fetch_and_bring_what_calls_for_them(load, held, behind):
    log = twins(TRUCK, ("LOAD", load), behind, ("when_blocked: free", f"when_blocked: {held}"))
    assert len(log.of(FINISH)) > 20 and PICKUP in log.of(HELD)["cause"]
    assert set(log.of(TRANSPORT)["k"].tolist()) == {-1, 0, 1, 2}


def test_a_station_away_from_which_nobody_drives_for_nothing():
    """All places of one spot: vehicles come, load and unload in no time, and go home by no way."""
    log = twins(
        TRUCK, ("LOAD", "2"), PLAIN, ("load: 3 s, unload: 2 s", "load: 0 s, unload: 0 s"), ("[20 m, 0 m]", "[0 m, 0 m]")
    )
    assert len(log.of(FINISH)) > 20


def test_a_job_waits_for_room_before_it_calls_and_its_worker_is_free():
    log = twins(TRUCK, ("LOAD", "1"), PLAIN, ("mean: 7 s, automatic: true", "mean: 20 s, automatic: true"))
    assert len(log.of(BLOCKED)) and len(log.of(WAIT))


BENCH = """
opsim: 1
name: bench
run: {horizon: 800 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {join: {dist: exponential, mean: 9 s}, make: {dist: exponential, mean: 5 s}}
stores: {wheels: {at: here, capacity: 4, initial: 2}, frames: {at: here, initial: {frame: 3, heavy: 1}}}
stations: {press: {at: here, tasks: [make], buffer: 2, yield: 0.8}, join: {at: here, tasks: [join], buffer: 2}}
products:
  wheel: {route: [press, wheels], lot: 5}
  frame: {route: [frames]}
  heavy: {route: [frames], lot: 3}
  bike: {route: [join], parts: {join: {wheel: 2, frame: 1, heavy: 2}}}
sources:
  wheels: {kind: saturated, products: [wheel]}
  frames: {kind: poisson, every: 8 s, products: [frame, heavy]}
  bikes: {kind: poisson, every: 10 s, products: [bike]}
workers: {w1: {skills: {press: 1.0}}, w2: {skills: {join: 1.0}}}
"""


def test_lots_are_taken_in_part_and_what_is_bad_makes_bad():
    log = twins(BENCH)
    assert len(log.of(JOIN)) > 30 and STOCK in log.of(QUEUE)["cause"]
    finished = log.where(log["product"] == log.names["product"].index("bike"))
    assert BAD in finished["cause"]


def test_a_full_store_blocks_who_makes_for_it():
    log = twins(BENCH, ("capacity: 4", "capacity: 2"), ("every: 10 s", "every: 30 s"))
    assert len(log.of(JOIN)) > 10


KITS_BENCH = """
opsim: 1
name: kits
run: {horizon: 900 s, seed: 6}
layout: {places: {here: [0 m, 0 m]}}
tasks: {join: {dist: exponential, mean: 6 s}, pack: {fixed: 4 s, automatic: true}}
stores: {rack: {at: here}, shelf: {at: here, initial: 4}}
stations:
  join: {at: here, tasks: [join], servers: 3, buffer: 4MORE}
  pack: {at: here, tasks: [pack], servers: 2, buffer: 2}
products:
  bolt: {route: [rack], lot: 4}
  plate: {route: [rack]}
  box: {route: [shelf]}
  small: {route: [join, pack], parts: {join: {bolt: 2}, pack: {box: 1}}}
  large: {route: [join, pack], lot: 2, priority: 1, parts: {join: {bolt: 3, plate: 1}, pack: {box: 1}}}
  plain: {route: [join]}
sources:
  parts: {kind: poisson, every: 6 s, products: [bolt, plate]}
  boxes: {kind: poisson, every: 9 s, products: [box]}
  jobs: {kind: poisson, every: 7 s, products: [small, large, plain]}
workers: {w1: {skills: {join: 1.0}}, w2: {skills: {join: 1.5}}}
"""


def bench(more=""):
    return KITS_BENCH.replace("MORE", more)


def waited(log):
    return int((log.of(HELD)["cause"] == NO_PARTS).sum())


def test_one_that_cannot_be_met_does_not_hold_up_those_behind_it():
    log = twins(bench())
    assert waited(log) > 40 and len(log.of(JOIN)) > 80


def test_the_jobs_of_a_batch_have_their_parts_together():
    log = twins(bench(", batch: {size: 2, most_wait: 30 s}"))
    assert waited(log) > 20 and len(log.of(JOIN)) > 60


def test_who_was_taken_off_his_server_asks_again():
    log = twins(bench(", preempt: resume"))
    assert waited(log) > 40


BASE_STOCK_STOCK = """
opsim: 1
name: stock
run: {horizon: 1500 s, seed: 4}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {make: {dist: exponential, mean: 4 s}, pack: {fixed: 3 s, automatic: true}}
stations:
  s1: {at: hall, tasks: [make], buffer: 2, inspect: {finds: 0.9, false_alarms: 0.2, then: scrap}}
  s2: {at: hall, tasks: [make]}
  out: {at: hall, tasks: [pack], servers: 2}
stores: {rack: {at: hall, initial: 1}, shelf: {at: hall}}
products:
  piece: {route: [s1, rack], lot: 3}
  lid: {route: [s2, shelf]}
  order: {route: [out], parts: {out: {piece: 2, lid: 1}}}
sources:
  orders: {kind: poisson, every: 12 s, at_once: 2, products: [order]}
  lids: {kind: base_stock, store: shelf, level: 3}
  refill: {kind: base_stock, store: rack, level: 4}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}}
"""


def test_pieces_are_begun_for_what_was_taken_is_waited_for_or_was_scrapped():
    log = twins(BASE_STOCK_STOCK)
    assert len(log.of(SCRAP)) > 10 and len(log.of(CREATE)) > 300


LINE = """
opsim: 1
name: line
run: {horizon: 2000 s, seed: 6}
layout: {places: {hall: [0 m, 0 m], far: [4 m, 0 m]}}
tasks:
  cut: {TIME, automatic: true}
  bend: {TIME, automatic: true}
  check: {TIME}
stations:
  saw: {at: hall, tasks: [cut], buffer: 1}
  oven: {at: hall, tasks: [bend], buffer: ROOM, servers: 2}
  press: {at: far, tasks: [bend], buffer: ROOM}
  bench: {at: far, tasks: [check], buffer: ROOM}
products:
  plate: {route: [saw, oven, press, bench]}
  sheet: {route: [oven, press, press, bench]}
sources:
  plates: {kind: saturated, products: [plate]}
  sheets: {kind: poisson, every: 40 s, products: [sheet]}
workers: {w1: {skills: {bench: 1.0}}}
allocation: {when_blocked: HELD}
"""
TIMES = {"ties": "fixed: 8 s", "hardly any ties": "dist: exponential, mean: 8 s"}


@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("room", [0, 2, 50])
@pytest.mark.parametrize("time", TIMES)
def test_who_comes_in_when_is_the_same(time, room, held):
    log = twins(LINE.replace("TIME", TIMES[time]).replace("ROOM", str(room)).replace("HELD", held))
    assert len(log.of(FINISH)) > 40
    assert room or len(log.of(BLOCKED)) > 40


HEAD = """
opsim: 1
name: reach
run: {start: Mon 06:00, horizon: 8 h, seed: 8}
layout: {places: {bay: [0 m, 0 m]}}
tasks: {run: {dist: lognormal, mean: 40 min, cv: 1.0, automatic: true}, pack: {fixed: 30 s}}
shifts: {early: {from: 06:00, to: 06:20, overtime: {most: 6 h}}}
workers: {ana: {shift: early, skills: {packer: 1}}}
stations:
  packer: {at: bay, tasks: [pack]}
"""


def test_answers_that_are_not_kept_are_found_again():
    """Of 90 ovens one after the other has a run that will not be over in time: a question of its own each time."""
    ovens = [f"o{n:02d}" for n in range(90)]
    text = HEAD + "".join(f"  {name}: {{at: bay, tasks: [run], buffer: 0}}\n" for name in ovens)
    text += f"products: {{{', '.join(f'p{name}: {{route: [{name}, packer]}}' for name in ovens)}}}\n"
    text += f"sources: {{{', '.join(f's{name}: {{kind: saturated, products: [p{name}]}}' for name in ovens)}}}\n"
    made = plan(text)
    machine, log = Machine(made), run_plan(made)
    assert first_difference(log, machine.run(0)) == ""
    assert len(log.of(FINISH)) > MOST_KNOWN and len(log.of(OFF))
    assert len(machine.floor.people.needs.known) == MOST_KNOWN


PLACES_LINE = """
opsim: 1
name: places
run: {horizon: 1200 s, seed: 4}
layout: {places: {p: [0 m, 0 m], q: [4 m, 0 m], r: [8 m, 0 m]}}
tasks: {quick: {fixed: 5 s}, slow: {fixed: 8 s}, look: {fixed: 6 s}}
stations:
  a: {at: p, tasks: [quick], servers: 2, buffer: 1MORE}
  b: {at: q, tasks: [slow], servers: 2, buffer: 0MORE}
  c: {at: r, tasks: [look], buffer: 1, inspect: {finds: 0.8, false_alarms: 0.2, then: {rework: a}, most: 2}}
products:
  x: {share: 0.5, route: [a, b, c]}
  y: {share: 0.5, routing: {start: a, a: {a: 0.3, b: 0.4, out: 0.3}, b: {b: 0.2, c: 0.8}, c: out}}
release: {kind: renewal, every: {fixed: 5 s}}
workers:
  u: {walk: 2 m/s, skills: {a: 1.0, b: 1.0}}
  v: {walk: 2 m/s, skills: {b: 1.0, c: 1.0}}
  w: {walk: 2 m/s, skills: {a: 1.0, c: 1.0}}
"""


def line(more):
    return PLACES_LINE.replace("MORE", more)


def n_rows(log, kind, cause):
    return len(log.where((log["kind"] == kind) & (log["cause"] == cause)))


def test_jobs_that_ask_first_wait_with_their_work_undone():
    log = twins(line(", blocking: before"))
    assert n_rows(log, HELD, NO_PLACE) > 5 and len(log.of(REWORK)) > 1


@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("carried", ["false", "true"])
def test_finished_jobs_clear_their_servers(held, carried):
    end = f"allocation: {{when_blocked: {held}}}\n"
    log = twins(line(", buffer_after: 1") + end, ("x: {share", f"x: {{carried: {carried}, share"))
    assert n_rows(log, QUEUE, AFTER_of_places) > 5 and len(log.of(BLOCKED)) > 2


def test_a_place_that_is_kept_and_a_buffer_behind_go_together():
    log = twins(line(", blocking: before, buffer_after: 1"))
    assert n_rows(log, HELD, NO_PLACE) > 5


def test_who_loses_his_server_may_have_lost_his_place_too():
    jam = ", breakdowns: {jam: {every: {fixed: 11 s}, by: busy, repair: {fixed: 5 s}, job: restart}}, preempt: resume"
    log = twins(line(f", blocking: before{jam}"), ("buffer: 0", "buffer: 2"), ("y: {share", "y: {priority: 2, share"))
    assert n_rows(log, HELD, NO_PLACE) > 5
