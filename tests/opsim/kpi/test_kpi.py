"""Figures of a log small enough to check by hand, and laws on a run."""

from math import nan

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.simpy_engine import run_plan
from opsim.kpi import KPIS, figures, samples
from opsim.log import BLOCKED, CREATE, FINISH, IDLE, QUEUE, WAIT, WALK, WORK, event_log, names_of

HAND = """
opsim: 1
name: by hand
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {a: [0 m, 0 m], b: [10 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {s1: {at: a, tasks: [t], buffer: 1}, s2: {at: b, tasks: [t], buffer: 0}}
products: {p: {route: [s1, s2]}}
release: {kind: saturated}
workers: {w: {skills: {s1: 1.0, s2: 1.0}}}
"""


def row(
    kind, start, end, *, worker=-1, station=-1, places=(-1, -1), job=-1, task=-1, k=-1, progress=(nan, nan), cause=0
):
    named = job >= 0
    return (
        *(
            kind,
            start,
            end,
            worker,
            station,
            *places,
            0 if named else -1,
            job,
            0 if named else -1,
            station if named else -1,
        ),
        *(task, k, k, *progress, 0.0, cause),
    )


@pytest.fixture(scope="module")
def by_hand():
    """One job: queue 0-10, work at s1 10-30, blocked 30-40, work at s2 50-70; the worker walks 40-50 in between."""
    p = plan(HAND)
    rows = [
        row(CREATE, 0, 0, job=0),
        row(QUEUE, 0, 10, station=0, job=0),
        row(WAIT, 0, 10, worker=0, places=(0, 0), cause=IDLE),
        row(WORK, 10, 30, worker=0, station=0, job=0, task=0, k=0, progress=(0.0, 1.0)),
        row(BLOCKED, 30, 40, station=0, job=0),
        row(WAIT, 30, 40, worker=0, places=(0, 0), cause=IDLE),
        row(WALK, 40, 50, worker=0, station=1, places=(0, 1), job=0),
        row(WORK, 50, 70, worker=0, station=1, job=0, task=0, k=1, progress=(0.0, 1.0)),
        row(FINISH, 70, 70, job=0),
        row(WAIT, 70, 100, worker=0, places=(1, 1), cause=IDLE),
    ]
    log = event_log(rows, 100.0, names_of(p))
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("throughput_per_h", "", "", 3600 / 80),
        ("time_in_system_s", "", "", 70),
        ("work_in_progress", "", "", 50 / 80),
        ("worker_states", "w", "work", 30 / 80),
        ("worker_states", "w", "walk", 10 / 80),
        ("worker_states", "w", "wait", 40 / 80),
        ("station_states", "s1", "work", 10 / 80),
        ("station_states", "s1", "blocked", 10 / 80),
        ("station_states", "s1", "starved", 60 / 80),
        ("station_states", "s2", "work", 20 / 80),
        ("walked_m", "w", "", 10),
        ("cycle_time_s", "s1", "", 20),
        ("cycle_time_s", "s2", "", 20),
        ("duration_s", "t", "", 20),
        ("queue_length", "s1", "", 0),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected)


@pytest.mark.parametrize("text", [CELL, CELL.replace("held", "free"), line(4, 1, horizon="3000 s")])
def test_states_sum_to_one(text):
    p = plan(text)
    sums: dict[tuple[str, str], float] = {}
    for figure in figures(run_plan(p), p):
        if figure.kpi.endswith("_states"):
            assert figure.value >= -1e-12
            sums[figure.kpi, figure.subject] = sums.get((figure.kpi, figure.subject), 0.0) + figure.value
    assert len(sums) == len(p.workers) + len(p.stations)
    assert list(sums.values()) == pytest.approx([1.0] * len(sums), abs=1e-12)


def test_every_name_a_scenario_may_ask_for_is_computed():
    p = plan(CELL)
    assert {figure.kpi for figure in figures(run_plan(p), p)} == set(KPIS)


def test_samples_average_to_their_figures():
    p = plan(CELL)
    log = run_plan(p)
    means = {(f.kpi, f.subject): f.value for f in figures(log, p)}
    for (kpi, subject), values in samples(log, p).items():
        assert np.mean(values) == pytest.approx(means[kpi, subject])


def test_nothing_finished_is_nan_and_not_an_error():
    p = plan(HAND.replace("{fixed: 10 s}", "{fixed: 1 h}"))
    found = {f.kpi: f.value for f in figures(run_plan(p), p) if not f.subject}
    assert np.isnan(found["time_in_system_s"])
    assert found["throughput_per_h"] == 0
