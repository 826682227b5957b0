import csv
import io
import json
import shutil
import sqlite3
from contextlib import closing

import duckdb
import numpy as np
import pytest

from emulator.recordings.bvh import read_bvh, read_bvh_file
from opsim.ergonomics.redraw import performance_again
from opsim.export.sql import EXAMPLES, TABLES
from opsim.log import WORK
from opsim.study.run import reopened
from tests.opsim.cli.calls import opsim
from tests.opsim.export.made_results import results


def test_one_replication_of_one_variant_is_one_ocel_file(tmp_path):
    out = tmp_path / "log.jsonocel"
    code, shown, _ = opsim("export", results() / "near", "-o", out)
    rows = len(reopened(results() / "near").log())
    assert code == 0 and f"{rows:,} events" in shown and str(out) in shown
    read = json.loads(out.read_text(encoding="utf-8"))
    assert len(read["events"]) == rows and read["events"][0]["time"] == "2026-01-06T06:00:00.000000Z"


def test_several_are_a_file_each_and_machines_are_told_which(tmp_path):
    code, shown, told = opsim("export", results(), "-o", tmp_path / "log.sqlite", "--replication", "all", "--json")
    files = json.loads(shown)["files"]
    assert code == 0 and "4 of 4" in told
    assert [(one["variant"], one["replication"]) for one in files] == [
        ("base", 0),
        ("base", 1),
        ("near", 0),
        ("near", 1),
    ]
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == [f"log_{name}_r0000{n}.sqlite" for name in ("base", "near") for n in (0, 1)]
    for one in files:
        with closing(sqlite3.connect(one["out"])) as connection:
            assert connection.execute("SELECT count(*) FROM event").fetchone() == (one["events"],)


def test_another_monday_and_an_event_type_for_each_task(tmp_path):
    out = tmp_path / "log.json"
    code, _, _ = opsim("export", results() / "base", "-o", out, "--date", "2026-03-02", "--by-task")
    read = json.loads(out.read_text(encoding="utf-8"))
    assert code == 0 and read["events"][0]["time"].startswith("2026-03-03T06:00")
    assert {"work: lift", "work: label"} <= {kind["name"] for kind in read["eventTypes"]}


def test_rows_and_figures_of_all_go_into_one_table(tmp_path):
    code, shown, _ = opsim("export", results(), "-o", tmp_path / "rows.parquet")
    runs = [reopened(results() / name) for name in ("base", "near")]
    expected = sum(len(run.log(n)) for run in runs for n in (0, 1))
    assert code == 0 and f"{expected:,} rows of base, near" in shown
    assert duckdb.sql(f"SELECT count(*) FROM '{tmp_path / 'rows.parquet'}'").fetchall() == [(expected,)]
    words = ("export", results(), "-o", tmp_path / "one.csv", "--scenario", "near", "--replication", "1")
    code, _, _ = opsim(*words, "--date", "2026-01-05")
    lines = (tmp_path / "one.csv").read_text(encoding="utf-8").splitlines()
    assert code == 0 and len(lines) == 1 + len(runs[1].log(1))
    assert lines[0].endswith("cause,start,end") and lines[1].startswith("near,1,")
    code, _, _ = opsim("export", results(), "-o", tmp_path / "figures.csv", "--figures")
    lines = (tmp_path / "figures.csv").read_text(encoding="utf-8").splitlines()
    assert code == 0 and lines[0] == "variant,replication,kpi,subject,part,unit,value" and len(lines) > 10


@pytest.fixture(scope="module")
def run():
    return reopened(results() / "base")


def test_a_performance_comes_back_where_it_was(run, tmp_path):
    log, plan = run.log(1), run.plan
    lift = next(rank for rank, task in enumerate(plan.tasks) if task.name == "lift")
    row = int(np.flatnonzero((log["kind"] == WORK) & (log["task"] == lift) & (log["k"] == 2))[0])
    out = tmp_path / "ana.bvh"
    words = ("export", results(), "--scenario", "base", "--replication", "1", "--worker", "ana", "-o", out)
    code, shown, _ = opsim(*words, "--task", "lift", "--k", "2", "--fps", "50", "--json")
    told = json.loads(shown)
    performance = performance_again(log, plan, row)
    frames = round(performance.duration_s * 50) + 1
    assert code == 0 and told["frames"] == frames and told["start_s"] == performance.start_s
    file = read_bvh_file(out)
    assert len(file.values) == frames and file.frame_time_s == pytest.approx(0.02)
    expected = performance.positions_m(times_s=np.arange(frames) / 50)
    take = read_bvh(out)
    order = [take.names.index(name) for name in performance.skeleton.names]
    assert np.abs(take.positions_m[:, order] - expected).max() < 1e-6


