"""Calendars on both engines: shifts, pauses one after the other, absence, midnight, weeks.

Hours of stations and sources, on both engines.

Overtime on both engines: who stays, for what, and until when; on floors of more stations than a word has bits.

Hand-over on both engines: somebody is wanted, comes and takes over, or not.

Plans that are too large for the ids of streams are refused in words, not run with the luck of others.
"""

from types import SimpleNamespace

import pytest
from made.machine import Floor, Given, empty_floor, entered
from plans import CELL as LIMITED
from plans import plan, queue
from stand_in_engine import install_rule
from twins import twins

from opsim.engine.choice import NotFast, able_to
from opsim.engine.fast_engine import run, run_plan, unsupported
from opsim.engine.fast_engine.random_numbers import MOST_RANKS, stream_id, stream_of
from opsim.engine.fast_engine.run import refuse_too_many
from opsim.log import ABSENT, BREAK, CLOSED, CREATE, FINISH, HELD, OFF, WALK, WORK

CELL = """
opsim: 1
name: duty
run: {start: Mon 05:30, horizon: 4 d, seed: 6}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m], canteen: [0 m, 40 m]}}
tasks: {weld: {dist: lognormal, mean: 40 min, cv: 0.3}, file: {fixed: 25 min}}
stations: {bench: {at: bay, tasks: [weld], servers: 2, buffer: 3}, vice: {at: shed, tasks: [file]}}
products: {part: {route: [bench, vice]}}
sources: {s: {kind: poisson, every: 30 min, products: [part]}}
shifts:
  early:
    from: 06:00
    to: 14:00
    at_end: AT_END
    breaks:
      tea: {at: 06:00, lasts: 5 min}
      rest: {at: 06:05, lasts: 20 min, place: canteen}
      last: {at: 13:40, lasts: 20 min}
    meetings: {board: {at: 10:00, lasts: 15 min}}
  late: {from: 14:00, to: 22:00, overtime: {most: 90 min}, breaks: {tea: {at: 18:00, lasts: 30 s, place: canteen}}}
  night: {from: 22:00, to: 06:00, at_end: AT_END, days: [Mon, Tue, Wed]}
workers:
  ana: {shift: early, absence: 0.3, walk: 1 m/s, home: shed, skills: {bench: 1, vice: 1}}
  ben: {shift: [early, late], absence: 0.3, walk: 1 m/s, skills: {bench: 1, vice: 1}}
  cem: {shift: late, absence: 0.6, walk: 1 m/s, skills: {bench: 1}}
  dora: {shift: night, walk: 1 m/s, skills: {bench: 1, vice: 1}}
"""


@pytest.mark.parametrize("rule", ["finish", "resume", "finish_job"])
@pytest.mark.parametrize("replication", [0, 3])
def test_people_come_and_go_by_their_calendars(rule, replication):
    log = twins(CELL, ("AT_END", rule), replication=replication)
    assert min(len(log.of(kind)) for kind in (ABSENT, BREAK, FINISH, OFF, WORK)) >= 5


def test_shifts_that_follow_at_once_may_be_missed():
    double = ("  late: {from: 14:00", "  second: {from: 14:00, to: 21:00}\n  late: {from: 14:00")
    both = ("ana: {shift: early, absence: 0.3", "ana: {shift: early, absence: 0.7")
    log = twins(CELL, ("AT_END", "finish"), double, both, ("days: [Mon, Tue, Wed]", "days: [Mon, Tue, Wed, Thu, Fri]"))
    assert len(log.of(ABSENT)) >= 5


ONE = """
opsim: 1
name: two machines
run: {start: Mon 06:00, horizon: 400 s, seed: 2}
layout: {places: {hall: [0 m, 0 m]}}
shifts:
  a: {from: 06:00:20, to: 06:00:55}
  b: {from: 06:01:20, to: 06:01:50}
  c: {from: 06:02:10, to: 06:05:00}
tasks: {press: {dist: exponential, mean: 7 s, automatic: true}, trim: {dist: exponential, mean: 6 s}}
stations:
  m: {at: hall, tasks: [press], servers: 2, buffer: 2, shift: [b, a, c], at_close: HOW}
  n: {at: hall, tasks: [trim, press], buffer: 1, shift: [a, c], at_close: HOW}
products: {part: {route: [m, n]}}
release: {kind: saturated, shift: [a, b]}
workers: {ana: {skills: {n: 1.0}}}
"""
GAPS = "{kind: saturated, shift: [a, b]}", "{kind: poisson, every: 9 s, shift: [a, b, c]}"
EACH = (
    "release: {kind: saturated, shift: [a, b]}",
    (
        "sources: {x: {kind: saturated, shift: [a], products: [part]}, y: {kind: saturated, products: [part]}, "
        "z: {kind: poisson, every: 20 s, shift: [c], products: [part]}}"
    ),
)


