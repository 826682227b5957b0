import re
import sys

import numpy as np
import pytest
from plans import CELL, plan

from opsim.engine.floor import run_plan
from opsim.files import write_text
from opsim.log import COLUMNS, ORDER, EventLog, event_log, row
from opsim.log_parquet import read_events, write_events


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


def test_rows_that_tie_are_in_the_order_of_all_keys():
    generator = np.random.default_rng(1)
    rows = [row(*map(int, generator.integers(0, 3, len(COLUMNS) - 1)), 0) for _ in range(3000)]
    log = event_log(rows, 10.0, {})
    keys = [tuple(log[column][i] for column in ORDER) for i in range(len(log))]
    assert keys == sorted(keys)
    assert len(set(keys)) < len(keys)


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
    from opsim import log_parquet as log_store

    monkeypatch.setattr(log_store, "ROW_GROUP", "many")
    with pytest.raises(Exception, match=r"(?i)row_group|many|parse|cast|convert"):
        write_events(log, tmp_path / "events.parquet")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("damage", [lambda whole: b"", lambda whole: whole[:200], lambda whole: whole[100:] * 2])
def test_a_damaged_file_is_an_oserror_that_names_it(log, tmp_path, damage):
    path = tmp_path / "events.parquet"
    write_events(log, path)
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(OSError, match=re.escape(str(path))):
        read_events(path)


def test_rows_of_another_run_are_refused_where_one_is_asked_for(log, tmp_path):
    write_events(log, tmp_path / "events.parquet", "run a")
    assert equal(read_events(tmp_path / "events.parquet", "run a"), log)
    with pytest.raises(OSError, match="another run"):
        read_events(tmp_path / "events.parquet", "run b")


@pytest.mark.skipif(sys.platform == "win32", reason="needs a limit on the size of files")
def test_a_full_disk_is_said_with_the_final_name_and_leaves_nothing(log, tmp_path):
    import resource

    path, limits = tmp_path / "events.parquet", resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, limits[1]))
    try:
        with pytest.raises(OSError, match="the disk is full") as caught:
            write_events(log, path)
        with pytest.raises(OSError) as written:
            write_text(tmp_path / "report.html", "x" * 10_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert str(path) in str(caught.value) and ".part" not in str(caught.value)
    assert written.value.filename == str(tmp_path / "report.html")
    assert list(tmp_path.iterdir()) == []
