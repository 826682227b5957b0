import json
import shutil

import numpy as np
import pytest
from plans import CELL, loaded

from opsim.log_parquet import connect, read_events
from opsim.study import replication as replicating
from opsim.study import run_scenario
from opsim.study.results_folder import LOCK, Busy, locked
from opsim.study.summary import _distribution


def files(folder):
    return {path.name: path.read_bytes() for path in sorted((folder / "events").iterdir())}


@pytest.fixture(scope="module")
def one(tmp_path_factory):
    folder = tmp_path_factory.mktemp("one")
    return run_scenario(loaded(CELL), folder=folder, processes=1)


def test_one_and_two_processes_write_the_same_bytes(one, tmp_path):
    two = run_scenario(loaded(CELL), folder=tmp_path, processes=2)
    assert files(two.folder) == files(one.folder) and len(files(one.folder)) == 3
    assert two.summary == one.summary


def test_the_folder_holds_what_the_design_promises(one):
    names = {path.name for path in one.folder.iterdir()}
    shown = {"scenario.resolved.yaml", "manifest.json", "events", "kpis.parquet", "summary.json", "finished.json"}
    assert names == {*shown, ".run.lock"}
    assert [path.name for path in one.events_files] == [f"replication_{r:05d}.parquet" for r in range(3)]


def test_the_resolved_scenario_reads_as_the_same_scenario(one):
    again = loaded((one.folder / "scenario.resolved.yaml").read_text())
    assert again.scenario == loaded(CELL).scenario


def test_means_in_the_summary_are_means_of_the_kpi_table(one):
    with connect() as connection:
        table = connection.execute(
            f"SELECT kpi, subject, part, avg(value) FROM '{one.folder / 'kpis.parquet'}' GROUP BY ALL"
        ).fetchall()
    expected = {(row["kpi"], row["subject"], row["part"]): row["mean"] for row in one.summary["kpis"]}
    assert {tuple(key): pytest.approx(mean) for *key, mean in table} == expected


def test_a_killed_run_goes_on_where_it_stopped(one, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=2)
    ran = []
    run_one = replicating.run_one
    monkeypatch.setattr(
        replicating,
        "run_one",
        lambda plan, r, folder, *more: (
            ran.append(replicating.events_file(folder, r).exists()) or run_one(plan, r, folder, *more)
        ),
    )
    finished = run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    assert ran == [True, True, False]
    assert finished.summary == one.summary


def test_rows_that_cannot_be_read_or_are_of_another_run_are_made_anew(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    first, second, third = (tmp_path / "copy" / "events" / name for name in files(one.folder))
    first.write_bytes(b"")
    second.write_bytes(second.read_bytes()[:500])
    third.write_bytes((one.folder / "events" / first.name).read_bytes())
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary
    assert files(tmp_path / "copy") == files(one.folder)


def test_rows_of_another_seed_are_not_taken_for_those_asked_for(one, tmp_path):
    other = run_scenario(loaded(CELL), folder=tmp_path / "other", processes=1, seed=99, replications=1)
    shutil.copytree(one.folder, tmp_path / "copy")
    shutil.copy(other.events_files[0], tmp_path / "copy" / "events")
    run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1)
    assert files(tmp_path / "copy") == files(one.folder)


def test_fewer_replications_give_the_results_of_the_first_and_keep_the_other_rows(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    fewer = run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, replications=2)
    assert fewer.summary["replications"] == 2 and len(fewer.events_files) == 2
    assert files(tmp_path / "copy") == files(one.folder)


def test_times_that_are_all_the_same_and_huge_have_a_histogram():
    row = _distribution("duration_s", "long", np.full(7, 5e9))
    assert sum(row["histogram"]["counts"]) == 7 and np.all(np.diff(row["histogram"]["edges"]) > 0)


def test_progress_counts_every_replication(tmp_path):
    seen = []
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_replications_differ_and_are_numbered(one):
    logs = [read_events(path) for path in one.events_files]
    assert [log.replication for log in logs] == [0, 1, 2]
    assert len({tuple(log["end_s"][:50]) for log in logs}) == 3


def test_what_was_not_measured_is_on_the_assumption_sheet(one):
    says = " ".join(f"{a['topic']}: {a['says']}" for a in one.summary["assumptions"])
    for words in (
        "not from recordings",
        "ana, cai: walking speed not given",
        "transport: jobs pass",
        "nearest (chosen)",
        "same people",
    ):
        assert words in says


@pytest.mark.parametrize(
    "run, how, says",
    [
        ("seed: 5", {"replications": 1}, ["replications: 1, given with the call; the file says nothing"]),
        (
            "replications: 3, seed: 5",
            {"replications": 1},
            ["replications: 1, given with the call; instead of the file's 3"],
        ),
        ("replications: 1", {"seed": 9}, ["seed: 9, given with the call; the file says nothing"]),
        ("replications: 1", {}, ["seed: 0, the default"]),
        ("replications: 1, seed: 5", {"seed": 5}, []),
    ],
)
def test_the_assumption_sheet_says_where_seed_and_replications_come_from(tmp_path, run, how, says):
    text = CELL.replace("horizon: 2 h", "horizon: 20 min").replace("replications: 3, seed: 5", run)
    found = run_scenario(loaded(text), folder=tmp_path, processes=1, **how).summary["assumptions"]
    found = [line["says"] for line in found if line["topic"] == "run"]
    assert len(found) == len(says) and all(words in line for words, line in zip(says, found))


def test_the_manifest_names_seed_and_versions(one):
    manifest = json.loads((one.folder / "manifest.json").read_text())
    assert manifest["seed"] == 5 and manifest["packages"]["simpy"]


def test_a_finished_run_is_taken_as_it_is_and_no_row_is_read(one, tmp_path, monkeypatch):
    shutil.copytree(one.folder, tmp_path / "copy")
    monkeypatch.setattr(replicating, "run_one", None)
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary


@pytest.mark.parametrize(
    "spoil",
    [
        lambda folder: (folder / "kpis.parquet").write_bytes(b"PAR1"),
        lambda folder: (folder / "summary.json").write_text("{}"),
        lambda folder: (folder / "finished.json").write_text("[]"),
        lambda folder: (folder / "events" / "replication_00001.parquet").unlink(),
    ],
    ids=["figures", "summary", "what it says", "rows"],
)
def test_results_that_are_not_whole_are_made_anew_of_the_rows(one, tmp_path, spoil):
    shutil.copytree(one.folder, tmp_path / "copy")
    spoil(tmp_path / "copy")
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary
    for name in ("kpis.parquet", "summary.json", "finished.json"):
        assert (tmp_path / "copy" / name).read_bytes() == (one.folder / name).read_bytes()
    assert files(tmp_path / "copy") == files(one.folder)


def test_other_options_or_outputs_of_the_same_rows_are_another_run(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    assert (
        run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, replications=2).summary["replications"] == 2
    )
    other = loaded(CELL.replace("warm_up: 10 min", "warm_up: 5 min"))
    assert run_scenario(other, folder=tmp_path / "copy", processes=1).summary["window_s"][0] == 300
    assert files(tmp_path / "copy") == files(one.folder)
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary


def test_two_runs_do_not_write_into_one_folder(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    before = {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()}
    with locked(tmp_path / "copy" / LOCK, ""), pytest.raises(Busy, match="another 'opsim run' writes there now"):
        run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, overwrite=True)
    assert {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()} == before
