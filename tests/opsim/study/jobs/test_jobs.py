import socket
from contextlib import ExitStack
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from stand_in_engine import stand_in

from opsim.plan import compile_plan
from opsim.scenario.study_checks import Varied
from opsim.study.jobs import Job, Point, Source
from opsim.study.jobs.evaluate import evaluate, loaded_of, plan_of
from opsim.study.jobs.executors import executor_of
from opsim.study.jobs.folder import OtherStudy, open_study
from opsim.study.jobs.header import differing, header_of, read_header
from opsim.study.jobs.job import Shard
from opsim.study.results_folder import Busy
from tests.opsim.cli.calls import LINE, line


@pytest.mark.parametrize("address", ["nowhere", "tcp://", "host:0", "host:99999", "tcp://a b:1", "http://host:8786"])
def test_what_is_no_address_is_refused_with_what_is_expected(address):
    with pytest.raises(ValueError, match="expected dask:tcp://HOST:PORT"), executor_of(f"dask:{address}"):
        pass


def test_somebody_who_is_no_scheduler_is_not_waited_for_for_ever(monkeypatch):
    monkeypatch.setattr("opsim.study.jobs.executors.CONNECT_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"dask:tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(OSError, match="no scheduler answers there"), executor_of(address):
            pass


def test_without_dask_it_is_said_how_to_get_it(monkeypatch):
    monkeypatch.setattr("opsim.study.jobs.executors.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"pip install opsim\[cluster\]"), executor_of("dask:tcp://127.0.0.1:1"):
        pass


def test_no_executor_is_this_machine():
    with executor_of(None) as executor:
        assert executor is None


def test_the_order_of_changes_decides_neither_the_scenario_nor_the_plan_of_a_point():
    changes = {
        "workers.zoe.walk": "1.1 m/s",
        "workers.zoe": {"like": "ana", "home": "bench"},
        "workers.eva": {"like": "zoe"},
        "run.horizon": "2 h",
    }
    orders = (changes, dict(reversed(changes.items())))
    loaded = [loaded_of(Source("repack_cell", ()), Point("a", order)) for order in orders]
    plans = [plan_of(Source("repack_cell", (), changes={"run.horizon": "4 h"}), Point("a", order)) for order in orders]
    assert repr(loaded[0]) == repr(loaded[1])
    assert list(loaded[0].resolved["workers"]) == list(loaded[1].resolved["workers"])
    assert repr(plans[0]) == repr(plans[1]) == repr(compile_plan(loaded[0]))


def test_all_days_of_the_same_people_are_of_one_plan(monkeypatch):
    """The same object, as the fast engine uses the floor of a Plan again."""
    made, seen = stand_in(monkeypatch), []
    run = made.run_plan
    made.is_compiled = True
    monkeypatch.setattr(made, "run_plan", lambda plan, replication: (seen.append(plan), run(plan, replication))[1])
    source, point = Source("repack_cell", ("throughput_per_h",), changes={"run.horizon": "40 min"}), Point("a", {})
    for workforce, day in ((1, 0), (1, 1), (2, 0), (2, 1), (None, 0), (None, 1)):
        evaluate(source, Job(point, day, workforce), "fast")
    assert [one.workforce for one in seen] == [1, 1, 2, 2, None, None]
    assert len({id(one) for one in seen}) == 3


POINT = Point("one", {"stations.saw.buffer": 1}, "base")


@pytest.fixture
def source(tmp_path):
    return Source(str(line(tmp_path, LINE)), ("throughput_per_h", "station_states"))


def opened(folder, source, asked=None, kind="sweep", **how):
    resolved = Varied.read(source.file).with_changes(source.changes).resolved
    return open_study(folder, header_of(kind, source, "base", asked or {"vary": 1}), resolved, **how)


def answered(folder, source, n=2, **how):
    with opened(folder, source, **how) as study:
        study.answers().ensure([Job(POINT, k) for k in range(n)])
        return len(study.journal)


def test_more_may_be_asked_of_a_study_and_it_goes_on(tmp_path, source):
    answered(tmp_path / "s", source)
    (tmp_path / "s" / "summary.json").write_text("{}")
    assert answered(tmp_path / "s", replace(source, kpis=("throughput_per_h",)), 1, asked={"vary": 2}) == 2
    assert not (tmp_path / "s" / "summary.json").exists()
    assert read_header(tmp_path / "s").asked == {"vary": 2}
    assert set(read_header(tmp_path / "s").source.kpis) == set(source.kpis)


def test_results_stay_where_nothing_else_is_asked(tmp_path, source):
    answered(tmp_path / "s", source)
    (tmp_path / "s" / "summary.json").write_text("{}")
    answered(tmp_path / "s", source)
    assert (tmp_path / "s" / "summary.json").exists()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"seed": 9}, "seed 3, now 9"),
        ({"changes": {"run.horizon": "30 min"}}, r"run\.horizon 20 min, now 30 min"),
        ({"kpis": ("throughput_per_h", "walked_m")}, "walked_m was not kept"),
    ],
)
def test_another_study_is_refused_with_what_differs_and_nothing_is_touched(tmp_path, source, change, says):
    answered(tmp_path / "s", source)
    before = {path: path.read_bytes() for path in (tmp_path / "s").rglob("*") if path.is_file()}
    with pytest.raises(OtherStudy, match=says), opened(tmp_path / "s", replace(source, **change)):
        pass
    assert {path: path.read_bytes() for path in (tmp_path / "s").rglob("*") if path.is_file()} == before
    assert answered(tmp_path / "s", replace(source, **change), 1, overwrite=True) == 1


