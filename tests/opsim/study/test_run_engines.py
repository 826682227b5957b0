"""A run by either engine; the fast one is a stand-in here (its own rows: tests/opsim/engine)."""

import json

import pytest
from plans import CELL, loaded
from stand_in_engine import stand_in

from opsim.problems import ScenarioError
from opsim.study import replicate as replicating
from opsim.study import run_scenario
from opsim.study.folder import engine_said
from opsim.study.manifest import digest

KEPT = ("summary.json", "kpis.parquet", "scenario.resolved.yaml", "finished.json")


def bytes_of(folder):
    return {path.name: path.read_bytes() for path in [*(folder / "events").iterdir(), *(folder / n for n in KEPT)]}


@pytest.fixture(scope="module")
def by_simpy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("simpy")
    run_scenario(loaded(CELL), folder=folder, processes=1)
    return folder


def run_fast(folder, monkeypatch, **how):
    made = stand_in(monkeypatch)
    run_scenario(loaded(CELL), folder=folder, processes=1, engine="fast", **how)
    return made


def test_both_engines_write_the_same_bytes_and_the_manifest_says_which_it_was(by_simpy, tmp_path, monkeypatch):
    made = run_fast(tmp_path, monkeypatch)
    assert [replication for _, replication in made.ran] == [0, 1, 2] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path) == {"asked": "fast", "used": "fast", "why": "as asked"}
    assert engine_said(by_simpy) == {"asked": "simpy", "used": "simpy", "why": "which is the reference"}
    ours, theirs = (json.loads((folder / "manifest.json").read_text()) for folder in (tmp_path, by_simpy))
    assert digest(ours) == digest(theirs) and {key for key in ours if ours[key] != theirs[key]} == {"engine"}


def test_a_run_goes_on_with_the_other_engine_and_the_manifest_says_so(by_simpy, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=2)
    made = run_fast(tmp_path, monkeypatch)
    assert [replication for _, replication in made.ran] == [2] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path)["earlier"] == ["simpy"]
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=4)
    assert engine_said(tmp_path)["used"] == "simpy" and engine_said(tmp_path)["earlier"] == ["fast"]


def test_results_of_the_other_engine_are_taken_as_they_are(tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    before, told = bytes_of(tmp_path), []
    made = run_fast(tmp_path, monkeypatch, chosen=told.append)
    assert made.ran == made.asked_for == told == [] and bytes_of(tmp_path) == before
    assert engine_said(tmp_path)["used"] == "simpy"


def test_where_only_figures_are_to_be_made_nothing_is_compiled(by_simpy, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    (tmp_path / "summary.json").unlink()
    made = run_fast(tmp_path, monkeypatch)
    assert made.ran == made.asked_for == [] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path)["used"] == "simpy"


def test_removed_rows_leave_no_word_of_who_made_them(tmp_path, monkeypatch):
    run_fast(tmp_path, monkeypatch)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, overwrite=True)
    assert "earlier" not in engine_said(tmp_path) and engine_said(tmp_path)["used"] == "simpy"


def test_it_is_compiled_before_any_process_is_started(tmp_path, monkeypatch):
    made, started = stand_in(monkeypatch), []

    def pooled(runner, left, processes, meanwhile):
        started.append((made.is_compiled, len(made.asked_for)))
        return map(runner(), left)

    monkeypatch.setattr(replicating, "pooled", pooled)
    steps, chosen = [], []

    def told(choice):
        chosen.append(choice.engine)
        return lambda *step: steps.append(step)

    run_scenario(loaded(CELL), folder=tmp_path, processes=2, engine="fast", chosen=told)
    assert started == [(True, 1)] and chosen == ["fast"] and steps[-1] == (3, 3)


def test_an_engine_may_run_in_threads_with_the_same_bytes(by_simpy, tmp_path, monkeypatch):
    monkeypatch.setattr(replicating, "IN_THREADS", frozenset({"fast"}))
    made = stand_in(monkeypatch)
    run_scenario(loaded(CELL), folder=tmp_path, processes=2, engine="fast")
    assert len({process for process, _ in made.ran}) == 1 and bytes_of(tmp_path) == bytes_of(by_simpy)


def test_what_the_fast_engine_does_not_run_leaves_no_folder(tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    with pytest.raises(ScenarioError, match="belts"):
        run_scenario(loaded(CELL), folder=tmp_path / "out", engine="fast")
    assert not (tmp_path / "out").exists()


def test_auto_of_little_work_is_simpy_and_the_manifest_says_why(by_simpy, tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, engine="auto")
    assert made.asked_for == [] and bytes_of(tmp_path) == bytes_of(by_simpy)
    said = engine_said(tmp_path)
    assert (said["asked"], said["used"]) == ("auto", "simpy") and "less than a second of work" in said["why"]
