"""What becomes of the rest of a performance that was broken off."""

import re
import sys
from dataclasses import replace

import numpy as np
import pytest
import simpy
from hypothesis import given
from hypothesis import strategies as st
from plans import CELL, loaded, plan

from opsim import Worker, WorkerLog
from opsim import read_events as read_events_of_worker_log
from opsim import write_events as write_events_of_worker_log
from opsim.clock import on_grid
from opsim.csv_input import RecordedError, read_times, resolve_times
from opsim.engine.floor.run import run_plan
from opsim.external_log import CHECKS, audit_work
from opsim.files import write_text
from opsim.history import FATES, job_pieces, on_grid_each, walks_of
from opsim.laws.audit import BrokenLog
from opsim.log import COLUMNS, NAMED, ORDER, SETUP, WAIT, WALK, WORK, EventLog, event_log, row
from opsim.log_parquet import connect, one_database, read_events, write_events
from opsim.plan import compile_plan
from opsim.study.compare import compare
from opsim.tasks import Fixed
from tests.opsim.export.made_export import ran
from tests.opsim.export.made_results import variants
from tests.opsim.kpi.made_logs import made, work
from tests.opsim.kpi.made_logs import row as row_of_pieces
from tests.opsim.kpi.made_logs import row as row_of_walks
from tests.opsim.laws.test_laws import FLOOR as FLOOR_of_pieces
from tests.opsim.laws.test_laws import piece


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


def shift(until=None):
    """w10 folds, stops at 4 s and goes on at 9 s; w2 comes at 5 s and tapes. Returns (env, log)."""
    env, log = simpy.Environment(), WorkerLog()
    tasks = {"fold": Fixed(10.0), "tape": Fixed(3.0)}
    w10 = Worker(env, "w10", tasks, log=log)

    def folding():
        doing = w10.perform("fold")
        yield env.timeout(4.0)
        doing.interrupt()
        piece = yield doing
        yield env.timeout(5.0)
        yield w10.resume(piece)

    def taping():
        yield env.timeout(5.0)
        w2 = Worker(env, "w2", tasks, log=log)
        yield w2.perform("tape")
        yield w2.perform("tape")

    env.process(folding())
    env.process(taping())
    env.run(until=until)
    return env, log


def rows(log, kind):
    found = log.of(kind)
    return [
        (log.names["worker"][worker], float(start_s), float(end_s))
        for worker, start_s, end_s in zip(found["worker"], found["start_s"], found["end_s"])
    ]


def test_rows_say_who_did_what_from_when_to_when():
    log = shift(until=20.0)[1].close()
    assert rows(log, WORK) == [("w10", 0, 4), ("w2", 5, 8), ("w2", 8, 11), ("w10", 9, 15)]
    assert rows(log, WAIT) == [("w10", 4, 9), ("w2", 11, 20), ("w10", 15, 20)]
    work = log.of(WORK)
    assert [log.names["task"][task] for task in work["task"]] == ["fold", "tape", "tape", "fold"]
    assert work["k"].tolist() == [0, 0, 1, 0] and work["performance_id"].tolist() == [0, 1, 2, 0]
    assert work["progress_from"].tolist() == [0, 0, 0, 0.4] and work["progress_to"].tolist() == [0.4, 1, 1, 1]
    assert log.horizon_s == 20.0


def test_names_are_in_natural_order():
    log = shift()[1].close()
    assert log.names["worker"] == ("w2", "w10") and log.names["task"] == ("fold", "tape")


def test_what_is_under_way_is_closed_with_its_progress_and_the_simulation_may_go_on():
    env, log = shift(until=10.0)
    early = log.close()
    assert rows(early, WORK)[-2:] == [("w2", 8, 10), ("w10", 9, 10)]
    assert early.of(WORK)["progress_to"][-2:].tolist() == pytest.approx([2 / 3, 0.5])
    env.run(until=20.0)
    late = log.close()
    assert all(np.array_equal(late[name], shift(until=20.0)[1].close()[name], equal_nan=True) for name in COLUMNS)


def test_an_events_file_reads_back_equal(tmp_path):
    log = shift(until=20.0)[1].close()
    write_events_of_worker_log(log, tmp_path / "events.parquet")
    back = read_events_of_worker_log(tmp_path / "events.parquet")
    assert back.names == log.names and (back.horizon_s, back.replication) == (20.0, 0)
    assert all(np.array_equal(back[name], log[name], equal_nan=True) for name in COLUMNS)


def test_a_log_of_nobody_and_one_of_no_time_are_empty(tmp_path):
    env, log = simpy.Environment(), WorkerLog()
    assert len(log.close()) == 0
    Worker(env, "ana", {"fold": Fixed(1.0)}, log=log)
    empty = log.close()
    assert len(empty) == 0 and empty.names["worker"] == ("ana",)
    write_events_of_worker_log(empty, tmp_path / "empty.parquet")
    assert len(read_events_of_worker_log(tmp_path / "empty.parquet")) == 0