def test_a_study_of_another_kind_scenario_or_version_is_refused(tmp_path, source, monkeypatch):
    answered(tmp_path / "s", source)
    with pytest.raises(OtherStudy, match="a sweep study, now labour"), opened(tmp_path / "s", source, kind="labour"):
        pass
    other = header_of("labour", replace(source, kpis=("walked_m",)), "base", {})
    assert differing(header_of("sweep", source, "base", {}), other) == ["a sweep study, now labour"]
    line(tmp_path, LINE.replace("fixed: 25 s", "fixed: 26 s"))
    clear()
    with pytest.raises(OtherStudy, match="25 s, now 26 s"), opened(tmp_path / "s", source):
        pass
    line(tmp_path, LINE)
    monkeypatch.setattr("opsim.study.results_folder.__version__", "9.9")
    clear()
    with pytest.raises(OtherStudy, match=r"opsim 0.*, now 9\.9"), opened(tmp_path / "s", source):
        pass
    clear()


def clear():
    from opsim.study.jobs import evaluate
    from opsim.study.jobs import evaluate as decides

    decides._made_from.cache_clear()
    evaluate._variant.cache_clear()


@pytest.mark.parametrize("made", ["manifest.json", "base/manifest.json", "summary.json"])
@pytest.mark.parametrize("overwrite", [False, True])
def test_results_of_a_run_are_never_mixed_with_a_study_nor_removed_for_it(tmp_path, source, made, overwrite):
    (tmp_path / "s" / made).parent.mkdir(parents=True)
    (tmp_path / "s" / made).write_text("{}")
    with pytest.raises(OtherStudy, match="opsim run"), opened(tmp_path / "s", source, overwrite=overwrite):
        pass
    assert (tmp_path / "s" / made).read_text() == "{}" and not (tmp_path / "s" / "answers").exists()


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"opsim_study": 99}', "null", "{"])
def test_a_header_that_cannot_be_read_is_refused_in_words(tmp_path, source, text):
    (tmp_path / "s").mkdir()
    (tmp_path / "s" / "study.json").write_text(text)
    with pytest.raises(OtherStudy, match=r"study\.json"), opened(tmp_path / "s", source):
        pass


def test_a_folder_has_one_writer_and_a_shard_its_own_journal(tmp_path, source):
    with ExitStack() as both:
        both.enter_context(opened(tmp_path / "s", source, shard=Shard(1, 2)))
        both.enter_context(opened(tmp_path / "s", source, shard=Shard(2, 2)))
        with pytest.raises(Busy, match=r"shard_2_of_2\.jsonl now"):
            both.enter_context(opened(tmp_path / "s", source, shard=Shard(2, 2)))
        with pytest.raises(Busy, match="another run writes"):
            both.enter_context(opened(tmp_path / "s", source, overwrite=True))
    assert answered(tmp_path / "s", source) == 2


def test_what_is_no_folder_is_refused(tmp_path, source):
    (tmp_path / "file").write_text("")
    with pytest.raises(OtherStudy, match="is a file"), opened(tmp_path / "file", source):
        pass
    with pytest.raises(OSError), opened(tmp_path / "file" / "below", source):
        pass


@given(st.integers(1, 40), st.integers(0, 200))
def test_shards_share_out_all_jobs_and_none_twice(of, n):
    jobs = list(range(n))
    parts = [Shard(number, of).takes(jobs) for number in range(1, of + 1)]
    assert sorted(job for part in parts for job in part) == jobs
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


@given(st.integers(1, 99), st.integers(1, 99))
def test_a_shard_is_known_by_its_words_and_its_file(a, b):
    shard = Shard(min(a, b), max(a, b))
    assert Shard.read(f" {shard} ") == shard == Shard.of_file(shard.file)


@pytest.mark.parametrize(
    "text", ["9/8", "0/8", "1/0", "x", "", "1/2/3", "-1/2", "1.5/2", "1/", "9" * 50 + "/3", "2/9999999"]
)
def test_a_shard_that_is_none_is_refused_with_what_is_expected(text):
    with pytest.raises(ValueError, match="--shard"):
        Shard.read(text)


def test_the_journal_of_a_whole_study_is_no_shard():
    assert Shard.of_file("all.jsonl") is None
