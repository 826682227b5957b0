"""Set-ups: what each server did last, whoever has it, as SimPy's engine keeps it.

Defects, inspection, scrap and rework: the same jobs are spoiled, found and sent back as in SimPy's engine.

Batches: who goes with whom and when, as SimPy's engine puts them together.

Who is called to jobs of a line in the compiled engine: he takes over, or helps, or has to go before he is there.

Stops of stations on both engines: what they interrupt, who sees to them, what happens with them at one instant.

Jobs that take servers from others, on both engines.
"""

import pytest
from twins import twins

from opsim.log import (
    BAD,
    BATCH,
    BLOCKED,
    BREAK,
    DOWN,
    FALSE_ALARM,
    FINISH,
    HELD,
    NO_WORKER,
    PREEMPTED,
    QUEUE,
    REPAIR,
    REWORK,
    SCRAP,
    SENT_ON,
    SETUP,
    SPLIT,
    WALK,
    WORK,
)

SHOP = """
opsim: 1
name: set-ups
run: {horizon: 1500 s, seed: 2}
layout: {places: {hall: [0 m, 0 m], far: [5 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 6 s}, wash: {fixed: 2 s, repeat: 3}, look: {fixed: 3 s}}
stations:
  saw: {at: hall, tasks: [cut], servers: 3, buffer: 6MORE, setup: {times: {a: {b: wash}, c: {a: 5 s}}, otherwise: 4 s}}
  end: {at: far, tasks: [look], buffer: 1}
products: {a: {route: [saw, end]}, b: {route: [saw, end], priority: 1}, c: {route: [saw, end]}}
sources: {jobs: {kind: poisson, every: 5 s, products: [a, b, c]}}
workers: {eve: {skills: {saw: 2.0}}, bob: {skills: {saw: 1.0, end: 1.0}}, joe: {skills: {end: 1.0, saw: 0.5}}}
"""


def shop(more):
    return SHOP.replace("MORE", more)


def test_the_free_server_with_the_shortest_set_up_is_taken():
    assert len(twins(shop("")).of(SETUP)) > 50


def test_the_queue_is_served_by_what_a_free_server_needs():
    assert len(twins(shop(", dispatch: least_setup")).of(SETUP)) > 30


def test_a_job_that_lost_its_server_has_its_work_before_it_again_after_the_set_up():
    assert len(twins(shop(", preempt: resume")).of(SETUP)) > 50
    assert len(twins(shop(", preempt: restart")).of(SETUP)) > 50


def test_jobs_of_a_batch_have_one_server_and_one_set_up():
    assert len(twins(shop(", batch: {size: 2, of: product, most_wait: 20 s}")).of(SETUP)) > 20


def test_pieces_stand_on_a_server_that_stays_set_up_as_it_is():
    more = ("c: {route: [saw, end]}", "c: {route: [saw], split: {saw: {d: 2}}}, d: {route: [end]}")
    log = twins(shop(""), more)
    assert len(log.of(SETUP)) > 30 and len(log.of(SPLIT)) > 10


def test_what_comes_to_a_station_for_rework_alone_is_of_the_last_class_there():
    text = shop("").replace("buffer: 1}", "buffer: 1, inspect: {finds: 0.9, false_alarms: 0.3, then: {rework: fix}}}")
    fix = "  fix: {at: far, tasks: [look], buffer: 2, setup: {otherwise: 4 s, first: a}}\n"
    text = text.replace("products:", f"{fix}products:", 1).replace("end: 1.0", "end: 1.0, fix: 1.0")
    log = twins(text)
    assert (log.of(WORK)["station"] == log.names["station"].index("fix")).sum() > 5


LINE = """
opsim: 1
name: quality
run: {horizon: 1 h, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [6 m, 0 m]}}
tasks: {make: {fixed: 20 s}, look: {fixed: 10 s}, mend: {fixed: 15 s}}
stations:
  press: {at: a, tasks: [make], servers: 2, buffer: 2, yield: 0.8}
  check: {at: b, tasks: [look], buffer: 9, inspect: {finds: 0.9, false_alarms: 0.1, then: {rework: solder}, most: 2}}
  solder: {at: c, tasks: [mend], buffer: 9, yield: 0.7}
products: {part: {share: 0.6, route: [press, check]}, box: {share: 0.4, route: [solder, press, check]}}
sources: {one: {kind: poisson, every: 50 s}, two: {kind: poisson, every: 50 s, products: [box]}}
workers: {w1: {skills: {press: 1.0}}, w2: {skills: {check: 1.0, press: 1.0}}, w3: {skills: {solder: 1.0}}}
"""


