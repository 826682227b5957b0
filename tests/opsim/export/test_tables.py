import csv
import re
from datetime import date, datetime, timedelta
from pathlib import Path

import duckdb
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim import log as kinds
from opsim.export.ocel_objects import station_changes, worker_changes
from opsim.export.sql import EXAMPLES, TABLES, WrongQuery, answer, fill, write_answer
from opsim.export.tables import (
    CSV,
    DANGEROUS,
    MONDAY,
    PARQUET,
    RunClock,
    at_time,
    guarded,
    identifier,
    monday_of,
    out_for,
    performance_of,
    run_s,
    start_of,
    walk_of,
    write_rows,
)
from opsim.history import walk_rows
from opsim.log import SETUP, WALK, WORK, WORKER_KINDS
from opsim.log_parquet import read_events, write_events
from tests.opsim.export.hostile import HARMFUL, hostile
from tests.opsim.export.made_export import MANY, ran
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


CONNECTION = duckdb.connect()
"""One for all examples: to open a database costs more than to ask it."""
BEGINS = st.sampled_from(["", "=", "+", "-", "@", " =", "\t", "\r\n@", "a="])


@given(st.builds(str.__add__, BEGINS, st.text(max_size=6)))
def test_no_text_is_a_formula_and_an_apostrophe_is_all_that_is_added(text):
    query = f"SELECT {guarded('name', 'VARCHAR')} FROM (SELECT ? AS name)"
    (found,) = CONNECTION.execute(query, [text]).fetchone()
    assert found in (text, f"'{text}")
    assert found.lstrip(" \t\r\n\f\v")[:1] not in ("=", "+", "-", "@") or found.startswith("'")
    assert (found != text) == bool(re.search(DANGEROUS, text))


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "\t=1", "\rname"])
def test_what_a_spreadsheet_would_compute_is_guarded(text):
    query = f"SELECT {guarded('name', 'VARCHAR')} FROM (SELECT ? AS name)"
    assert CONNECTION.execute(query, [text]).fetchone() == (f"'{text}",)


def test_numbers_stay_numbers():
    assert guarded("value", "DOUBLE") == '"value"'


