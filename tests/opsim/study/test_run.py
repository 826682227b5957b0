import json

import pytest
from plans import CELL, loaded

from opsim.log_store import connect, read_events
from opsim.study import replicate as replicating
from opsim.study import run_scenario


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
    assert names == {"scenario.resolved.yaml", "manifest.json", "events", "kpis.parquet", "summary.json"}
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
        lambda plan, r, folder: ran.append(replicating.events_file(folder, r).exists()) or run_one(plan, r, folder),
    )
    finished = run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    assert ran == [True, True, False]
    assert finished.summary == one.summary


def test_rows_of_another_seed_are_not_mixed_in(one, tmp_path):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, seed=99, replications=1)
    other = files(tmp_path)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    assert files(tmp_path) == files(one.folder)
    assert other["replication_00000.parquet"] != files(tmp_path)["replication_00000.parquet"]


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


def test_the_manifest_names_seed_and_versions(one):
    manifest = json.loads((one.folder / "manifest.json").read_text())
    assert manifest["seed"] == 5 and manifest["packages"]["simpy"]
