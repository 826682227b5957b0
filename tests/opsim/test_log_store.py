import numpy as np
from plans import CELL, loaded

from opsim.engine.floor import run_plan
from opsim.log_parquet import connect, one_database, read_events, write_events
from opsim.plan import compile_plan


def test_many_files_through_one_database_are_the_same_files(tmp_path):
    logs = [run_plan(compile_plan(loaded(CELL.replace("2 h", "20 min"))), replication) for replication in range(2)]
    for number, log in enumerate(logs):
        write_events(log, tmp_path / f"apart_{number}")
    with one_database(), one_database():
        for number, log in enumerate(logs):
            write_events(log, tmp_path / f"together_{number}")
            assert len(read_events(tmp_path / f"together_{number}")) == len(log)
    for number in range(2):
        assert (tmp_path / f"together_{number}").read_bytes() == (tmp_path / f"apart_{number}").read_bytes()


def test_tables_of_one_connection_are_not_seen_by_the_next(tmp_path):
    with one_database():
        for _ in range(2):
            with connect() as connection:
                connection.register("some_rows", {"one": np.arange(3)})
                assert connection.execute("SELECT count(*) FROM some_rows").fetchall() == [(3,)]
        with connect() as connection:
            found = connection.execute("SELECT count(*) FROM duckdb_views() WHERE NOT internal").fetchall()
    assert found == [(0,)]
