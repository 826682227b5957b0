"""A shop where everything stops that can: the laws hold, and neither order nor neighbours decide anything."""

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import DOWN, FINISH, HELD, IS_DOWN, REPAIR, SCRAP, WORK, EventLog

SHOP = """
opsim: 1
name: shop
run: {horizon: 4000 s, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 2 m]}}
tasks:
  load: {dist: lognormal, mean: 8 s, cv: 0.4}
  cut: {dist: gamma, mean: 15 s, cv: 0.5, automatic: true}
  pack: {dist: uniform, low: 5 s, high: 15 s, repeat: 2}
stations:
  mill:
    at: b
    tasks: [load, cut]
    buffer: 2
    breakdowns:
      stop: {every: {dist: exponential, mean: 60 s}, repair: {fixed: 4 s}}
      crash: {every: {dist: exponential, mean: 300 s}, by: busy, repair: {dist: gamma, mean: 60 s, cv: 1}, JOB}
  saw:
    at: a
    tasks: [load, cut]
    servers: 2
    buffer: 2
    breakdowns:
      jam: {every: {dist: exponential, mean: 90 s}, by: busy, repair: {dist: exponential, mean: 25 s}, team: crew}
      blade: {every: {dist: uniform, low: 8, high: 15}, by: cycles, repair: {fixed: 30 s}, team: crew, job: restart}
    maintenance: {oil: {every: 400 s, first: 100 s, lasts: {dist: uniform, low: 10 s, high: 50 s}, team: crew}}
  pack:
    at: c
    tasks: [pack]
    servers: 2
    buffer: 3
    maintenance: {clean: {every: 500 s, lasts: 20 s, when: at_once}, check: {every: 300 s, lasts: 9 s}}
products:
  x: {share: 0.6, route: [saw, mill, pack]}
  y: {share: 0.4, route: [[mill, saw], pack]}
release: {kind: poisson, every: 25 s}
repair_teams: {crew: {n: 1}}
workers:
  ana: {skills: {saw: 1.0, mill: 1.0}}
  ben: {skills: {saw: 0.9, pack: 1.1}}
  cai: {skills: {mill: 1.2, pack: 0.8}}
""".replace("JOB", "team: crew, job: scrap")


def ran(text: str) -> EventLog:
    p = plan(text)
    log = run_plan(p)
    audit(log, p)
    return log


def named(log):
    """Rows with names for numbers, but those of performances."""
    text = {c: np.array([*log.names[c], ""], dtype=object)[log[c]] for c in log.names}
    asked = ("kind", "start_s", "end_s", "worker", "station", "job", "task", "k", "cause")
    return list(zip(*(map(str, text.get(c, log[c])) for c in asked)))


def in_a_row(rows) -> bool:
    """Whether rows do not overlap."""
    order = np.lexsort([rows["end_s"], rows["start_s"]])
    return bool(np.all(rows["start_s"][order][1:] >= rows["end_s"][order][:-1]))


@pytest.mark.parametrize("seed", range(4))
def test_the_laws_hold_whatever_stops(seed):
    log = ran(SHOP.replace("seed: 3", f"seed: {seed}"))
    assert len(set(log.of(REPAIR)["task"])) == 7
    assert len(log.of(DOWN)) > 2
    assert len(log.of(SCRAP)) > 1
    assert len(log.of(FINISH)) > 80


def test_a_station_has_one_stop_at_a_time_and_a_team_of_one_is_at_one_station():
    log = ran(SHOP)
    stops, repairs = log.of(DOWN, REPAIR), log.of(REPAIR)
    assert all(in_a_row(stops.where(stops["station"] == rank)) for rank in range(3))
    whose = np.isin(np.array(log.names["task"])[repairs["task"]], ["saw: jam", "saw: blade", "saw: oil", "mill: crash"])
    assert whose.sum() > 20
    assert in_a_row(repairs.where(whose))


def test_nothing_is_in_work_where_a_station_stands():
    log = ran(SHOP)
    for rank in range(3):
        stops, work = (rows.where(rows["station"] == rank) for rows in (log.of(DOWN, REPAIR), log.of(WORK)))
        ends = np.minimum(stops["end_s"][:, None], work["end_s"])
        assert (ends - np.maximum(stops["start_s"][:, None], work["start_s"])).max() <= 0
        held = log.of(HELD)
        assert ((held["cause"] == IS_DOWN) & (held["station"] == rank)).sum() > 5


def test_declaration_order_decides_nothing():
    head, tail = SHOP.split("  mill:\n    at", 1)
    mill, rest = tail.split("  saw:\n", 1)
    saw, rest = rest.split("  pack:\n    at", 1)
    stop, crash = (line for line in mill.split("\n") if line.startswith("      "))
    mill = mill.replace(f"{stop}\n{crash}", f"{crash}\n{stop}")
    swapped = f"{head}  saw:\n{saw}  mill:\n    at{mill}  pack:\n    at{rest}"
    assert sorted(swapped) == sorted(SHOP)
    assert swapped != SHOP
    assert named(ran(swapped)) == named(ran(SHOP))


def test_a_stop_more_at_one_station_leaves_the_luck_of_the_others():
    """Uptimes by the clock and repairs without a team depend on nothing else."""

    def stops(log):
        return [row for row in named(log.of(REPAIR)) if row[6] == "mill: stop"]

    free = SHOP.replace("      crash", "      #")
    more = free.replace(
        "maintenance: {clean",
        "breakdowns: {jam: {every: 5, by: cycles, repair: {fixed: 40 s}}}\n    maintenance: {clean",
    )
    assert more.count("jam:") == 2
    assert stops(ran(free)) == stops(ran(more))
    assert named(ran(free)) != named(ran(more))


def test_interrupted_work_is_done_exactly_once_by_whoever_does_it():
    log = ran(SHOP.replace("job: scrap", "job: resume").replace("job: restart", "job: resume"))
    work, done = log.of(WORK), log.of(FINISH)["job"]
    assert np.sum(work["progress_to"] < 1) > 20
    share = work["progress_to"] - work["progress_from"]
    for rank, performances in enumerate((2, 2, 2)):  # load and cut; pack twice
        here = (work["station"] == rank) & np.isin(work["job"], done)
        jobs, whose = np.unique(work["job"][here], return_inverse=True)
        assert len(jobs) > 20
        assert np.bincount(whose, weights=share[here]) == pytest.approx(np.full(len(jobs), performances), abs=1e-5)