def test_two_workers_of_separate_logs_have_a_log_each():
    env = simpy.Environment()
    ana, ben = (Worker(env, name, {"fold": Fixed(1.0)}) for name in ("ana", "ben"))
    env.run(ana.perform("fold"))
    assert len(ana.log.close()) == 1 and ben.log.close().names["worker"] == ("ben",)


@pytest.mark.parametrize(
    ("column", "row", "value", "said"),
    [
        ("end_s", 0, 3.0, "worker w10: gap between 3 s and 4 s"),
        ("end_s", 0, 5.0, "worker w10: overlap between 5 s and 4 s"),
        ("end_s", -1, 19.0, "gap between 19 s and 20 s"),
        ("progress_from", 4, 0.3, "performance 0: a piece goes from 30% to 100% where 40% was done"),
        ("progress_to", 0, 1.5, "to 150%"),
    ],
)
def test_a_log_that_contradicts_itself_is_refused(column, row, value, said):
    log = shift(until=20.0)[1].close()
    assert audit_work(log) == CHECKS
    changed = log[column].copy()
    changed[row] = value
    with pytest.raises(BrokenLog, match=said):
        audit_work(replace(log, columns={**log.columns, column: changed}))


def test_a_log_as_a_frame_has_its_rows_with_names_as_text():
    pytest.importorskip("pandas")
    log, _ = ran("pump_plant")
    frame = log.to_frame()
    assert list(frame.columns) == ["replication", *COLUMNS] and len(frame) == len(log)
    for name in COLUMNS:
        if name not in NAMED:
            continue
        none = (log[name] < 0) | ((name == "cause") & (log[name] == 0))
        expected = [None if empty else log.names[name][rank] for empty, rank in zip(none, log[name])]
        assert frame[name].astype(object).where(frame[name].notna(), None).tolist() == expected
    assert frame["start_s"].tolist() == log["start_s"].tolist()
    assert frame["job"].isna().tolist() == (log["job"] < 0).tolist()
    assert frame["job"].dropna().tolist() == log["job"][log["job"] >= 0].tolist()


def test_results_as_a_frame_have_every_figure_of_every_replication():
    pytest.importorskip("pandas")
    result = variants()["base"]
    frame, table = result.to_frame(), result.kpis()
    assert len(frame) == sum(map(len, table.values()))
    own = frame[(frame.kpi == "throughput_per_h") & (frame.subject == "")]
    assert dict(zip(own.replication, own.value)) == table["throughput_per_h", "", "", "1/h"]


def test_a_comparison_as_a_frame_has_every_difference_with_its_verdict():
    pytest.importorskip("pandas")
    found = compare(variants(), "base", ())
    frame = found.to_frame()
    assert list(frame.verdict) == [one.verdict for one in found.differences]
    assert np.array_equal(frame.difference, [one.interval.mean for one in found.differences], equal_nan=True)


def test_without_pandas_it_is_said_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    for thing in (ran("pump_plant")[0], variants()["base"], compare(variants(), "base", ())):
        with pytest.raises(ImportError, match=r"pip install opsim\[frames\]"):
            thing.to_frame()


ONE_EACH = "write decimals with a point, and text that holds a comma in quotes"


def times(tmp_path, text, column=None):
    (tmp_path / "times.csv").write_text(text, encoding="utf-8")
    return read_times(resolve_times("times.csv", tmp_path), column)


@pytest.mark.parametrize(
    ("text", "column", "expected"),
    [
        ("3\n4.5\n\n5\n", None, [3.0, 4.5, 5.0]),
        ("duration_s\n3\n4\n", None, [3.0, 4.0]),
        ("worker,duration_s\nana,3\nben,4\n", "duration_s", [3.0, 4.0]),
        ("worker;duration_s\nana;3\n", "duration_s", [3.0]),
        ("1,2\n3,4\n", "2", [2.0, 4.0]),
    ],
)
def test_a_column_is_read_in_its_order(tmp_path, text, column, expected):
    assert times(tmp_path, text, column) == expected


@pytest.mark.parametrize(
    ("text", "column", "said"),
    [
        ("", None, "'times.csv' is empty; fill it, or name another file"),
        ("duration_s\n", None, "'times.csv' holds no times"),
        ("t\n3\n-1\n", None, "'times.csv' line 3: '-1' is not a positive number of seconds"),
        ("t\n3\n\n3 s\n", None, "'times.csv' line 4: '3 s' is not a positive number of seconds"),
        ("t\ninf\n", None, "'times.csv' line 2: 'inf' is not a positive number of seconds"),
        ("t\n1\n1e10\n", None, "'times.csv' line 3: '1e10' is more than 2^33 s (272 years)"),
        ("a,b\n1,2\n", None, "'times.csv' has 2 columns; add 'column:' with one of: a, b"),
        ("duration,b\n1,2\n", "duratoin", "no column 'duratoin' in 'times.csv'; did you mean 'duration'?"),
        (
            "t\n1\n-2\n,\nabc,,\n",
            None,
            "'times.csv' line 3: '-2' is not a positive number of seconds\n"
            "'times.csv' line 5: 'abc' is not a positive number of seconds",
        ),
        ("t\n1,5\n", None, f"'times.csv' line 2: 2 values, the first line has 1; {ONE_EACH}"),
        ("a,b\n1\n", "b", "'times.csv' line 2: '' is not a positive number of seconds"),
    ],
)
def test_a_broken_file_is_answered_with_its_line(tmp_path, text, column, said):
    with pytest.raises(RecordedError) as caught:
        times(tmp_path, text, column)
    assert str(caught.value) == said


