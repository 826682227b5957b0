"""Walking with postures on its way through a study: rows stay, figures come, the sheet says what stands behind."""

import json

import numpy as np
import pytest

from opsim.log_parquet import read_events
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.study import run_scenario
from tests.opsim.made_walks import made_library

CELL = """
opsim: 1
name: walkers
run: {horizon: 30 min, warm_up: 5 min, replications: 2, seed: 2}
libraries: {made: made.npz}
walking: {emulator: made/walk}
layout: {places: {a: [0 m, 0 m], b: [5 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 6 s}}
stations: {s1: {at: a, tasks: [cut], buffer: 3}, s2: {at: b, tasks: [cut], buffer: 3}}
products: {p: {route: [s1, s2], carried: true}}
release: {kind: poisson, every: 30 s}
workers: {ana: {height: 1.6 m, walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}}
outputs: [walking_min_per_h, steps_per_h, trunk_flexion_share]
"""
WITHOUT = CELL.replace("libraries: {made: made.npz}\nwalking: {emulator: made/walk}\n", "").replace(
    "walking_min_per_h, steps_per_h", "walked_m"
)


def read(text, folder):
    return scenarios_in(text.encode(), folder / "walkers.yaml")["base"]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walkers")
    with pytest.MonkeyPatch.context() as patch:
        made_library(folder, patch)
        runs = {"on": CELL, "off": WITHOUT}
        yield {name: run_scenario(read(text, folder), folder=folder / name, processes=1) for name, text in runs.items()}


def rows(result, kpi, part=""):
    return {row["subject"]: row for row in result.summary["kpis"] if (row["kpi"], row["part"]) == (kpi, part)}


def test_the_rows_are_the_same_with_and_without_postures(results):
    for on, off in zip(results["on"].events_files, results["off"].events_files):
        with_it, without = read_events(on), read_events(off)
        assert all(np.array_equal(with_it[name], without[name], equal_nan=True) for name in with_it.columns)


def test_figures_of_walking_have_means_and_intervals_and_stand_in_front(results):
    found = rows(results["on"], "walking_min_per_h")
    assert set(found) == {"", "ana"} and found["ana"]["headline"] and found["ana"]["n"] == 2
    state = rows(results["on"], "worker_states", "walk")["ana"]["mean"]
    assert found["ana"]["mean"] == pytest.approx(60 * state)
    assert not rows(results["off"], "walking_min_per_h")


def test_the_summary_names_what_stands_behind_the_walks(results):
    source = results["on"].summary["walking"]
    assert source["model"] == "emulator made/walk" and source["library"] == "made.npz" and source["n_workers"] == 3
    assert "walking" not in results["off"].summary


def test_the_assumption_sheet_says_how_people_walk(results):
    said = {name: json.dumps(result.summary["assumptions"]) for name, result in results.items()}
    assert "people walk as in made/walk (12 made repetitions of 3 made-up people" in said["on"]
    assert "people walk at 0.3 to 2.5 m/s" in said["on"] and "counts only as far as that" in said["on"]
    assert "a drawn walk is straight" in said["on"] and "height of ana: bones are scaled to it" in said["on"]
    assert "made/walk" not in said["off"] and "a drawn walk" not in said["off"]
    assert "waiting is not measured" in said["on"] and "walking and waiting are not measured" in said["off"]


def test_the_manifest_has_the_library_and_the_folder_its_copy(results):
    folder = results["on"].folder
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["libraries"]["made"]["file"] == "made.npz" and len(manifest["libraries"]["made"]["sha256"]) == 64
    assert (folder / "made.npz").is_file()


def test_the_resolved_scenario_runs_again_from_its_folder_alone(results, tmp_path):
    folder = results["on"].folder
    again = scenarios_in((folder / "scenario.resolved.yaml").read_bytes(), folder / "scenario.resolved.yaml")["base"]
    result = run_scenario(again, folder=tmp_path, processes=1)
    assert json.dumps(result.summary["kpis"]) == json.dumps(results["on"].summary["kpis"])


def test_the_report_shows_a_walk_of_the_run(results, tmp_path):
    from opsim.report import materials, write_report
    from opsim.report.sections.walking import walking_section as section
    from opsim.study.run import opened

    runs = {"on": opened(results["on"], read(CELL, results["on"].folder))}
    runs["off"] = opened(results["off"], read(WITHOUT, results["off"].folder))
    of = dict(materials(runs, results))
    (walk,) = (block for block in section(of["on"]).blocks if block.kind == "picture")
    assert walk.caption.startswith("ana: 1.00 m/s, steps of 0.50 m, ") and "slide by at most 0.0 mm" in walk.caption
    page = write_report(of["on"], tmp_path / "report.html").path.read_text()
    assert 'id="walking"' in page and "12 made repetitions of 3 made-up people" in page
    assert section(of["off"]) is None


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (("walk: 1 m/s", "walk: 3 m/s"), "workers.ana.walk: people of 'made/walk' cannot walk at 3 m/s"),
        (("walk: 1 m/s", "walk: 0.1 m/s"), "they walk at 0.3 to 2.5 m/s"),
        (("made/walk", "made/lift"), "'lift' is not an emulator of walking"),
        (("made/walk", "made/lift"), "walking in it: walk"),
        (("made/walk", "made/crank"), "'crank' is not an emulator of walking"),
        (("made/walk", "made/wakl"), "no task 'wakl' in library 'made'"),
    ],
)
def test_what_the_emulator_cannot_do_is_said_before_the_run(tmp_path, monkeypatch, edit, said):
    made_library(tmp_path, monkeypatch)
    with pytest.raises(ScenarioError) as caught:
        read(CELL.replace(*edit), tmp_path)
    assert said in str(caught.value) and "1 problem in" in str(caught.value)


def test_a_speed_that_nobody_says_is_checked_too(tmp_path, monkeypatch):
    made_library(tmp_path, monkeypatch)
    monkeypatch.setattr("opsim.scenario.checks.motions.USUAL_M_PER_S", 2.6)
    with pytest.raises(ScenarioError, match=r"workers.ana.*cannot walk at 2\.6 m/s"):
        read(CELL.replace("walk: 1 m/s, ", ""), tmp_path)
