"""Every second of every worker is accounted for, with a place; a hole, a jump or a place that is missing is found."""

from pathlib import Path

import numpy as np
import pytest
from plans import plan, ran

from opsim.history import NOWHERE, unaccounted, whereabouts
from opsim.log import EventLog

TEXT = """
opsim: 1
name: places
run: {start: Mon 06:00, horizon: 5 h}
layout: {places: {in: [0 m, 0 m], bench: [60 m, 0 m], canteen: [0 m, 90 m]}}
shifts: {day: {from: 06:30, to: 10:00, breaks: {tea: {at: 08:00, lasts: 15 min, place: canteen}}}}
tasks: {t: {dist: lognormal, mean: 90 s, cv: 0.3}}
stations: {a: {at: in, tasks: [t]}, b: {at: bench, tasks: [t], buffer: 5}}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 4 min}
workers: {ana: {shift: day, skills: {a: 1.0, b: 1.0}}, ben: {skills: {b: 1.0}}}
"""


@pytest.fixture(scope="module")
def run():
    return ran(TEXT)


def changed(log, row, **values):
    columns = {name: column.copy() for name, column in log.columns.items()}
    for name, value in values.items():
        columns[name][row] = value
    return EventLog(log.replication, log.horizon_s, columns, log.names)


def test_the_whereabouts_of_a_worker_cover_the_run_and_hang_together(run):
    log, p = run
    assert list(unaccounted(log, p)) == []
    seen = whereabouts(log, p)
    for rank in range(2):
        own = seen.worker == rank
        assert (seen.end_s - seen.start_s)[own].sum() == p.horizon_s
    assert seen.start_s.size == seen.row.size == np.unique(seen.row).size


def test_who_is_off_is_nowhere_and_who_rests_in_the_canteen_is_there(run):
    log, p = run
    seen = whereabouts(log, p)
    kinds = np.array(log.names["kind"])[seen.kind]
    assert set(seen.place_from[kinds == "off"]) == {NOWHERE}
    assert p.places.index("canteen") in seen.place_from[kinds == "break"]
    assert np.all(seen.place_from[kinds != "off"] >= 0)


@pytest.mark.parametrize("kind", ["work", "walk", "wait", "off", "break"])
def test_a_row_that_is_missing_is_found(run, kind):
    log, p = run
    row = np.flatnonzero((log["kind"] == log.names["kind"].index(kind)) & (log["worker"] == 0))[0]
    (complaint, *_) = unaccounted(log.where(np.arange(len(log)) != row), p)
    assert complaint.startswith("worker ana: nothing is known of him from ")


def test_two_things_at_once_are_found(run):
    log, p = run
    row = np.flatnonzero((log["kind"] == log.names["kind"].index("wait")) & (log["worker"] == 0))[1]
    (complaint, *_) = unaccounted(changed(log, row, start_s=log["start_s"][row] - 1), p)
    assert "two things at once" in complaint


def test_who_stands_somewhere_else_without_a_walk_is_found(run):
    log, p = run
    walk = np.flatnonzero((log["kind"] == log.names["kind"].index("walk")) & (log["worker"] == 0))[1]
    assert "and no walk led there from" in next(unaccounted(changed(log, walk, place_to=0, place_from=0), p))
    wait = np.flatnonzero((log["kind"] == log.names["kind"].index("wait")) & (log["worker"] == 0))[1]
    assert "at no place" in next(unaccounted(changed(log, wait, place_from=-1, place_to=-1), p))
    assert (
        "moves without a walk"
        in list(unaccounted(changed(log, wait, place_to=(log["place_from"][wait] + 1) % 3), p))[-1]
    )


def test_a_floor_without_workers_has_nothing_to_account_for():
    text = TEXT[: TEXT.index("workers:")].replace("cv: 0.3}", "cv: 0.3, automatic: true}")
    log, p = ran(text)
    assert list(unaccounted(log, plan(text))) == [] and whereabouts(log, p).row.size == 0


@pytest.mark.parametrize("variant", ["base", "flu"])
def test_every_second_of_everybody_in_the_shipped_plant_is_accounted_for(variant):
    from opsim.engine.floor import run_plan
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    plant = Path(__file__).parents[2] / "scenarios/two_shift_plant.yaml"
    p = compile_plan(read_scenarios(plant, [variant])[variant])
    log = run_plan(p)
    seen = whereabouts(log, p)
    assert list(unaccounted(log, p)) == [] and len(p.workers) == 18
    assert (seen.end_s - seen.start_s).sum() == 18 * p.horizon_s
