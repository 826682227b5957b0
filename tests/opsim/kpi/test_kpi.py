"""Figures of a log small enough to check by hand, and laws on a run."""

import time
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.floor.run import run_plan
from opsim.kpi import KPIS, figures, samples
from opsim.kpi.catalogue import CATALOGUE, DECLARED, KINDS, LESS, MORE, USUAL, better_of, read_asked, subject_of
from opsim.kpi.catalogue import AskedFigure as Asked
from opsim.log import BLOCKED, CREATE, FINISH, HELD, IDLE, QUEUE, WAIT, WALK
from opsim.subjects.exposure.plan import Handling
from tests.opsim.kpi.made_logs import found, made, row, tiled, work
from tests.opsim.made_walks import walking

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


@pytest.fixture(scope="module")
def by_hand():
    """One job: queue 0-10, work at s1 10-30, blocked 30-40, work at s2 50-70; the worker walks 40-50 in between."""
    p = plan(HAND)
    rows = [
        row(CREATE, 0, 0, job=0),
        row(QUEUE, 0, 10, station=0, job=0),
        row(WAIT, 0, 10, worker=0, places=(0, 0), cause=IDLE),
        work(10, 30, 0, worker=0, k=0),
        row(BLOCKED, 30, 40, station=0, job=0),
        row(WAIT, 30, 40, worker=0, places=(0, 0), cause=IDLE),
        row(WALK, 40, 50, worker=0, station=1, places=(0, 1), job=0),
        work(50, 70, 1, worker=0, k=1),
        row(FINISH, 70, 70, job=0),
        row(WAIT, 70, 100, worker=0, places=(1, 1), cause=IDLE),
    ]
    return found(made(rows, p), p)


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


def test_jobs_wait_in_the_buffer_and_on_the_server_for_a_worker():
    p = plan(HAND)
    values = found(made([row(QUEUE, 10, 50, station=1, job=0), row(HELD, 50, 60, station=1, job=0)], p), p)
    assert values["queue_length", "s2", ""] == 40 / 80
    assert values["station_states", "s2", "waiting"] == 10 / 80
    assert values["station_states", "s2", "starved"] == 70 / 80


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


PEOPLE = """
opsim: 1
name: people
run: {start: Mon 06:00, horizon: 30 min}
layout: {places: {p1: [0 m, 0 m], p2: [1 m, 0 m], p3: [9 m, 0 m], p4: [10 m, 0 m]}}
shifts: {day: {from: 06:00, to: 14:00}}
tasks: {t: {fixed: 20 s}}
stations:
  s1: {at: p1, tasks: [t], buffer: 1}
  s2: {at: p2, tasks: [t]}
  s3: {at: p3, tasks: [t]}
  s4: {at: p4, tasks: [t]}
products: {crewed: {route: [s1, s2]}, paced: {route: [s3, s4]}}
sources: {one: {kind: saturated, products: [crewed]}, other: {kind: poisson, every: 2 min, products: [paced]}}
crews: {crew: {kind: bucket_brigade, stations: [s1, s2], workers: [ana, ben]}}
lines: {line: {kind: indexed, stations: [s3, s4], takt: 60 s, unfinished: send_on}}
workers:
  ana: {shift: day, skills: {s1: 1.0, s2: 1.0}}
  ben: {skills: {s1: 1.2, s2: 1.2}}
  cem: {skills: {s3: 1.0, s4: 1.0}}
  dan: {skills: {s4: 1.0}}
human:
  learning: {model: wright}
  fatigue: {model: lffrm}
  rest: {above: 0.5, until: 0.2}
"""


def test_every_name_a_scenario_may_ask_for_is_computed():
    """Walks by a cell with an emulator of walking, the blocks of the station model by the shipped plant, and hours, a
    crew, a paced line and people who learn, tire and rest by a small floor; the cell's tasks have a load.
    """
    cell = walking(plan(CELL))
    cell = replace(cell, tasks=tuple(replace(task, handling=Handling(load_kg=5.0)) for task in cell.tasks))
    plant = replace(shipped("pump_plant.yaml"), horizon_s=7200.0)
    asked = {cell: KPIS, plant: (), plan(PEOPLE): ()}
    named = {figure.kpi for p, kpis in asked.items() for figure in figures(run_plan(p), p, kpis)}
    assert named == set(KPIS)


def shipped(name):
    """The plan of a scenario that comes with opsim."""
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    return compile_plan(next(iter(read_scenarios(Path(__file__).parents[3] / "scenarios" / name).values())))