@pytest.mark.parametrize("how", ["finish", "resume"])
@pytest.mark.parametrize("sources", [(), (GAPS,), (EACH,)])
def test_stations_and_sources_open_and_close(how, sources):
    log = twins(ONE, ("HOW", how), *sources)
    assert len(log.of(OFF)) == 7 and len(log.of(WORK)) > 20 and len(log.of(CREATE)) > 5
    assert CLOSED in log.of(HELD)["cause"]


def test_who_is_pre_empted_at_a_station_that_closes_waits_until_it_opens():
    log = twins(
        ONE,
        ("HOW", "finish"),
        GAPS,
        ("servers: 2, buffer: 2,", "servers: 1, buffer: 5, preempt: resume,"),
        ("part: {route: [m, n]}", "part: {route: [m, n], share: 0.6}, hot: {route: [m, n], priority: 1, share: 0.4}"),
    )
    assert CLOSED in log.of(HELD)["cause"]


HEAD = """
opsim: 1
name: overtime
run: {start: Mon 06:00, horizon: 60 min, seed: 5}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m]}}
shifts:
  early: {from: 06:00, to: 06:20, overtime: {most: 16 min}, breaks: {tea: {at: 06:10, lasts: 2 min}}, at_end: resume}
  mid: {from: 06:10, to: 06:30, overtime: {most: 9 min}, at_end: hand_over}
  late: {from: 06:21, to: 07:30}
"""
LATE = (
    HEAD
    + """
tasks:
  load: {fixed: 40 s}
  mill: {dist: lognormal, mean: 3 min, cv: 0.9, automatic: true}
  lift: {fixed: 30 s, team: 2}
stations:
  mill: {at: bay, tasks: [load, mill, load], servers: 2, buffer: 2}
  oven: {at: bay, tasks: [mill], servers: 2, buffer: 1, HOURS}
  bench: {at: shed, tasks: [load, lift], buffer: 1}
products:
  part: {route: [mill, oven, bench]}
  lid: {route: [oven, bench], carried: true}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 200 s, products: [lid]}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {mill: 1.0, bench: 1.0}}
  ben: {shift: early, walk: 1 m/s, skills: {mill: 0.9}}
  cem: {shift: mid, walk: 1 m/s, skills: {bench: 1.1}}
  dora: {shift: late, absence: 0.5, walk: 1 m/s, skills: {bench: 0.7, mill: 1.0}}
  eva: {walk: 1 m/s, skills: {bench: 1.0}}
"""
)


@pytest.mark.parametrize("hours", ["", ", shift: early", ", shift: late", ", shift: mid, at_close: resume"])
@pytest.mark.parametrize("replication", range(2))
def test_who_stays_stays_as_long_in_both(hours, replication):
    log = twins(LATE, (", HOURS", hours), replication=replication)
    assert len(log.of(OFF)) >= 5 and len(log.of(FINISH)) >= 3


def test_floors_of_more_stations_than_bits_are_seen_whole():
    """75 stations in a row, the last of them the only ones where those are needed whose shift is over."""
    names = [f"s{n:02d}" for n in range(75)]
    made = [f"  {name}: {{at: bay, tasks: [{'pack' if n > 70 else 'run'}], buffer: 2}}" for n, name in enumerate(names)]
    tasks = "tasks: {run: {fixed: 11 s, automatic: true}, pack: {fixed: 95 s}}"
    text = f"{HEAD}{tasks}\nstations:\n" + "\n".join(made) + f"\nproducts: {{p: {{route: [{', '.join(names)}]}}}}\n"
    people = "workers: {ana: {shift: early, skills: {s72: 1, s73: 1}}, ben: {shift: mid, skills: {s71: 1, s74: 1}}}\n"
    log = twins(text + "sources: {s: {kind: poisson, every: 80 s, products: [p]}}\n" + people)
    assert len(log.of(FINISH)) >= 3
    assert sorted(log.of(OFF)["start_s"])[-1] > 1300  # somebody has stayed on


