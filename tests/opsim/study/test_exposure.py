"""Figures of what bodies went through on their way through a study; with postures looked at, and not."""

import numpy as np
import pytest
from plans import answer, loaded

from opsim.results import Result
from opsim.study import run_scenario
from opsim.study.compare import compare
from opsim.study.intervals import NoSuchFigure, Precision

CELL = """
opsim: 1
name: bending
run: {horizon: 7 min, warm_up: 1 min, replications: 3, seed: 2POSTURE}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  lift:  {emulator: moves/deep_squat, load: 12 kg}
  label: {fixed: 5 s}
stations: {s1: {at: a, tasks: [lift, label], buffer: 1}}
products: {p: {route: [s1]}}
release: {kind: poisson, every: 20 s}
workers: {ana: {skills: {s1: 1.0}}, ben: {skills: {s1: 0.9}}}
overrides: {lighter: {tasks.lift.emulator: moves/side_lunge, tasks.lift.load: 0 kg}, apart: {run.variability: shuffled}}
scenarios: {base: [], lighter: [lighter], apart: [apart]}
outputs: OUTPUTS
"""
ASKED = "throughput_per_h, rula_from_5_min_per_h, posture_dose, exposure_by_task"


def scenario(outputs=ASKED, posture=""):
    return CELL.replace("OUTPUTS", f"[{outputs}]").replace("POSTURE", posture)


def ran(folder, variant="base", text=None, **how):
    return run_scenario(loaded(scenario() if text is None else text, variant), folder=folder, processes=1, **how)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    return {name: ran(folder / name, name) for name in ("base", "lighter", "apart")}


def rows(result, kpi):
    return {(row["subject"], row["part"]): row for row in result.summary["kpis"] if row["kpi"] == kpi}


def test_a_figure_of_exposure_has_a_mean_and_an_interval_over_replications(results):
    found = rows(results["base"], "rula_from_5_min_per_h")
    assert {("", ""), ("", "at_most"), ("", "worst"), ("ana", ""), ("ben", "at_most")} <= set(found)
    assert found["", ""]["headline"] and found["", ""]["n"] == 3
    assert 0 < found["", ""]["low"] < found["", ""]["mean"] < found["", ""]["high"] < 60
    assert found["", "worst"]["mean"] >= max(found["ana", ""]["mean"], found["ben", ""]["mean"])
    assert rows(results["base"], "posture_measured_share")["", ""]["headline"]


def test_variants_are_compared_pair_by_pair(results):
    found = {
        d.variant: d for d in compare(results, kpis=["rula_from_5_min_per_h"]).differences if d.key[1:3] == ("", "")
    }
    assert found["lighter"].verdict == "lower" and found["lighter"].mean < 0.95 * found["lighter"].base


def test_postures_drawn_apart_from_times_leave_the_rows_and_change_the_exposure(results):
    """At this seed in each of the three replications by more than a ten-thousandth of the dose."""
    (base, apart), kpi = (results[name] for name in ("base", "apart")), ("posture_dose", "", "", "score h")
    assert np.array_equal(*(_per_replication(r, ("throughput_per_h", "", "", "1/h")) for r in (base, apart)))
    dose, dose_apart = (_per_replication(r, kpi) for r in (base, apart))
    assert np.all(np.abs(dose / dose_apart - 1) > 1e-4)


def _per_replication(result, key):
    return np.array(list(Result.load(result.folder).kpis()[key].values()))


def test_with_posture_off_the_events_are_the_same_bytes_and_nothing_is_known_of_bodies(results, tmp_path):
    blind = ran(tmp_path, text=scenario("throughput_per_h", ", posture: off"))
    for one, other in zip(results["base"].events_files, blind.events_files, strict=True):
        assert one.read_bytes() == other.read_bytes()
    assert not rows(blind, "posture_dose") and not rows(blind, "posture_measured_share")


def test_postures_may_be_switched_on_later_without_a_new_run(tmp_path):
    blind = ran(tmp_path, text=scenario("throughput_per_h", ", posture: off"))
    written = {path: path.stat().st_mtime_ns for path in blind.events_files}
    seeing = ran(tmp_path)
    assert {path: path.stat().st_mtime_ns for path in seeing.events_files} == written
    assert rows(seeing, "posture_dose")["", ""]["mean"] > 0


def test_figures_of_exposure_with_posture_off_are_a_mistake_with_its_place():
    said = answer(scenario(posture=", posture: off"))
    assert "outputs" in said and "rula_from_5_min_per_h" in said and "posture" in said
    assert answer(scenario("throughput_per_h", ", posture: off")) == "good" == answer(scenario())


def test_a_precision_of_a_figure_of_bodies_with_posture_off_is_told_apart_from_a_wrong_name(tmp_path):
    blind = scenario("throughput_per_h", ", posture: off")
    with pytest.raises(NoSuchFigure, match=r"no figure 'rula_mean'; it is made from postures, and nobody looks"):
        ran(tmp_path, text=blind, precision=[Precision("rula_mean", "", "", 0.5)], replications=1)


def test_a_replication_has_the_same_exposure_however_many_there_are(results, tmp_path):
    one = ran(tmp_path, replications=1)
    found, alone = (Result.load(result.folder).kpis() for result in (results["base"], one))
    assert set(found) == set(alone)
    for key, value in alone.items():
        assert np.array_equal([value[0]], [found[key][0]], equal_nan=True), key


@pytest.mark.slow
def test_one_and_two_processes_find_the_same(results, tmp_path):
    other = run_scenario(loaded(scenario()), folder=tmp_path, processes=2)
    here, there = (Result.load(result.folder).kpis() for result in (results["base"], other))
    assert np.array_equal(
        [list(row.values()) for row in here.values()], [list(row.values()) for row in there.values()], equal_nan=True
    )
