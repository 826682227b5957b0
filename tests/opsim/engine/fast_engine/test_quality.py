"""Defects, inspection, scrap and rework: the same jobs are spoiled, found and sent back as in SimPy's engine."""

from twins import twins

from opsim.log import BAD, FALSE_ALARM, FINISH, REWORK, SCRAP

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
