import csv
import io
import json

from opsim.export.sql_tables import EXAMPLES, TABLES
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