def n_rows(log, kind, cause):
    return len(log.where((log["kind"] == kind) & (log["cause"] == cause)))


def test_chance_spoils_and_finds_the_same_jobs():
    log = twins(LINE)
    assert n_rows(log, REWORK, BAD) > 10 and n_rows(log, REWORK, FALSE_ALARM) > 2
    assert n_rows(log, SCRAP, BAD) > 1 and n_rows(log, FINISH, BAD) > 1


def test_another_replication_has_other_luck():
    assert twins(LINE, replication=1).of(REWORK)["job"].tolist() != twins(LINE).of(REWORK)["job"].tolist()


def test_what_workers_leave_wrong_counts_by_the_worst_of_those_who_worked_on_it():
    levels = "skill_levels: {learner: {pace: 0.8, quality: 0.7}, expert: {pace: 1.2, quality: 0.95}}\n"
    log = twins(
        LINE + levels,
        ("w1: {skills: {press: 1.0}}", "w1: {skills: {press: learner}}"),
        ("w2: {skills: {check: 1.0, press: 1.0}}", "w2: {skills: {check: 1.0, press: expert}}"),
        ("tasks: [make]", "tasks: [make, look]"),
    )
    assert n_rows(log, REWORK, BAD) > 20


def test_of_a_batch_each_has_its_own_luck():
    log = twins(LINE, ("servers: 2, buffer: 2, yield: 0.8", "buffer: 4, batch: {size: 3, most_wait: 60 s}, yield: 0.8"))
    assert n_rows(log, REWORK, BAD) > 10


def test_a_place_that_was_kept_is_given_back_by_what_is_turned_down():
    log = twins(
        LINE,
        ("at: b, tasks: [look]", "at: b, blocking: before, tasks: [look]"),
        ("route: [press, check]}, box", "route: [press, check, press]}, box"),
    )
    assert len(log.of(REWORK)) > 10


OVEN = """
opsim: 1
name: oven
run: {horizon: 2000 s, seed: 8}
layout: {places: {here: [0 m, 0 m]}}
tasks: {bake: {dist: exponential, mean: 30 s, automatic: true}, load: {fixed: 5 s}}
stations:
  load: {at: here, tasks: [load], servers: 2, buffer: 3}
  oven: {at: here, tasks: [load, bake], servers: 2, buffer: 12, batch: {size: 4, of: product, most_wait: 60 s}}
products:
  a: {route: [load, oven], family: x, due: 200 s}
  b: {route: [load, oven], family: x, priority: 1}
  c: {route: [load, oven, load], due: 90 s, lot: 3}
sources: {jobs: {kind: poisson, every: 9 s, products: [a, b, c]}}
flow: {dispatch: fifo}
workers: {w1: {skills: {load: 1.0, oven: 1.0}}, w2: {skills: {load: 1.0}}}
"""


@pytest.mark.parametrize("of", ["any", "product", "family"])
def test_jobs_of_a_class_go_together(of):
    log = twins(OVEN, ("of: product", f"of: {of}"))
    assert (log.of(HELD)["cause"] == BATCH).sum() > 30 and (log.of(QUEUE)["cause"] == BATCH).sum() > 30


@pytest.mark.parametrize("rule", ["edd", "critical_ratio", "downstream_first"])
def test_a_rule_says_who_of_the_queue_goes_first(rule):
    assert len(twins(OVEN, ("dispatch: fifo", f"dispatch: {rule}")).of(WORK)) > 200


def test_batches_that_are_full_alone_wait_for_ever():
    assert len(twins(OVEN, (", most_wait: 60 s", "")).of(WORK)) > 200


LINES = """
opsim: 1
name: called
run: {start: Mon 06:00, horizon: 3000 s, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {t1: {dist: lognormal, mean: 50 s, cv: 0.4}, t2: {dist: lognormal, mean: 50 s, cv: 0.4}}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2, t2]}, r1: {at: a, tasks: [t1]}, r2: {at: b, tasks: [t2]}}
lines:
  indexed: {kind: indexed, stations: [s1, s2], takt: 70 s, unfinished: UNFINISHED, andon: ANDON}
  moving: {kind: moving, stations: [r1, r2], takt: 60 s, unfinished: UNFINISHED, andon: ANDON, length: 6 m, drift: 1 m,
           upstream: 2 m}
products: {x: {route: [s1, s2], share: 0.5}, y: {route: [r1, r2], share: 0.5}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, at_break: RULE, breaks: BREAKS}}
workers:
  w1: {walk: 1 m/s, skills: {s1: 1.0, r1: 1.0}}
  w2: {walk: 1 m/s, shift: early, skills: {s2: 1.0, r2: 1.0}}
  w3: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0, r1: 0.8, r2: 0.8}}
  joker: {walk: 0.5 m/s, home: b, shift: early, skills: {s1: 1.5, s2: 2.0, r1: 1.0, r2: 1.0}}
  other: {walk: 1 m/s, home: a, skills: {s1: 1.0, r2: 2.0}}
"""
BREAKS = ", ".join(f"b{n}: {{at: '06:{2 + 4 * n:02d}', lasts: 100 s}}" for n in range(11))


