import numpy as np
import pytest
from plans import CELL, plan

from opsim.engine.simpy_engine import run_plan
from opsim.log import COLUMNS, ORDER, EventLog, LogWriter, event_log
from opsim.log_store import read_events, write_events


@pytest.fixture(scope="module")
def log():
    return run_plan(plan(CELL))


def equal(a, b) -> bool:
    return a.names == b.names and all(np.array_equal(a[c], b[c], equal_nan=a[c].dtype.kind == "f") for c in COLUMNS)


def test_rows_are_sorted_whatever_order_they_come_in(log):
    rows = list(zip(*(log[column].tolist() for column in COLUMNS)))
    shuffled = [rows[i] for i in np.random.default_rng(0).permutation(len(rows))]
    again = event_log(shuffled, log.horizon_s, log.names)
    assert all(np.array_equal(again[column], log[column]) for column in ORDER)


def test_chunks_change_nothing(log, monkeypatch):
    rows = list(zip(*(log[column].tolist() for column in COLUMNS)))
    monkeypatch.setattr("opsim.log.CHUNK_ROWS", 7)
    writer = LogWriter()
    for row in rows:
        writer.append(row)
    assert equal(writer.close(0, log.horizon_s, log.names), log)


def test_parquet_gives_back_what_was_written(log, tmp_path):
    write_events(log, tmp_path / "events.parquet")
    assert equal(read_events(tmp_path / "events.parquet"), log)
    assert [p.name for p in tmp_path.iterdir()] == ["events.parquet"]


def test_the_same_log_gives_the_same_bytes(log, tmp_path):
    for name in ("a", "b"):
        write_events(log, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_names_with_quotes_survive(log, tmp_path):
    odd = ("o'hara", 'x"; DROP TABLE', "\u00e9\u732b")
    named = EventLog(log.replication, log.horizon_s, log.columns, {**log.names, "worker": odd})
    write_events(named, tmp_path / "events.parquet")
    assert equal(read_events(tmp_path / "events.parquet"), named)


def test_a_foreign_parquet_file_is_refused(tmp_path):
    import duckdb

    path = tmp_path / "other.parquet"
    duckdb.sql("select 1 as a").write_parquet(str(path))
    with pytest.raises(OSError, match="not an event log"):
        read_events(path)


def test_a_failed_write_leaves_nothing(log, tmp_path, monkeypatch):
    from opsim import log_store

    monkeypatch.setattr(log_store, "ROW_GROUP", "many")
    with pytest.raises(Exception, match=r"(?i)row_group|many|parse|cast|convert"):
        write_events(log, tmp_path / "events.parquet")
    assert list(tmp_path.iterdir()) == []
