"""Figures of posture on their way through a study."""

import numpy as np
import pytest
from plans import loaded

from opsim.results import Result
from opsim.study import Precision, run_scenario
from opsim.study.compare import NotComparable, compare

CELL = """
opsim: 1
name: bending
run: {horizon: 30 min, warm_up: 5 min, replications: 3, seed: 2}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  label: {fixed: 5 s}
  stow:  {emulator: moves/shoulder_scaption}
stations: {s1: {at: a, tasks: [squat, label, stow], buffer: 1}}
products: {p: {route: [s1]}}
release: {kind: poisson, every: 20 s}
workers: {ana: {skills: {s1: 1.0}}, ben: {skills: {s1: 0.9}}}
overrides: {more: {release.every: 10 s}, twice: {tasks.squat.repeat: 2}}
scenarios: {base: [], same: [], busy: [more], deep: [twice]}
outputs: OUTPUTS
"""
BEYOND = "trunk_beyond_20_min_per_h"


def ran(folder, outputs, variant="base", **how):
    return run_scenario(loaded(CELL.replace("OUTPUTS", f"[{outputs}]"), variant), folder=folder, processes=1, **how)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    return {name: ran(folder / name, f"walked_m, {BEYOND}", name) for name in ("base", "same", "busy", "deep")}


def rows(result, kpi):
    return {row["subject"]: row for row in result.summary["kpis"] if row["kpi"] == kpi}


def test_a_figure_of_posture_has_a_mean_and_an_interval_like_any_other(results):
    found = rows(results["base"], BEYOND)
    assert set(found) == {"", "ana", "ben"} and found[""]["headline"] and found[""]["n"] == 3
    assert 0 < found[""]["low"] < found[""]["mean"] < found[""]["high"]
    assert found[""]["mean"] == pytest.approx((found["ana"]["mean"] + found["ben"]["mean"]) / 2)


def test_how_much_was_measured_stands_in_front_too(results):
    found = rows(results["base"], "posture_measured_share")
    assert found[""]["headline"] and 0.4 < found[""]["mean"] < 0.6
    assert not rows(results["base"], "trunk_flexion_p95_deg")[""]["headline"]


def test_variants_are_compared_pair_by_pair(results):
    verdicts = {d.variant: d for d in compare(results, kpis=[BEYOND]).differences if not d.key[1]}
    assert verdicts["same"].identical
    assert verdicts["deep"].verdict == "higher" and verdicts["deep"].interval.low > 0
    assert verdicts["deep"].mean == pytest.approx(2 * verdicts["deep"].base, rel=0.2)
    assert verdicts["busy"].interval.n == 3


def test_the_assumption_sheet_names_what_was_not_measured(results):
    said = " ".join(row["says"] for row in results["base"].summary["assumptions"] if row["topic"] == "postures")
    assert "label: no posture is known" in said and "squat" not in said


def test_rows_that_are_there_are_measured_when_it_is_asked_for(tmp_path):
    before = ran(tmp_path, "walked_m")
    written = {path: path.stat().st_mtime_ns for path in before.events_files}
    assert not rows(before, BEYOND)
    after = ran(tmp_path, BEYOND)
    assert rows(after, BEYOND)[""]["n"] == 3
    assert {path: path.stat().st_mtime_ns for path in after.events_files} == written


def test_a_figure_that_was_not_asked_for_is_not_there_and_compare_says_how_to_get_it(tmp_path):
    without = {name: ran(tmp_path / name, "walked_m", name, replications=1) for name in ("base", "busy")}
    with pytest.raises(NotComparable, match="it is made where the scenario's 'outputs' list it"):
        compare(without, kpis=[BEYOND])


def test_a_precision_is_enough_to_ask_for_it(tmp_path):
    result = ran(tmp_path, "walked_m", replications=10, precision=[Precision(BEYOND, "", "", 0.5)])
    assert rows(result, BEYOND)[""]["n"] == 10 and result.summary["precision"][0]["found"] > 0


@pytest.mark.slow
def test_one_and_two_processes_measure_the_same(results, tmp_path):
    other = run_scenario(loaded(CELL.replace("OUTPUTS", f"[walked_m, {BEYOND}]")), folder=tmp_path, processes=2)
    here, there = (Result.load(result.folder).kpis() for result in (results["base"], other))
    assert np.array_equal(
        [list(row.values()) for row in here.values()], [list(row.values()) for row in there.values()], equal_nan=True
    )