def test_what_is_performed_at_a_time_is_that_performance(run, tmp_path):
    log, plan = run.log(), run.plan
    lift = next(rank for rank, task in enumerate(plan.tasks) if task.name == "lift")
    row = int(np.flatnonzero((log["kind"] == WORK) & (log["task"] == lift) & (log["k"] == 3))[0])
    middle_s = float(log["start_s"][row] + log["end_s"][row]) / 2
    words = ("export", results() / "base", "--worker", "ana")
    for way in (("--at", f"{middle_s} s"), ("--task", "lift", "--k", "3")):
        code, _, _ = opsim(*words, *way, "-o", tmp_path / f"{len(way)}.bvh")
        assert code == 0
    assert (tmp_path / "2.bvh").read_bytes() == (tmp_path / "4.bvh").read_bytes()


def test_a_walk_goes_as_far_as_it_was_and_takes_as_long(run, tmp_path):
    from opsim.history import walks_of

    walks = walks_of(run.log(), run.plan)
    k = int(np.flatnonzero(np.isclose(walks.distance_m, 6.0))[1])
    code, shown, _ = opsim(
        "export", results() / "base", "-o", tmp_path / "walk.bvh", "--worker", "ana", "--walk", "--k", k
    )
    take = read_bvh(tmp_path / "walk.bvh")
    pelvis = take.positions_m[:, take.names.index("pelvis"), :2]
    assert code == 0 and "walk" in shown
    assert np.linalg.norm(pelvis[-1] - pelvis[0]) == pytest.approx(6.0, abs=0.1)
    assert (len(pelvis) - 1) / 60 == pytest.approx(walks.whole_s[k], abs=1 / 60)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("-o", "x.bvz"), "found the ending '.bvz'"),
        (("-o", "x.json", "--scenario", "bse"), "did you mean 'base'?"),
        (("-o", "x.json", "--replication", "7"), "expected numbers from 0 to 1"),
        (("-o", "x.json", "--replication", "one"), "found no number"),
        (("-o", "x.json", "--worker", "ana"), "--worker is for bvh, not for ocel-json"),
        (("-o", "x.json", "--date", "2026-01-06"), "found a Tuesday"),
        (("-o", "x.json", "--figures"), "--figures is for parquet and csv"),
        (("-o", "x.csv", "--figures", "--replication", "0"), "leave --replication out"),
        (("-o", "x.bvh", "--worker", "ana", "--task", "lift"), "found several variants (base, near)"),
        (("-o", "x.bvh", "--scenario", "base"), "found no --worker"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana"), "expected one of --task TASK --k N"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "anna", "--task", "lift"), "did you mean 'ana'?"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--task", "lft"), "did you mean 'lift'?"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--task", "label"), "a time without a body"),
        (
            ("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--task", "lift", "--k", "9999"),
            "no performance 9999",
        ),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--at", "Mon 06:00"), "outside the run"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--at", "soon"), "cannot read 'soon'"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--at", "99:15"), "--at: cannot read '99:15'"),
        (("-o", "x.bvh", "--scenario", "base", "--worker", "ana", "--at", "Tus 6:15"), "did you mean 'Tue'?"),
    ],
)
def test_mistakes_are_told_in_words_and_nothing_is_written(words, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, told = opsim("export", results(), *words)
    assert code == 2 and says in told
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", ["csv", "parquet", "jsonocel", "sqlite"])
def test_rows_that_are_gone_are_missed_in_one_sentence_and_figures_are_still_there(form, tmp_path):
    own = shutil.copytree(results(), tmp_path / "own")
    shutil.rmtree(own / "base" / "events")
    (own / "near" / "events" / "replication_00000.parquet").unlink()
    code, _, told = opsim("export", own, "-o", tmp_path / f"x.{form}", "--replication", "0")
    assert code == 2 and told.splitlines() == [
        f"{own / 'base'}: no rows of events here, expected events/replication_00000.parquet; run it again",
        f"{own / 'near' / 'events'}: found no rows of replication 0, expected 0 to 1; run it again",
    ]
    assert not (tmp_path / f"x.{form}").exists()
    assert opsim("export", own, "-o", tmp_path / "figures.csv", "--figures")[0] == 0


def test_mistakes_are_told_all_at_once(tmp_path):
    words = ("-o", tmp_path / "x.bvz", "--scenario", "bse", "--date", "2026-01-07")
    code, _, told = opsim("export", results(), *words)
    assert code == 2 and len(told.strip().splitlines()) == 3


def test_results_are_not_written_over(tmp_path):
    for file in ("kpis.parquet", "events/replication_00000.parquet"):
        code, _, told = opsim("export", results(), "-o", results() / "base" / file)
        assert code == 2 and "found the result that is read" in told
    code, _, told = opsim("export", tmp_path, "-o", tmp_path / "x.json")
    assert code == 2 and "no results here" in told


def test_without_a_query_tables_columns_and_examples_are_listed_and_the_examples_run():
    code, shown, _ = opsim("sql", results())
    assert code == 0 and all(f"{table.name}: {table.says}" in shown for table in TABLES)
    assert len(EXAMPLES) == 3
    for _, query in EXAMPLES:
        assert query in shown
        assert opsim("sql", results(), query)[0] == 0
    code, shown, _ = opsim("sql", results(), "--json")
    assert code == 0 and [table["table"] for table in json.loads(shown)["tables"]] == [table.name for table in TABLES]


def test_an_answer_is_a_table_csv_json_or_a_file(tmp_path):
    query = "SELECT variant, count(*) AS n, '=1' AS x FROM runs GROUP BY ALL ORDER BY ALL"
    code, shown, _ = opsim("sql", results(), query)
    assert code == 0 and "variant" in shown and "2 rows" in shown
    code, shown, _ = opsim("sql", results(), query, "--csv")
    assert code == 0 and list(csv.reader(io.StringIO(shown)))[1:] == [["base", "1", "'=1"], ["near", "1", "'=1"]]
    code, shown, _ = opsim("sql", results(), query, "--json")
    assert code == 0 and json.loads(shown) == {
        "columns": ["variant", "n", "x"],
        "rows": [["base", 1, "=1"], ["near", 1, "=1"]],
        "n": 2,
    }
    code, shown, _ = opsim("sql", results(), query, "-o", tmp_path / "a.csv")
    assert (
        code == 0 and "2 rows" in shown and (tmp_path / "a.csv").read_text() == "variant,n,x\nbase,1,'=1\nnear,1,'=1\n"
    )


def test_one_variant_can_be_asked_alone():
    code, shown, _ = opsim("sql", results(), "SELECT DISTINCT variant FROM events", "--scenario", "near", "--json")
    assert code == 0 and json.loads(shown)["rows"] == [["near"]]


def test_only_the_first_rows_of_many_are_shown():
    code, shown, _ = opsim("sql", results(), "SELECT * FROM range(1000)")
    assert code == 0 and "1,000 rows, the first 200 are shown" in shown
    assert [line.strip() for line in shown.splitlines()].count("199") == 1 and "\n   200 " not in shown


def test_mistakes_are_told_in_words_with_exit_code_2(tmp_path):
    for words, says in (
        (("SELECT wroker FROM events",), "the nearest name: worker"),
        (("SELECT 1; SELECT 2",), "expected one SELECT"),
        (("SELECT 1", "--scenario", "nearr"), "did you mean 'near'?"),
        (("SELECT 1", "-o", tmp_path / "x.txt"), "expected .csv or .parquet"),
        (("SELECT 1 AS x", "-o", results() / "base" / "kpis.parquet"), "found the result that is read"),
    ):
        code, shown, told = opsim("sql", results(), *words)
        assert code == 2 and says in told and not shown
    code, _, told = opsim("sql", tmp_path, "SELECT 1")
    assert code == 2 and "no results here" in told


def test_text_in_an_answer_steers_no_terminal():
    code, shown, _ = opsim("sql", results(), "SELECT chr(27) || '[31mred' AS x, '[bold]no markup[/bold]' AS y")
    assert code == 0 and "\x1b" not in shown and "[bold]no markup[/bold]" in shown


@pytest.fixture
def own(tmp_path):
    """The results in a folder of one's own."""
    return shutil.copytree(results(), tmp_path / "own")


def test_events_that_are_gone_are_asked_in_vain_and_all_else_is_answered(own):
    shutil.rmtree(own / "base" / "events")
    code, shown, told = opsim("sql", own, "SELECT count(*) FROM events")
    assert code == 2 and not shown and f"{own / 'base'}: no rows of events here" in told
    assert opsim("sql", own, "SELECT count(*) FROM kpis")[0] == 0 == opsim("sql", own, "SHOW TABLES")[0]
    assert opsim("sql", own, "SELECT count(*) FROM events", "--scenario", "near")[0] == 0
    (own / "near" / "events" / "replication_00000.parquet").unlink()
    code, _, told = opsim("sql", own, "SELECT count(*) FROM events", "--scenario", "near")
    assert code == 2 and "found no rows of replication 0, expected 0 to 1; run it again" in told


@pytest.mark.parametrize("file", ["kpis.parquet", *(f"events/replication_0000{n}.parquet" for n in (0, 1))])
def test_a_file_that_is_cut_off_is_named(own, file):
    cut = own / "base" / file
    cut.write_bytes(cut.read_bytes()[:300])
    code, shown, told = opsim("sql", own, f"SELECT count(*) FROM {'kpis' if 'kpis' in file else 'events'}")
    assert code == 2 and not shown and str(cut) in told


def test_the_tables_of_a_run_without_any_events_are_still_described(own):
    for name in ("base", "near"):
        shutil.rmtree(own / name / "events")
    query = "SELECT count(*) AS n FROM duckdb_columns() WHERE table_name LIKE 'event_'"
    code, shown, _ = opsim("sql", own, query, "--json")
    assert code == 0 and json.loads(shown)["rows"] == [[len(TABLES[0].columns)]]


def test_a_table_that_is_not_there_has_one_nearest_name():
    _, _, told = opsim("sql", results(), "SELECT * FROM kpsi")
    assert "the nearest name: kpis" in told and "Did you mean" not in told
