"""Set-ups: what each server did last, whoever has it, as SimPy's engine keeps it."""

from twins import twins

from opsim.log import SETUP, SPLIT, WORK

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
