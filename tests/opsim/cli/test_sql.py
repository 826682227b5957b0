import csv
import io
import json
import shutil

import pytest

from opsim.export.sql import EXAMPLES, TABLES
from tests.opsim.cli.calls import opsim
from tests.opsim.export.made_results import results


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