JAMS = ("s2: {at: b, tasks: [t2, t2]}", "s2: {at: b, tasks: [t2, t2], breakdowns: {jam: JAM}}")
JAM = "{every: {fixed: 90 s}, repair: {fixed: 10 s}, job: resume}"


def of_both(does, unfinished="send_on", rule="resume_any", edits=()):
    text = LINES.replace("ANDON", f"{{workers: [joker, other], at: 30 s, does: {does}}}").replace("RULE", rule)
    return twins(text.replace("UNFINISHED", unfinished).replace("BREAKS", f"{{{BREAKS}}}"), *edits)


@pytest.mark.parametrize("rule", ["finish", "hand_over", "resume", "restart"])
@pytest.mark.parametrize("does", ["help", "take_over"])
def test_who_is_called_is_there_for_both_lines_alike(does, rule):
    log = of_both(does, rule=rule)
    joker = log.names["worker"].index("joker")
    for kind, least in ((WORK, 5), (WALK, 5), (BREAK, 8)):
        assert (log.of(kind)["worker"] == joker).sum() >= least


@pytest.mark.parametrize("does", ["help", "take_over"])
def test_lines_that_stop_until_who_was_called_is_done_go_on_alike(does):
    assert of_both(does, "stop").of(SENT_ON)["job"].size == 0


def test_work_of_two_that_is_broken_off_goes_on_alone_alike():
    log = of_both("help", "stop", edits=(JAMS, ("JAM}", JAM + "}")))
    pieces = log.of(WORK).where(log.of(WORK)["progress_from"] > 0)
    assert (pieces["station"] == log.names["station"].index("s2")).sum() > 20


ONE = """
opsim: 1
name: shop
run: {horizon: 400 s, seed: 5}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 9 s, automatic: true}, trim: {fixed: 4 s, automatic: true}}
stations:
  m: {at: hall, tasks: [press], buffer: 3, servers: 1, STOPS}
  n: {at: hall, tasks: [trim], buffer: 1, breakdowns: {jam: {every: {fixed: 30 s}, repair: {fixed: 6 s}, team: crew}}}
products: {part: {route: [m, n]}}
release: {kind: saturated}
repair_teams: {crew: {n: 1}}
"""
BROKEN = "STOPS", "breakdowns: {jam: {every: {fixed: 30 s}, repair: {fixed: 6 s}, team: crew, by: BY, job: JOB}}"
TWO_KINDS = (
    "STOPS",
    "breakdowns: {jam: {every: {dist: exponential, mean: 40 s}, repair: {dist: exponential, mean: 5 s}, team: crew}, "
    "die: {every: {dist: geometric, mean: 4}, by: cycles, repair: {fixed: 7 s}, job: restart}}, "
    "maintenance: {oil: {every: 50 s, lasts: 5 s, when: after_job}, wash: {every: 70 s, first: 30 s, lasts: 3 s}}",
)
BY_HAND = (
    ("press: {fixed: 9 s, automatic: true}", "press: {dist: exponential, mean: 9 s}"),
    ("trim: {fixed: 4 s, automatic: true}", "trim: {dist: exponential, mean: 4 s}"),
    ("repair_teams:", "workers: {ana: {skills: {m: 1.0, n: 1.0}}}\nrepair_teams:"),
)


@pytest.mark.parametrize("job", ["resume", "restart", "scrap"])
@pytest.mark.parametrize("by", ["clock", "busy"])
def test_two_stations_that_break_down_at_one_instant_wait_for_one_team(by, job):
    log = twins(ONE, BROKEN, ("BY", by), ("JOB", job))
    assert len(log.of(REPAIR)) > 8 and len(log.of(FINISH)) > 8
    assert len(log.of(DOWN)) > 0 or by == "busy"
    assert (len(log.of(SCRAP)) > 0) == (job == "scrap")