def test_a_missing_file_is_answered_with_the_nearest(tmp_path):
    (tmp_path / "times.csv").write_text("1\n")
    with pytest.raises(RecordedError, match=r"no file 'tmes.csv' in the scenario's folder; did you mean 'times.csv'\?"):
        resolve_times("tmes.csv", tmp_path)


@given(raw=st.binary(max_size=60))
def test_any_bytes_are_times_or_a_recorded_error(tmp_path_factory, raw):
    path = tmp_path_factory.mktemp("csv") / "x.csv"
    path.write_bytes(raw)
    try:
        assert min(read_times(path)) > 0
    except RecordedError as error:
        assert error.message


def test_a_file_too_large_to_be_times_is_refused_unread(tmp_path, monkeypatch):
    monkeypatch.setattr("opsim.csv_input.MOST_BYTES", 10)
    with pytest.raises(RecordedError, match=r"'times.csv' is larger than 0 MB"):
        times(tmp_path, "duration_s\n1\n2\n")


FLOOR = """
opsim: 1
name: floor
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 2 m]}}
tasks: {t: {fixed: 10 s}}
stations: {s: {at: b, tasks: [t], buffer: 0}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {walk: 1 m/s, skills: {s: 1.0}}, ben: {walk: 2 m/s, skills: {s: 1.0}}}
"""


def test_walks_are_numbered_by_worker_and_time():
    p = plan(FLOOR)
    walks = walks_of(
        made(
            [
                row_of_walks(WALK, 50, 58, worker=0, places=(0, 2)),
                row_of_walks(WALK, 20, 21, worker=1, places=(2, 1)),
                row_of_walks(WAIT, 10, 20, worker=0),
                row_of_walks(WALK, 3, 9, worker=0, places=(0, 1)),
                row_of_walks(WALK, 97, 100, worker=0, places=(2, 0)),
            ],
            p,
        ),
        p,
    )
    assert walks.worker.tolist() == [0, 0, 0, 1] and walks.k.tolist() == [0, 1, 2, 0]
    assert walks.start_s.tolist() == [3, 50, 97, 20] and walks.end_s.tolist() == [9, 58, 100, 21]
    assert walks.distance_m.tolist() == [6, 8, 8, 2]
    assert walks.whole_s.tolist() == [6, 8, 8, 1]
    assert (walks.place_from.tolist(), walks.place_to.tolist()) == ([0, 0, 2, 2], [1, 2, 0, 1])


def test_nobody_walks():
    p = plan(FLOOR)
    assert walks_of(made([], p), p).k.size == 0


@pytest.mark.parametrize("seconds", [0.0, 1e-9, 0.1, 1 / 3, 4.2, 1e6 / 7])
def test_each_time_is_on_the_grid_of_the_engine(seconds):
    assert on_grid_each(np.array([seconds])).tolist() == [on_grid(seconds)]


def fates(*rows):
    return [FATES[fate] for fate in job_pieces(made(rows, plan(FLOOR_of_pieces))).fate]


@pytest.mark.parametrize(
    ("rest", "fate"),
    [
        (piece(50, 56, 0.4, 1), "resumed"),
        (piece(4, 10, 0.4, 1), "resumed"),
        (piece(50, 56, 0.4, 1, worker=1, performance=1), "by_another"),
        (piece(4, 10, 0.4, 1, worker=1, performance=1), "handed_over"),
        (piece(50, 60, 0, 1, performance=1), "restarted"),
        (piece(50, 60, 0, 1, station=1, performance=1), "open"),
    ],
)
def test_the_piece_that_follows_says_what_became_of_the_rest(rest, fate):
    assert fates(piece(0, 4, 0, 0.4), rest) == [fate, "finished"]


def test_a_rest_that_nobody_takes_up_stays_open():
    assert fates(piece(0, 4, 0, 0.4)) == ["open"] and fates(piece(0, 10, 0, 1)) == ["finished"] and fates() == []


def test_pieces_are_told_apart_by_job_and_set_ups_from_work():
    setup = row_of_pieces(SETUP, 20, 24, worker=0, station=0, job=0, task=1, k=9, progress=(0, 1))
    found = job_pieces(
        made([piece(0, 4, 0, 0.4), setup, work(5, 15, 0, job=1, k=4), piece(50, 56, 0.4, 1)], plan(FLOOR_of_pieces))
    )
    assert found.before.tolist() == [-1, 0, -1, -1] and found.left.tolist() == [False, True, False, False]
