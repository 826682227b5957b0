"""Figures of what bodies went through: by hand, their sums, one pass, and none with ``posture: off``."""

from dataclasses import replace

import numpy as np
import pytest
from plans import loaded, ran

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.options import Options
from opsim.ergonomics.shift.ledger import AT_MOST, BINS, Booking, Ledger
from opsim.kpi import figures
from opsim.kpi.catalogue import EXPOSURE, KPIS, POSTURE, SCORED, USUAL, headline, needs_postures
from opsim.log import OFF, WAIT, WORK
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.subjects.exposure import figures as exposure
from opsim.subjects.exposure.figures import LEVEL_KPIS as LEVELS
from opsim.subjects.exposure.figures import (
    bounds_of_level,
    exposure_levels,
    mean_score,
    measured_share,
    minutes,
    quantile,
)
from tests.opsim.ergonomics.made_work import BEND, COUNT, Bending, made_plan
from tests.opsim.ergonomics.shift.test_booking import frames, scores
from tests.opsim.kpi.made_logs import made, row, work

HOUR_S = 3600.0
CELL = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 50 min, warm_up: 5 min, seed: 3}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks: {stoop: {emulator: bench/stoop}, place: {emulator: bench/place}, label: {fixed: 4 s}}
stations: {low: {at: here, tasks: [stoop], buffer: 1}, high: {at: there, tasks: [place, label], buffer: 2}}
products: {p: {share: 0.5, route: [low, high]}, q: {share: 0.5, route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0, high: 1.0}}, ben: {skills: {low: 0.8, high: 1.2}}, cai: {skills: {high: 1.0}}}
"""


def of_levels(booking, log, plan):
    return {f[:3]: f.value for f in exposure_levels(booking, log, plan)}


def all_of(log, plan, asked=SCORED):
    return {f[:3]: f.value for f in figures(log, plan, asked)}


@pytest.fixture(scope="module")
def by_hand():
    """In two hours ana is for 6 min at RULA 3 to 5 and for 3 min at 7; ben, gone for one of them, for 3 min at 6."""
    plan = made_plan(horizon_s=2 * HOUR_S, start_s=6 * HOUR_S)
    booking = Booking(plan.start_s)
    ana = frames(0, [0, 600], [360, 180], [0, 0], [BEND, BEND], [0, 0], [10, 70], [[5, 5], [95, 5]])
    booking.add(ana, scores([[3, 5], [7, 7]], [[2, 9], [11, 12]], [[1, 3], [2, 2]]))
    ben = frames(1, [HOUR_S], [180], [0], [COUNT], [0], [25], [[65, 5]])
    booking.add(ben, scores([[6, 6]], [[4, 4]], [[4, 4]]))
    unknown = frames(1, [HOUR_S + 500], [60], [0], [COUNT], [0], [np.nan], [[np.nan, np.nan]])
    booking.add(unknown, scores([[0, 0]], [[0, 0]], [[0, 0]]))
    log = made([row(OFF, 0, HOUR_S, worker=1)], plan)
    share = {f[:3]: f.value for f in measured_share(booking, plan)}
    return of_levels(booking, log, plan) | share


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("rula_from_5_min_per_h", "ana", "", 3 / 2),
        ("rula_from_5_min_per_h", "ana", "at_most", 9 / 2),
        ("rula_from_5_min_per_h", "ben", "", 3),
        ("rula_from_5_min_per_h", "", "", 6 / 3),
        ("rula_from_5_min_per_h", "", "worst", 3),
        ("rula_from_7_min_per_h", "", "worst", 3 / 2),
        ("reba_from_8_min_per_h", "", "at_most", 9 / 3),
        ("owas_from_3_min_per_h", "", "", 3 / 3),
        ("arm_beyond_60_min_per_h", "", "", 6 / 3),
        ("arm_beyond_90_min_per_h", "", "", 3 / 3),
        ("rula_mean", "ana", "", (3 * 6 + 7 * 3) / 9),
        ("rula_mean", "", "at_most", (5 * 6 + 7 * 3 + 6 * 3) / 12),
        ("rula_p90", "ana", "", 7),
        ("rula_p90", "", "", 7),
        ("rula_most", "ben", "", 6),
        ("reba_p90", "ben", "", 4),
        ("reba_most", "", "worst", 11),
        ("posture_dose", "ana", "", (3 * 6 + 7 * 3) / 60),
        ("posture_dose", "", "", (3 * 6 + 7 * 3 + 6 * 3) / 60),
        ("exposure_gini", "", "rula_from_5", (3 - 1.5) / (2 * 4.5)),  # of two: difference over twice the sum
        ("exposure_gini", "", "rula_from_7", 0.5),
        ("exposure_by_station", "s1", "rula_from_5", 6 / 3),
        ("exposure_by_task", "bend", "rula_from_5", 3 / 3),
        ("exposure_by_task", "count", "rula_from_5", 3 / 3),
        ("exposure_by_product", "p", "trunk_beyond_20", 6 / 3),
        ("exposure_by_hour", "06:00", "rula_from_5", 3 / 1),
        ("exposure_by_hour", "07:00", "rula_from_5", 3 / 2),
        ("posture_measured_share", "ben", "", 0.75),
        ("posture_measured_share", "", "", 12 / 13),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected)


def test_automatic_tasks_are_nobody_s_exposure(by_hand):
    assert {subject for kpi, subject, _ in by_hand if kpi == "exposure_by_task"} == {"bend", "count"}


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    return log, plan, all_of(log, plan)


def test_every_figure_that_may_be_asked_for_is_there(cell):
    assert {kpi for kpi, *_ in cell[2]} >= set(SCORED)
    assert "posture_measured_share" in {kpi for kpi, *_ in cell[2]}


@pytest.mark.parametrize("by", ["station", "task", "product"])
@pytest.mark.parametrize("part", [name + end for name in LEVELS for end in ("", AT_MOST)])
def test_minutes_by_anything_sum_to_those_of_all(cell, by, part):
    *_, found = cell
    name = part.removesuffix(AT_MOST)
    whole = found.get((f"{name}_min_per_h", "", "at_most" if part != name else ""))
    parts = [value for (kpi, _, of), value in found.items() if (kpi, of) == (f"exposure_by_{by}", part)]
    if whole is not None and parts:
        assert sum(value for value in parts if not np.isnan(value)) == pytest.approx(whole, rel=1e-9)


def test_minutes_of_workers_and_of_hours_by_the_time_they_were_there_sum_to_those_of_all(cell):
    _, plan, found = cell
    of = {worker.name: found["rula_from_5_min_per_h", worker.name, ""] for worker in plan.workers}
    assert sum(of.values()) / 3 == pytest.approx(found["rula_from_5_min_per_h", "", ""], rel=1e-9)
    hours = [found["exposure_by_hour", hour, "rula_from_5"] for hour in ("06:00", "07:00")]
    assert (hours[0] * 25 + hours[1] * 20) / 45 == pytest.approx(found["rula_from_5_min_per_h", "", ""], rel=1e-9)


def test_a_score_at_least_is_never_more_than_at_most(cell):
    *_, found = cell
    for (kpi, subject, part), value in found.items():
        least = "" if part == "at_most" else part.removesuffix(AT_MOST)
        if least != part and not np.isnan(value):
            assert found[kpi, subject, least] <= value


def test_twice_the_rating_halves_the_minutes_and_keeps_the_postures():
    """The same performances, each in half the time: half the dose, and the same mean, P90 and most."""
    plan = made_plan(Bending((80.0,) * 64), ergonomics=Options())
    slow, quick = (
        all_of(made([work(100 * k, 100 * k + 9 / rate, 0, worker=0, k=k, task=BEND) for k in range(3)], plan), plan)
        for rate in (1, 2)
    )
    for kpi in ("rula_from_5_min_per_h", "posture_dose"):
        assert (
            quick[kpi, "ana", "at_most"] == pytest.approx(slow[kpi, "ana", "at_most"] / 2) and slow[kpi, "", "at_most"]
        )
    for kpi in ("rula_mean", "rula_p90", "rula_most", "reba_mean", "reba_most"):
        assert quick[kpi, "ana", ""] == pytest.approx(slow[kpi, "ana", ""])


def test_who_was_never_there_has_no_rate():
    plan = made_plan()
    log = made([row(OFF, 0, 3600, worker=0), work(0, 9, 0, worker=1, k=0, task=BEND)], plan)
    found = all_of(log, plan)
    assert np.isnan(found["rula_from_5_min_per_h", "ana", ""]) and found["posture_dose", "ana", ""] == 0
    assert found["exposure_gini", "", "posture_dose"] == 0


def test_postures_are_looked_at_once_however_many_figures_are_asked_for(monkeypatch):
    plan, passes = made_plan(), []
    log = made([work(0, 9, 0, worker=0, k=0, task=BEND)], plan)
    real = exposure.fold
    monkeypatch.setattr(exposure, "fold", lambda *args: (passes.append(1), real(*args)))
    figures(log, plan, EXPOSURE)
    assert len(passes) == 1
    figures(log, plan, [*POSTURE, "walked_m"])
    assert len(passes) == 1


def test_how_much_was_measured_is_told_once_by_whoever_looks():
    plan = made_plan()
    rows = [work(0, 9, 0, worker=0, k=0, task=BEND), work(9, 12, 0, worker=0, k=0, task=COUNT)]
    log = made(rows, plan)
    alone, both = (
        [f for f in figures(log, plan, asked) if f.kpi == "posture_measured_share"]
        for asked in (SCORED, [*POSTURE, *SCORED])
    )
    assert sorted(alone) == sorted(both) and [f.value for f in alone][:2] == [0.75, 0.75] and len(alone) == 3
    assert needs_postures(["rula_mean"]) and headline(["rula_mean"]) == {"rula_mean", "posture_measured_share"}


def test_without_postures_nothing_is_looked_at_and_the_rows_are_the_same(cell, monkeypatch):
    log, plan, _ = cell
    blind = replace(plan, posture=False)
    monkeypatch.setattr(exposure, "fold", lambda *_: pytest.fail("looked"))
    monkeypatch.setattr("opsim.subjects.exposure.trunk_figures.trunk_exposure", lambda *_: pytest.fail("looked"))
    assert not {f.kpi for f in figures(log, blind, [*POSTURE, *EXPOSURE])} & {*POSTURE, *EXPOSURE}
    other = run_plan(blind)
    assert all(np.array_equal(log[name], other[name], equal_nan=True) for name in log.columns)


def test_waiting_upright_and_walking_count_where_they_are_asked_for():
    plan = made_plan(ergonomics=Options(waiting="upright"))
    log = made([row(WAIT, 0, 1800, worker=0), work(1800, 1809, 0, worker=0, k=0, task=BEND)], plan)
    found = all_of(log, plan)
    assert ("exposure_by_task", "waiting", "rula_from_5") in found and (
        "exposure_by_station",
        "none",
        "rula_from_5",
    ) in found
    assert found["rula_mean", "ana", ""] == pytest.approx(2, abs=0.02)  # straight elbows are a lower arm of 2
    assert all_of(log, made_plan())["rula_mean", "ana", ""] > 2.5


# Must show: what is lost where postures and times are drawn apart


@pytest.fixture(scope="module")
def pallet():
    """A quarter of an hour of the shipped low pallet, and its variant in which bodies are drawn apart from times."""
    found = {}
    for name in ("base", "times_apart_from_bodies"):
        plan = replace(compile_plan(read_scenarios("low_pallet", [name])[name]), horizon_s=2100.0, warm_up_s=300.0)
        log = run_plan(plan)
        found[name] = log, all_of(log, plan)
    return found


def test_drawing_postures_apart_from_times_changes_exposure_and_no_row(pallet):
    (log, found), (other, apart) = pallet.values()
    assert np.array_equal(log["end_s"], other["end_s"]) and np.array_equal(log["kind"], other["kind"])
    dose, dose_apart = (of["posture_dose", "", ""] for of in (found, apart))
    bent, bent_apart = (of["exposure_by_task", "pick_up", "trunk_beyond_60"] for of in (found, apart))
    # NOTE: the sum over all postures hardly knows which of them a time came with; time bent far does
    assert dose != pytest.approx(dose_apart, rel=1e-6)
    assert np.count_nonzero(log["kind"] == WORK) > 100 and abs(bent - bent_apart) / bent > 0.01


def test_a_scenario_may_switch_postures_off():
    with_it, without = (
        compile_plan(loaded(CELL.replace("seed: 3", f"seed: 3{said}"))) for said in ("", ", posture: off")
    )
    assert with_it.posture and not without.posture and replace(without, posture=True).tasks[0].name == "label"


POSTURE_HOUR_S = 3600.0


def figures_of(rows, plan):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(made(rows, plan), plan, POSTURE) if f.kpi in POSTURE}


@pytest.fixture(scope="module")
def posture_by_hand():
    """In two hours ana bends 20 times for 9 s and counts for 60 s, ben bends once, half as long."""
    plan = made_plan(horizon_s=3 * POSTURE_HOUR_S, warm_up_s=POSTURE_HOUR_S)
    start = POSTURE_HOUR_S + 100 * np.arange(20)
    rows = [work(s, s + 9, 0, worker=0, k=k, task=BEND) for k, s in enumerate(start)]
    rows += [work(9000, 9060, 0, worker=0, k=0, task=COUNT), work(9000, 9004.5, 0, worker=1, k=0, task=BEND)]
    return figures_of(rows, plan)


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("trunk_beyond_60_min_per_h", "ana", "", 20 * 3 / 60 / 2),
        ("trunk_beyond_20_min_per_h", "ana", "", 20 * 7 / 60 / 2),
        ("trunk_beyond_60_min_per_h", "ben", "", 1.5 / 60 / 2),
        ("trunk_beyond_60_min_per_h", "", "", 61.5 / 60 / 4),
        ("trunk_flexion_mean_deg", "ana", "", 45),
        ("trunk_flexion_mean_deg", "", "", 45),
        ("trunk_flexion_p95_deg", "ben", "", 85.5),
        ("trunk_flexion_p95_deg", "", "", 85.5),
        ("trunk_flexion_share", "ana", "below_20", 40 / 7200),
        ("trunk_flexion_share", "ana", "from_20_to_60", 80 / 7200),
        ("trunk_flexion_share", "ana", "beyond_60", 60 / 7200),
        ("trunk_flexion_share", "ana", "unmeasured", 60 / 7200),
        ("trunk_flexion_share", "ana", "not_at_work", 1 - 240 / 7200),
        ("posture_measured_share", "ana", "", 180 / 240),
        ("posture_measured_share", "ben", "", 1),
        ("posture_measured_share", "", "", 184.5 / 244.5),
    ],
)
def test_a_figure_is_what_the_hand_finds_of_posture(posture_by_hand, kpi, subject, part, expected):
    assert posture_by_hand[kpi, subject, part] == pytest.approx(expected, rel=0.005)


def test_shares_of_the_window_sum_to_one(posture_by_hand):
    for subject in ("", "ana", "ben"):
        shares = [
            value for (kpi, of, _), value in posture_by_hand.items() if (kpi, of) == ("trunk_flexion_share", subject)
        ]
        assert len(shares) == 5 and sum(shares) == pytest.approx(1, abs=1e-12)


def test_work_that_nobody_measured_is_nan_and_not_upright():
    found = figures_of([work(0, 60, 0, worker=0, k=0, task=COUNT)], made_plan())
    assert np.isnan(found["trunk_beyond_60_min_per_h", "ana", ""]) and np.isnan(
        found["trunk_flexion_p95_deg", "ana", ""]
    )
    assert found["posture_measured_share", "ana", ""] == 0
    assert found["trunk_flexion_share", "ana", "unmeasured"] == pytest.approx(60 / 3600)


def test_who_does_no_work_is_never_bent():
    found = figures_of([work(0, 9, 0, worker=0, k=0, task=BEND)], made_plan())
    assert found["trunk_beyond_60_min_per_h", "ben", ""] == 0
    assert np.isnan(found["trunk_flexion_mean_deg", "ben", ""]) and np.isnan(found["posture_measured_share", "ben", ""])


def test_leaning_back_is_a_flexion_below_zero():
    found = figures_of([work(0, 9, 0, worker=0, k=0, task=BEND)], made_plan(Bending((-30.0,) * 64)))
    assert found["trunk_flexion_mean_deg", "ana", ""] == pytest.approx(-15, rel=0.01)
    assert found["trunk_flexion_share", "ana", "below_20"] == pytest.approx(9 / 3600)


def test_postures_are_made_only_where_a_figure_that_needs_them_is_asked_for():
    plan = made_plan(Bending(kind=lambda *_: pytest.fail("drawn")))
    log = made([work(0, 9, 0, worker=0, k=0, task=BEND)], plan)
    others = [kpi for kpi in KPIS if kpi not in (*POSTURE, *EXPOSURE)]
    assert {figure.kpi for figure in figures(log, plan, others)} <= set(others)
    assert not needs_postures(USUAL) and needs_postures([*USUAL, "trunk_flexion_p95_deg"])


def test_how_much_was_measured_stands_beside_whatever_was_asked_for():
    assert headline(["walked_m"]) == {"walked_m"}
    assert headline(["walked_m", "trunk_flexion_mean_deg"]) == {
        "walked_m",
        "trunk_flexion_mean_deg",
        "posture_measured_share",
    }


def test_a_floor_without_workers_has_no_figures_of_posture():
    plan = made_plan()
    assert not figures_of([], made_plan(workers=())) and figures_of([], plan)


def ledger(**seconds):
    """One cell; by name of ``BINS`` seconds by value, None for not known. What is not named is not known for 100 s."""
    bins = {name: np.zeros((1, 1 + b.n)) for name, b in BINS.items()}
    for name in BINS:
        for value, spent_s in seconds.get(name, {None: 100.0}).items():
            bins[name][0, 0 if value is None else 1 + value - BINS[name].first] = spent_s
    return Ledger(np.zeros((1, 5), int), bins)


def test_minutes_are_those_at_the_level_or_beyond():
    found = ledger(rula={4: 30.0, 5: 60.0, 7: 120.0}, rula_at_most={7: 210.0}, trunk={19: 60.0, 20: 120.0})
    assert minutes(found, "rula_from_5")[0] == 3 and minutes(found, "rula_from_7")[0] == 2
    assert minutes(found, "rula_from_5", "_at_most")[0] == 3.5 and minutes(found, "trunk_beyond_20")[0] == 2


def test_what_nobody_measured_is_not_known_and_what_nobody_did_is_nothing():
    assert np.isnan(minutes(ledger(), "rula_from_5")[0]) and np.isnan(mean_score(ledger(), "rula")[0])
    idle = ledger(**{name: {None: 0.0} for name in BINS})
    assert minutes(idle, "rula_from_5")[0] == 0 and np.isnan(quantile(idle, "rula", 0.9)[0])


@pytest.mark.parametrize(("q", "expected"), [(0.05, 2), (0.1, 2), (0.5, 3), (0.9, 3), (0.91, 6), (1.0, 6)])
def test_the_quantile_is_the_score_at_or_below_which_that_share_of_the_time_is(q, expected):
    assert quantile(ledger(rula={2: 10.0, 3: 80.0, 6: 10.0}), "rula", q)[0] == expected


def test_the_mean_is_over_the_known_time():
    assert mean_score(ledger(reba={None: 900.0, 1: 30.0, 15: 10.0}), "reba")[0] == pytest.approx((30 + 150) / 40)


def test_scores_have_two_bounds_and_angles_one():
    assert {name: len(bounds_of_level(name)) for name in LEVELS} == {
        name: 2 if name.startswith(("rula", "reba", "owas")) else 1 for name in LEVELS
    }
