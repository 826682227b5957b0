"""Disassembly: pieces on one server, as SimPy's engine has them."""

from twins import twins

from opsim.log import BAD, CREATE, FINISH, SPLIT

SAW = """
opsim: 1
name: saw
run: {horizon: 900 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 12 s}, plane: {fixed: 4 s, automatic: true}, press: {fixed: 5 s}}
stations:
  saw: {at: here, tasks: [cut], servers: 2, buffer: 2MORE}
  plane: {at: here, tasks: [plane], buffer: 0}
  press: {at: here, tasks: [press], buffer: 1}
products:
  log: {route: [saw], lot: 2, split: {saw: {board: 3, dust: 1}}}
  beam: {route: [saw, press]}
  board: {route: [plane], lot: 4}
  dust: {route: [press], split: {press: {grain: 2}}}
  grain: {route: [plane]}
sources:
  logs: {kind: poisson, every: 25 s, products: [log, beam]}
  others: {kind: poisson, every: 90 s, products: [log]}
workers: {w1: {skills: {saw: 1.0, press: 1.0}}, w2: {skills: {saw: 1.0}}}
"""


def saw(more=""):
    return SAW.replace("MORE", more)


def test_pieces_share_a_server_and_are_split_again():
    log = twins(saw())
    assert len(log.of(SPLIT)) > 30 and len(log.of(CREATE)) > 100 and len(log.of(FINISH)) > 50


def test_jobs_of_a_batch_are_split_where_they_stand():
    log = twins(saw(", batch: {size: 2, most_wait: 40 s}"))
    assert len(log.of(SPLIT)) > 20


def test_pieces_go_behind_the_station_where_there_is_room():
    log = twins(saw(", buffer_after: 3"))
    assert len(log.of(SPLIT)) > 30


def test_pieces_of_a_bad_job_are_bad():
    log = twins(saw(", yield: 0.7"))
    assert len(log.of(SPLIT)) > 30 and BAD in log.of(FINISH)["cause"]
