import csv

import duckdb
import pytest

from opsim.export.tables import CSV, PARQUET, RunClock, write_rows
from opsim.log_parquet import write_events
from tests.opsim.export.hostile import HARMFUL, hostile
from tests.opsim.export.made_export import ran


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