@pytest.mark.parametrize("replication", [0, 1])
def test_stops_of_all_kinds_follow_each_other_at_a_station_of_two_servers(replication):
    log = twins(ONE, TWO_KINDS, ("servers: 1", "servers: 2"), replication=replication)
    assert len(set(log.of(REPAIR)["task"].tolist())) == 5


@pytest.mark.parametrize("servers", ["servers: 1", "servers: 2"])
def test_workers_are_called_off_where_maintenance_waits_for_what_was_begun(servers):
    log = twins(ONE, TWO_KINDS, *BY_HAND, ("servers: 1", servers))
    assert NO_WORKER in log.of(HELD)["cause"]


def test_a_set_up_is_broken_off_and_goes_on_after_the_repair():
    log = twins(
        ONE,
        TWO_KINDS,
        *BY_HAND,
        ("buffer: 3,", "buffer: 3, setup: {otherwise: 6 s, attended: true, by: product},"),
        ("{part: {route: [m, n]}}", "{part: {route: [m, n], share: 0.5}, other: {route: [m], share: 0.5}}"),
    )
    assert len(log.of(SETUP)) > 10


def test_what_was_in_a_batch_on_a_server_that_breaks_down_is_scrap_together():
    log = twins(ONE, BROKEN, ("BY", "clock"), ("JOB", "scrap"), ("buffer: 3,", "buffer: 3, batch: {size: 2},"))
    assert len(log.of(SCRAP)) >= 2 and len(log.of(SCRAP)) % 2 == 0


def test_a_clock_stands_still_while_its_station_is_closed():
    shifts = "\nshifts: {a: {from: 00:00:20, to: 00:01:00}, b: {from: 00:01:40, to: 00:05:00}}\ntasks:"
    for at_close in ("resume", "finish"):
        hours = ("buffer: 3,", f"buffer: 3, shift: [a, b], at_close: {at_close},")
        log = twins(ONE, TWO_KINDS, hours, ("\ntasks:", shifts))
        assert len(log.of(REPAIR)) > 5


SAW = """
opsim: 1
name: saw
run: {horizon: 600 s, seed: 3}
layout: {places: {hall: [0 m, 0 m], far: [6 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 10 s, repeat: 2}, look: {fixed: 3 s}}
stations:
  saw: {at: hall, tasks: [cut, look], servers: 2, buffer: 6, preempt: HOW}
  end: {at: far, tasks: [look], buffer: 1}
products:
  low: {route: [saw, end], share: 0.5}
  mid: {route: [saw, end], share: 0.3, priority: 1}
  top: {route: [saw, end], share: 0.2, priority: 2}
release: {kind: poisson, every: 13 s}
workers:
  ana: {skills: {saw: 1.0, end: 1.0}, home: far, walk: 1 m/s}
  ben: {skills: {saw: 0.6}, home: far, walk: 2 m/s}
"""
AUTOMATIC = "repeat: 2}", "repeat: 2, automatic: true}"
SETUPS = "buffer: 6,", "buffer: 6, setup: {otherwise: 4 s, attended: true, by: product},"
JAMMED = (
    "buffer: 6,",
    "buffer: 6, breakdowns: {jam: {every: {dist: exponential, mean: 40 s}, repair: {fixed: 9 s}}},",
)


@pytest.mark.parametrize("how", ["resume", "restart"])
@pytest.mark.parametrize("edits", [(), (AUTOMATIC,), (SETUPS,), (JAMMED,), (SETUPS, JAMMED, AUTOMATIC)])
def test_servers_change_hands(how, edits):
    log = twins(SAW, ("HOW", how), *edits)
    assert PREEMPTED in log.of(QUEUE)["cause"]
    assert (len(log.of(SETUP)) > 0, len(log.of(REPAIR)) > 0) == (SETUPS in edits, JAMMED in edits)


def test_who_walks_to_a_job_that_lost_its_server_comes_all_the_same():
    log = twins(SAW, ("HOW", "resume"), ("[6 m, 0 m]", "[20 m, 0 m]"))
    assert len(log.of(WALK)) > 10 and PREEMPTED in log.of(QUEUE)["cause"]


def test_who_loses_the_server_loses_the_place_downstream_too():
    log = twins(SAW, ("HOW", "resume"), ("buffer: 6,", "buffer: 6, blocking: before,"))
    assert len(log.of(HELD)) and not len(log.of(BLOCKED)) and PREEMPTED in log.of(QUEUE)["cause"]
