import duckdb
import pytest

from opsim.export.sql import EXAMPLES, TABLES, WrongQuery, answer, fill, write_answer
from opsim.log_parquet import read_events
from tests.opsim.export.made_results import variants


def test_events_are_those_of_every_variant_and_replication():
    held = variants()
    expected = [
        (name, n, len(read_events(file))) for name, one in held.items() for n, file in enumerate(one.events_files)
    ]
    columns, rows, n = answer(held, "SELECT variant, replication, count(*) AS n FROM events GROUP BY ALL ORDER BY ALL")
    assert columns == ["variant", "replication", "n"] and rows == expected and n == 4


def test_figures_are_those_of_the_results():
    held = variants()
    table = held["near"].kpis()
    _, rows, _ = answer(held, "SELECT replication, value FROM kpis WHERE variant = 'near' AND kpi = 'throughput_per_h'")
    assert dict(rows) == table["throughput_per_h", "", "", "1/h"]


def test_runs_tasks_workers_and_stations_are_as_the_scenario_says():
    held = variants()
    assert answer(held, "SELECT variant, seed, replications, start FROM runs")[1] == [
        ("base", 7, 2, "Tue 06:00"),
        ("near", 7, 2, "Tue 06:00"),
    ]
    assert answer(held, "SELECT DISTINCT worker, height_m, mass_kg FROM workers")[1] == [("ana", 1.62, 58.0)]
    assert answer(held, "SELECT place, tasks FROM stations WHERE station = 'pack'")[1][0] == ("there", "label")
    assert dict(answer(held, "SELECT task, emulated FROM tasks WHERE variant = 'base'")[1]) == {
        "lift": True,
        "label": False,
    }


@pytest.mark.parametrize("query", [query for _, query in EXAMPLES])
def test_the_worked_examples_have_answers(query):
    columns, rows, _ = answer(variants(), query)
    assert columns and rows


def test_the_tables_have_the_columns_that_are_listed():
    held = variants()
    with duckdb.connect() as connection:
        for table in TABLES:
            fill(connection, table, held)
            found = connection.execute(f"DESCRIBE {table.name}").fetchall()
            assert [name for name, *_ in found] == [name for name, *_ in table.columns]
    names = [name for (name,) in answer(held, "SHOW TABLES")[1]]
    assert names == sorted(table.name for table in TABLES)


def test_of_a_long_answer_the_first_rows_are_given_and_all_are_counted():
    held = variants()
    _, rows, n = answer(held, "SELECT * FROM events", most=5)
    assert len(rows) == 5 and n == answer(held, "SELECT count(*) FROM events")[1][0][0]
    assert answer(held, "SELECT * FROM range(5)", most=5)[2] == 5
    assert answer(held, "SELECT * FROM range(3)", most=5)[2] == 3


WRITES = (
    "COPY (SELECT 1 AS kpis) TO '{file}'",
    "WITH x AS (COPY (SELECT 1 AS kpis) TO '{file}') FROM x",
    "EXPLAIN ANALYZE COPY (SELECT 1 AS kpis) TO '{file}'",
    "SELECT 1 AS kpis; COPY (SELECT 1) TO '{file}'",
    "SELECT 1 AS kpis) TO '{file}' (FORMAT parquet) --",
    "EXPORT DATABASE '{file}'",
    "ATTACH '{file}' AS kpis",
    "CREATE TABLE kpis AS SELECT 1",
    "INSERT INTO runs SELECT * FROM runs",
    "WITH x AS (INSERT INTO runs SELECT * FROM runs RETURNING *) FROM x",
    "DELETE FROM runs",
    "DROP VIEW kpis",
    "SET enable_external_access = true",
    "PRAGMA database_list",
    "INSTALL httpfs",
    "LOAD httpfs",
    "CALL pragma_version()",
    "SELECT * FROM query('COPY kpis TO ''{file}''')",
)


@pytest.mark.parametrize("query", WRITES)
@pytest.mark.parametrize("form", [None, "parquet", "csv"])
def test_nothing_but_one_question_is_answered_and_results_stay_as_they_are(query, form, tmp_path):
    held = variants()
    file = held["base"].kpis_file
    before = {path: path.read_bytes() for path in sorted(held["base"].folder.rglob("*")) if path.is_file()}
    with pytest.raises(WrongQuery):
        if form is None:
            answer(held, query.format(file=file))
        else:
            write_answer(held, query.format(file=file), tmp_path / "out", form)
    assert {path: path.read_bytes() for path in sorted(held["base"].folder.rglob("*")) if path.is_file()} == before
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "query",
    [
        "SELECT * FROM read_csv('{file}')",
        "SELECT * FROM read_text('{file}')",
        "SELECT * FROM '{file}'",
        "SELECT * FROM glob('{folder}/*')",
        "SELECT * FROM read_parquet('http://localhost/x.parquet')",
        "SELECT * FROM held",
        "SELECT getenv('HOME')",
    ],
)
def test_no_other_file_or_variable_is_within_reach(query, tmp_path):
    (tmp_path / "secret.csv").write_text("a\n1\n")
    held = variants()
    with pytest.raises(WrongQuery):
        answer(held, query.format(file=tmp_path / "secret.csv", folder=tmp_path))


def test_a_mistake_is_told_in_duckdbs_words_with_its_place_and_the_nearest_name():
    with pytest.raises(WrongQuery) as told:
        answer(variants(), "SELECT variant\nFROM events WHERE wroker = 'ana'")
    assert 'Referenced column "wroker" not found' in str(told.value)
    assert "LINE 2: FROM events WHERE wroker = 'ana'" in str(told.value)
    assert str(told.value).endswith("the nearest name: worker")
    with pytest.raises(WrongQuery, match="the nearest name: events"):
        answer(variants(), "SELECT * FROM event")
    with pytest.raises(WrongQuery, match="text stands in single quotes: 'work'"):
        answer(variants(), "SELECT * FROM events WHERE kind = work")
    with pytest.raises(WrongQuery, match="found nothing"):
        answer(variants(), "-- nothing")


def test_an_answer_goes_to_a_file_whole(tmp_path):
    n = write_answer(
        variants(), "SELECT worker, -1.5 AS x, now() AS t FROM workers; -- done", tmp_path / "a.parquet", "parquet"
    )
    assert n == 2 and duckdb.sql(f"SELECT worker, x FROM '{tmp_path / 'a.parquet'}'").fetchall()[0][0] == "ana"
    write_answer(variants(), "SELECT '=1' AS a, -1 AS b, NULL AS c", tmp_path / "a.csv", "csv")
    assert (tmp_path / "a.csv").read_text() == "a,b,c\n'=1,-1,\n"
    with pytest.raises(WrongQuery):
        write_answer(variants(), "SELECT error('no')", tmp_path / "b.csv", "csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.parquet"]


def test_times_with_a_zone_are_text():
    _, rows, _ = answer(variants(), "SELECT TIMESTAMPTZ '2026-01-05 06:00:00+00' AS t, 2 AS n")
    assert rows[0][0].startswith("2026-01-05") and rows[0][1] == 2