def test_a_column_with_quotes_in_its_name_is_one_name():
    assert identifier('a"b') == '"a""b"'


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Two replications of a variant, one of another."""
    folder = tmp_path_factory.mktemp("rows")
    log, plan = hostile(*ran("pump_plant"))
    made = {"base": ["base0", "base1"], "=near": ["near0"]}
    for name in (name for names in made.values() for name in names):
        write_events(log, folder / f"{name}.parquet")
    return log, plan, {variant: [folder / f"{name}.parquet" for name in names] for variant, names in made.items()}


def test_all_rows_of_all_files_stand_in_their_order(files, tmp_path):
    log, _, made = files
    n = write_rows(made, tmp_path / "rows.parquet", PARQUET)
    rows = duckdb.sql(f"SELECT variant, start_s, worker FROM '{tmp_path / 'rows.parquet'}'").fetchall()
    assert n == len(rows) == 3 * len(log)
    assert [variant for variant, *_ in rows] == ["base"] * 2 * len(log) + ["=near"] * len(log)
    assert [start_s for _, start_s, _ in rows] == 3 * log["start_s"].tolist()
    assert {worker for *_, worker in rows} - {None} >= set(HARMFUL)  # Parquet has names as they are


def test_a_csv_has_no_cell_that_a_spreadsheet_would_compute(files, tmp_path):
    log, _, made = files
    assert write_rows(made, tmp_path / "rows.csv", CSV) == 3 * len(log)
    with (tmp_path / "rows.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * len(log)
    text = {row[name] for row in rows for name in ("variant", "worker", "station", "task", "place_to", "source")}
    assert not [cell for cell in text if cell[:1] in ("=", "+", "-", "@", "\t")]
    assert {"'=near", '\'=HYPERLINK("http://x")', "<script>alert(1)</script>"} <= text
    assert [float(row["start_s"]) for row in rows[: len(log)]] == log["start_s"].tolist()


def test_times_of_the_calendar_stand_beside_those_of_the_run(files, tmp_path):
    log, plan, made = files
    clock = RunClock(plan.start_s)
    write_rows(made, tmp_path / "rows.parquet", PARQUET, dict.fromkeys(made, clock))
    query = (
        f"SELECT strftime(\"end\", '%Y-%m-%dT%H:%M:%S.%fZ') FROM '{tmp_path / 'rows.parquet'}' WHERE variant = '=near'"
    )
    assert [text for (text,) in duckdb.sql(query).fetchall()] == clock.texts(log["end_s"])


def test_the_same_rows_give_the_same_bytes(files, tmp_path):
    for form in (PARQUET, CSV):
        for name in "ab":
            write_rows(files[2], tmp_path / f"{name}.{form}", form)
        assert (tmp_path / f"a.{form}").read_bytes() == (tmp_path / f"b.{form}").read_bytes()


def test_of_several_files_each_has_its_variant_and_replication_before_the_ending():
    out = Path("some/log.jsonocel")
    assert out_for(out) == out
    assert out_for(out, variant="near") == Path("some/log_near.jsonocel")
    assert out_for(out, variant="near", replication=12) == Path("some/log_near_r00012.jsonocel")


def test_the_run_begins_on_its_day_of_the_week_of_a_stated_monday():
    tuesday_six = 86_400.0 + 6 * 3600.0
    assert date(2026, 1, 5) == MONDAY and MONDAY.weekday() == 0
    assert RunClock(tuesday_six).texts(np.array([0.0, 90.5])) == [
        "2026-01-06T06:00:00.000000Z",
        "2026-01-06T06:01:30.500000Z",
    ]


@given(st.lists(st.floats(0, 1e7), max_size=20), st.floats(0, 604_799))
def test_every_time_is_right_to_the_microsecond_and_in_its_own_order(times_s, start_s):
    texts = RunClock(start_s).texts(np.array(times_s))
    began = datetime(2026, 1, 5)
    for text, time_s in zip(texts, times_s, strict=True):
        exact_us = round(start_s * 1e6) + round(time_s * 1e6)
        assert (datetime.fromisoformat(text[:-1]) - began) // timedelta(microseconds=1) == exact_us


@pytest.mark.parametrize(
    ("text", "says"), [("2026-01-06", "Tuesday"), ("2026-13-01", "no date"), ("Monday", "no date")]
)
def test_another_day_than_a_monday_is_refused_with_one_that_is(text, says):
    with pytest.raises(ValueError, match=says):
        monday_of(text)
    with pytest.raises(ValueError, match="such as 2026-01-05"):
        monday_of("2026-01-06")
    assert monday_of("2026-03-02") == date(2026, 3, 2)


FIRST_OF = (
    (kinds.WORK, "work"),
    (kinds.SETUP, "set up"),
    (kinds.OFF, "closed"),
    (kinds.REPAIR, "repair"),
    (kinds.DOWN, "down"),
    (kinds.BLOCKED, "blocked"),
    (kinds.HELD, "waiting"),
)


def naive_station(log, rank, time_s):
    """What a station is doing at a time, row by row."""
    here = (log["station"] == rank) & (log["start_s"] <= time_s) & (time_s < log["end_s"])
    for kind, word in FIRST_OF:
        of_station = kind in kinds.STATION_KINDS
        alone = (log["job"] < 0) & (log["worker"] < 0)
        if np.any(here & (log["kind"] == kind) & (alone if of_station else log["job"] >= 0)):
            return word
    return "starved"


def at(changes, time_s):
    return [word for from_s, word in changes if from_s <= time_s][-1]


@pytest.mark.parametrize("name", MANY)
def test_stations_are_doing_what_their_rows_say_at_any_time(name):
    log, plan = ran(name)
    times_s = np.random.default_rng(0).uniform(0, log.horizon_s, 25)
    for rank, (point, changes) in enumerate(zip(plan.stations, station_changes(log, plan), strict=True)):
        if point.kind != "station":
            assert changes == []
            continue
        assert changes[0][0] == 0.0
        for time_s in times_s:
            assert at(changes, time_s) == naive_station(log, rank, time_s)


@pytest.mark.parametrize("name", MANY)
def test_workers_are_doing_what_their_rows_say_at_any_time(name):
    log, plan = ran(name)
    words = {kinds.OFF: "off duty", kinds.SETUP: "set up"}
    for rank, changes in enumerate(worker_changes(log, plan)):
        assert changes[0][0] == 0.0
        for time_s in np.random.default_rng(rank).uniform(0, log.horizon_s, 25):
            own = np.flatnonzero(
                (log["worker"] == rank)
                & np.isin(log["kind"], kinds.WORKER_KINDS)
                & (log["start_s"] <= time_s)
                & (time_s < log["end_s"])
            )
            kind = int(log["kind"][own[0]])
            assert at(changes, time_s) == words.get(kind, kinds.KINDS[kind])


TUESDAY_SIX = 86_400.0 + 6 * 3600.0


@pytest.mark.parametrize(
    ("text", "found_s"),
    [
        ("Tue 06:00", 0.0),
        ("Tue 10:15:30", 4 * 3600 + 15 * 60 + 30),
        ("Tuesday 10:15:30.5", 4 * 3600 + 15 * 60 + 30.5),
        ("tue 6:01", 60.0),
        ("10:00", 4 * 3600.0),
        ("05:00", 23 * 3600.0),
        ("Wed 05:00", 23 * 3600.0),
        ("95 min", 5700.0),
        ("12.5 s", 12.5),
    ],
)
def test_a_time_of_the_week_is_the_first_such_time_of_the_run(text, found_s):
    assert run_s(text, TUESDAY_SIX, 86_400.0) == found_s


@pytest.mark.parametrize("text", ["Mon 06:00", "Wed 07:00", "25 h", "-1 h", "Tus 06:00", "99:15", "soon", "", "12"])
def test_other_times_are_refused_in_words(text):
    with pytest.raises(ValueError, match="--at"):
        run_s(text, TUESDAY_SIX, 86_400.0)


def test_the_start_is_read_as_a_summary_says_it():
    assert start_of("Tue 06:00") == TUESDAY_SIX


@pytest.fixture(scope="module")
def done():
    return ran("two_shift_plant", "4 h")


def test_a_performance_is_all_its_pieces_in_order(done):
    log, plan = done
    work = np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0) & (log["k"] >= 0))
    for row in work[::50].tolist():
        worker, task = plan.workers[log["worker"][row]].name, plan.tasks[log["task"][row]].name
        which = performance_of(log, plan, worker, task, int(log["k"][row]))
        assert row in which.rows.tolist() and not which.walk
        assert np.all(np.diff(log["start_s"][which.rows]) > 0)
        assert np.all(log["progress_from"][which.rows[1:]] == log["progress_to"][which.rows[:-1]])


def test_walks_are_counted_as_they_are_drawn(done):
    log, plan = done
    rows = walk_rows(log)
    for worker in plan.workers[:3]:
        own = rows[log["worker"][rows] == plan.workers.index(worker)]
        if own.size:
            assert walk_of(log, plan, worker.name, own.size - 1).rows.tolist() == [own[-1]]
            with pytest.raises(ValueError, match=f"0 to {own.size - 1}"):
                walk_of(log, plan, worker.name, own.size)


def test_at_a_time_it_is_what_the_worker_does_then_and_at_an_edge_what_begins(done):
    log, plan = done
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    seen = set()
    for row in rows[::17].tolist():
        worker, start_s, end_s = plan.workers[log["worker"][row]].name, log["start_s"][row], log["end_s"][row]
        for time_s in (float(start_s), float((start_s + end_s) / 2)):
            if log["kind"][row] in (WORK, SETUP, WALK):
                which = at_time(log, plan, worker, time_s)
                assert row in which.rows.tolist() and which.walk == (log["kind"][row] == WALK)
            else:
                with pytest.raises(ValueError, match="performs nothing then"):
                    at_time(log, plan, worker, time_s)
            seen.add(int(log["kind"][row]))
    assert {WORK, WALK} <= seen and len(seen) > 3


def test_who_and_what_is_not_there_is_answered_with_the_nearest(done):
    log, plan = done
    worker, task = plan.workers[0].name, plan.tasks[0].name
    with pytest.raises(ValueError, match=f"did you mean '{worker}'"):
        performance_of(log, plan, worker + "x", task, 0)
    with pytest.raises(ValueError, match=f"did you mean '{task}'"):
        performance_of(log, plan, worker, task + "x", 0)
    done_by = plan.tasks[log["task"][np.flatnonzero((log["kind"] == WORK) & (log["worker"] == 0))[0]]].name
    with pytest.raises(ValueError, match="found no performance 999999, expected one of 0"):
        performance_of(log, plan, worker, done_by, 999_999)