HANDED = """
opsim: 1
name: relief
run: {start: Mon 06:00, horizon: 55 min, seed: 2}
layout: {places: {bay: [0 m, 0 m], shed: [30 m, 0 m], canteen: [0 m, 20 m]}}
tasks: {weld: {fixed: 100 s}, file: {dist: lognormal, mean: 50 s, cv: 0.3}}
stations: {bench: {at: bay, tasks: [weld, file], servers: 2, buffer: 2}, press: {at: shed, tasks: [file], servers: 2}}
products: {part: {route: [bench, press]}, top: {route: [press, bench], priority: 2}}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 90 s, products: [top]}}
shifts:
  early:
    from: 06:00
    to: 06:30
    at_end: hand_over
    at_break: hand_over
    breaks: {tea: {at: 06:05, lasts: 3 min}, rest: {at: 06:17, lasts: 2 min, place: canteen}}
  late: {from: 06:20, to: 07:00, at_break: hand_over, breaks: {tea: {at: 06:31, lasts: 90 s}}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0, press: 1.0}}
  ben: {shift: early, walk: 1 m/s, skills: {bench: 0.9}}
  cem: {shift: late, walk: 1 m/s, skills: {bench: 1.1, press: 1.0}}
  dora: {walk: 2 m/s, home: shed, skills: {bench: 0.7, press: 1.0}}
allocation: {rule: nearest, idle: home}
"""
PATROL = (
    ("idle: home", "idle: patrol"),
    ("walk: 2 m/s, home: shed,", "walk: 2 m/s, home: shed, patrol: [press, bench],"),
    ("cem: {shift: late, walk: 1 m/s,", "cem: {shift: late, walk: 1 m/s, patrol: [bench, press],"),
    ("ana: {shift: early, walk: 1 m/s,", "ana: {shift: early, walk: 1 m/s, patrol: [bench, press],"),
    ("ben: {shift: early, walk: 1 m/s,", "ben: {shift: early, walk: 1 m/s, patrol: [bench],"),
)


@pytest.mark.parametrize("rule", ["nearest", "longest_queue", "best_skill"])
def test_who_comes_and_when_he_takes_over(rule):
    log = twins(HANDED, ("rule: nearest", f"rule: {rule}"))
    assert min(len(log.of(kind)) for kind in (FINISH, WALK, BREAK)) >= 4


def test_on_patrol_only_who_stands_there_takes_over():
    log = twins(HANDED, *PATROL)
    assert min(len(log.of(kind)) for kind in (FINISH, WALK, BREAK)) >= 4


def test_who_is_on_the_way_may_have_to_go_himself():
    """The breaks of the second are a minute after those of the first, and he is a minute away."""
    other = ("ben: {shift: early, walk: 1 m/s,", "ben: {shift: other, walk: 0.5 m/s, home: shed,")
    tea = "at_break: hand_over, breaks: {tea: {at: 06:06, lasts: 2 min}}"
    shift = ("  late: {", f"  other: {{from: 06:00, to: 06:30, {tea}}}\n  late: {{")
    assert len(twins(HANDED, other, shift, ("walk: 2 m/s, home: shed", "walk: 0.3 m/s, home: shed")).of(BREAK)) >= 4


def of(**more):
    none = dict.fromkeys(("workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns"), ())
    return SimpleNamespace(**{**none, **{what: range(n) for what, n in more.items()}})


@pytest.mark.parametrize("what", ["workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns"])
def test_more_than_there_are_numbers_for_is_refused(what):
    refuse_too_many(of(**{what: MOST_RANKS}))
    with pytest.raises(NotImplementedError, match=f"65,537 {what}, where it tells 65,536 apart"):
        refuse_too_many(of(**{what: MOST_RANKS + 1}))


def test_the_fast_engine_says_so_and_auto_takes_the_other(monkeypatch):
    made = plan(LIMITED)
    monkeypatch.setattr(run, "MOST_RANKS", 2)
    assert unsupported(made) == ["3 workers, where it tells 2 apart"]
    assert able_to("auto", made).engine == "simpy"
    with pytest.raises(NotFast, match="3 workers"):
        able_to("fast", made)


def test_ids_of_different_ranks_differ_up_to_the_last():
    last, ids = MOST_RANKS - 1, stream_id
    ends = [(one, two, three) for one in (0, last) for two in (0, last) for three in (0, last)]
    assert len({ids(purpose, *ranks) for purpose in (1, 13) for ranks in ends}) == 16


@entered
def _stream_at(floor: Floor, given: Given) -> int:
    return stream_of(floor, 1, 2, 3, given.n).id


def stream_at(floor, visit):
    return _stream_at(floor, n=visit)


def test_a_visit_beyond_is_an_error_and_not_another_stream():
    arena, floor = empty_floor()
    arena.freeze()
    assert stream_at(floor.address, MOST_RANKS - 1) & 0xFFFF == MOST_RANKS - 1
    with pytest.raises(OverflowError, match="65,536 visits"):
        stream_at(floor.address, MOST_RANKS)


def test_a_plan_with_a_plug_in_rule_is_refused_in_the_words_of_unsupported(tmp_path, monkeypatch):
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    made = plan(queue(horizon="1 h").replace("oldest_job", "mine"))
    with pytest.raises(NotImplementedError) as refused:
        run_plan(made)
    assert [str(refused.value)] == unsupported(made)