def test_samples_average_to_their_figures():
    p = plan(CELL)
    log = run_plan(p)
    means = found(log, p)
    for (kpi, subject), values in samples(log, p).items():
        assert np.mean(values) == pytest.approx(means[kpi, subject, ""])


def test_nothing_finished_is_nan_and_not_an_error():
    p = plan(HAND.replace("{fixed: 10 s}", "{fixed: 1 h}"))
    values = found(run_plan(p), p)
    assert np.isnan(values["time_in_system_s", "", ""])
    assert values["throughput_per_h", "", ""] == 0


def repeated(text, times):
    """The log of a run repeated after itself, and the plan with a window as long."""
    p = plan(text)
    log = tiled(run_plan(p), times)
    return log, replace(p, horizon_s=log.horizon_s, warm_up_s=0.0)


def test_a_log_after_itself_has_the_same_shares_and_all_its_metres():
    text = CELL.replace("warm_up: 10 min", "warm_up: 0 s")
    once, thrice = (found(*repeated(text, times)) for times in (1, 3))
    shares = [key for key in once if key[0] in ("worker_states", "station_states", "queue_length", "oee", "oee_factor")]
    assert len(shares) > 40
    assert [thrice[key] for key in shares] == pytest.approx([once[key] for key in shares], nan_ok=True)
    for key in (key for key in once if key[0] == "walked_m"):
        assert thrice[key] == pytest.approx(3 * once[key])


def test_every_figure_has_words_in_the_report():
    assert set(CATALOGUE) == set(KPIS)
    assert set(USUAL) <= set(KPIS)


@pytest.mark.slow
@pytest.mark.parametrize("text", [CELL, line(10, 3, horizon="3000 s")], ids=["cell", "line"])
def test_a_million_rows_take_seconds(text, capsys):
    """About 0.2 to 0.4 s of CPU time; ten times that would be a loop over rows somewhere."""
    log, p = repeated(text, 1_000_000 // len(run_plan(plan(text))) + 1)
    started_s = time.process_time()
    n = len(figures(log, p))
    spent_s = time.process_time() - started_s
    with capsys.disabled():
        print(f"\n{n} figures of {len(log):,} rows: {spent_s:.2f} s")
    assert spent_s < 4


@pytest.mark.parametrize(
    "text, kpi, subject, part, better",
    [
        ("throughput_per_h", "throughput_per_h", "", "", MORE),
        (" rula_from_5_min_per_h/ana ", "rula_from_5_min_per_h", "ana", "", LESS),
        ("rula_from_5_min_per_h//at_most", "rula_from_5_min_per_h", "", "at_most", LESS),
        ("more worker_states/ana/wait", "worker_states", "ana", "wait", MORE),
        ("less  throughput_per_h", "throughput_per_h", "", "", LESS),
        ("worker_states/ana/work", "worker_states", "ana", "work", ""),
        ("trunk_flexion_share/ana/below_20", "trunk_flexion_share", "ana", "below_20", ""),
    ],
)
def test_a_figure_is_read_with_its_subject_its_part_and_the_way_that_is_better(text, kpi, subject, part, better):
    asked = read_asked(text)
    assert (asked.kpi, asked.subject, asked.part, asked.better) == (kpi, subject, part, better)


def test_what_is_read_is_written_as_it_was():
    for subject, part in product(("", "ana"), ("", "at_most")):
        asked = Asked("walked_m", subject, part)
        again = read_asked(asked.name)
        assert (again.kpi, again.subject, again.part) == (asked.kpi, asked.subject, asked.part)


def test_every_figure_is_declared_once_in_words_that_are_known():
    assert len(CATALOGUE) == len(DECLARED) == len({one.title for one in DECLARED})
    assert {one.better for one in DECLARED} == {MORE, LESS, ""} and {one.kind for one in DECLARED} == set(KINDS)
    assert all(better_of(name) == one.better for name, one in CATALOGUE.items())


def test_what_depends_on_who_asks_has_no_better_way():
    assert better_of("on_duty_h") == better_of("station_states") == better_of("posture_measured_share") == ""


def test_what_is_of_one_thing_each_is_of_something_that_a_floor_has():
    things = {"worker", "station", "task", "product", "store", "conveyor", "line", "tool"}
    assert {one.of for one in DECLARED} == {*things, ""}


def test_what_is_of_the_whole_too_needs_no_subject():
    assert subject_of("queue_length") == "station" and subject_of("throughput_per_h") == ""
