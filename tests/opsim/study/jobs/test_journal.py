import math
import os
import struct
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from multiprocessing import get_context

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.catalogue import Figure
from opsim.problems import ScenarioError
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.jobs import evaluate as module
from opsim.study.jobs import evaluate as workers
from opsim.study.jobs.evaluate import decided_by
from opsim.study.jobs.executors import AT_A_TIME, OtherWorker
from opsim.study.jobs.job import Answer, Missing, Shard, ShardDone
from opsim.study.jobs.journal import Journal
from tests.opsim.cli.calls import LINE, line

FEW = ("throughput_per_h", "walked_m")
MORE = (*FEW, "worker_states")


def answer(*values):
    names = MORE if len(values) > 2 else FEW
    return Answer.of([Figure(name, "Zoë", "", "1/h", value) for name, value in zip(names, values)])


def written(path, answers, first=0):
    journal = Journal(own=path)
    for number, one in enumerate(answers, first):
        journal.add(("point", number, -1), one)
    journal.close()


def read(path, **how):
    journal = Journal([path], **how)
    found = {address: (journal.keys(address), journal.values(address)) for address in journal}
    journal.close()
    return found, journal.damaged


def bits(values):
    return [struct.pack("d", value) if not math.isnan(value) else b"nan" for value in values]


@cache
def five(n=5):
    """The bytes of a journal of five answers of two kinds."""
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        written(Path(folder) / "j", [answer(k / 3, math.nan, *([k * 1e-9] if k % 2 else [])) for k in range(n)])
        return (Path(folder) / "j").read_bytes()


@given(st.lists(st.floats(), min_size=2, max_size=3))
def test_a_journal_gives_back_every_bit(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    written(path, [answer(*values)])
    (found,) = read(path)[0].values()
    assert bits(found[1]) == bits(values) and found[0][0] == ("throughput_per_h", "Zoë", "", "1/h")


@given(st.integers(0, len(five())))
def test_a_journal_cut_anywhere_holds_the_first_answers_and_goes_on(tmp_path_factory, size):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    path.write_bytes(five()[:size])
    found, damaged = read(path)
    assert [address[1] for address in found] == list(range(len(found))) and not damaged
    written(path, [answer(k / 3, math.nan, *([k * 1e-9] if k % 2 else [])) for k in range(len(found), 5)], len(found))
    assert path.read_bytes() == five()


@given(st.integers(0, len(five()) - 1), st.integers(1, 255))
def test_a_damaged_line_is_said_and_costs_at_most_the_answers_that_need_it(tmp_path_factory, at, change):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    raw = bytearray(five())
    raw[at] ^= change
    path.write_bytes(bytes(raw))
    whole = tmp_path_factory.mktemp("journal") / "all.jsonl"
    whole.write_bytes(five())
    (found, damaged), (all_of_them, _) = read(path), read(whole)
    assert all(bits(found[address][1]) == bits(all_of_them[address][1]) for address in found)
    assert damaged or (at == len(raw) - 1 and len(found) == 4)
    assert all(place.startswith(f"{path}:") for place in damaged)


@given(st.integers(0, len(five()) - 1), st.integers(1, 255))
def test_a_damaged_line_is_said_once_and_nothing_else_is_lost_with_it(tmp_path_factory, at, change):
    folder = tmp_path_factory.mktemp("journal")
    raw = bytearray(five())
    raw[at] ^= change
    (folder / "all.jsonl").write_bytes(bytes(raw))
    readable = read(folder / "all.jsonl")[0]
    first = Journal(own=folder / "all.jsonl")
    assert {address: bits(first.values(address)) for address in first} == {a: bits(v) for a, (_, v) in readable.items()}
    assert first.damaged or at == len(raw) - 1
    for number in range(5):
        if ("point", number, -1) not in first:
            first.add(("point", number, -1), answer(number / 3, math.nan, *([number * 1e-9] if number % 2 else [])))
    first.close()
    found, damaged = read(folder / "all.jsonl")
    assert len(found) == 5 and not damaged and not list(folder.glob(".*"))


def test_a_journal_that_cannot_be_mended_is_read_as_it_is(tmp_path, monkeypatch):
    path = tmp_path / "all.jsonl"
    path.write_bytes(five().replace(b"walked_m", b"wolked_m", 1))
    before = path.read_bytes()

    def full(path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("opsim.study.jobs.journal.whole_file", full)
    journal = Journal(own=path)
    assert journal.damaged and path.read_bytes() == before
    journal.close()


def test_another_process_still_writing_is_read_up_to_its_last_whole_line_and_left_alone(tmp_path):
    (tmp_path / "shard_1_of_2.jsonl").write_bytes(five()[:-3])
    journal = Journal([tmp_path / "shard_1_of_2.jsonl"], tmp_path / "all.jsonl")
    assert len(journal) == 4
    journal.close()
    assert (tmp_path / "shard_1_of_2.jsonl").read_bytes() == five()[:-3]


def test_other_answers_to_the_same_job_in_two_files_are_found(tmp_path):
    written(tmp_path / "a", [answer(1.0, 2.0), answer(1.0, math.nan)])
    written(tmp_path / "b", [answer(1.0, 2.5), answer(1.0, math.nan)])
    journal = Journal([tmp_path / "a", tmp_path / "b"])
    assert journal.twice == [f"{tmp_path / 'b'}:2"]
    journal.close()


def test_a_full_disk_leaves_the_journal_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "all.jsonl"
    written(path, [answer(1.0, 2.0)])
    before, write = path.read_bytes(), os.write

    def half(file, line):
        if len(line) < 20:
            raise OSError(28, "No space left on device")
        return write(file, line[: len(line) // 2])

    journal = Journal(own=path)
    monkeypatch.setattr(os, "write", half)
    with pytest.raises(OSError, match=r"No space left on device: .*all\.jsonl"):
        journal.add(("point", 1, -1), answer(3.0, 4.0))
    monkeypatch.undo()
    assert path.read_bytes() == before and ("point", 1, -1) not in journal
    journal.add(("point", 1, -1), answer(3.0, 4.0))
    assert journal.values(("point", 1, -1)) == [3.0, 4.0]
    journal.close()


POINTS = [Point(f"buffer {n}", {"stations.saw.buffer": n}, "base") for n in (1, 2)]
JOBS = [Job(point, n) for point in POINTS for n in range(3)]
FIGURES = ("throughput_per_h", "station_states")


@pytest.fixture
def source(tmp_path):
    return Source(str(line(tmp_path, LINE)), FIGURES)


def everything(answers, jobs=JOBS):
    return answers.values(jobs, answers.keys(jobs))


@pytest.fixture
def expected(source):
    return everything(Answers(source))


def test_threads_give_the_same_answers(source, expected):
    with ThreadPoolExecutor(3) as threads:
        assert np.array_equal(everything(Answers(source, executor=threads)), expected)


@pytest.mark.slow
def test_processes_of_any_executor_give_the_same_answers(source, expected):
    with ProcessPoolExecutor(2, get_context("spawn")) as processes:
        assert np.array_equal(everything(Answers(source, executor=processes)), expected)


@pytest.mark.slow
def test_own_processes_give_the_same_answers_in_any_number_of_batches(source, expected):
    answers = Answers(source, processes=2)
    answers.ensure(JOBS[1:3])
    assert np.array_equal(everything(answers), expected)
    answers.close()


def test_only_what_is_missing_is_computed_and_told(source, expected, tmp_path):
    journal = Journal(own=tmp_path / "all.jsonl")
    said = []
    everything(Answers(source, journal, progress=lambda *of: said.append(of)), JOBS[:4])
    assert said[-1] == (4, 4)
    journal.close()
    again = Journal(own=tmp_path / "all.jsonl")
    said.clear()
    assert np.array_equal(everything(Answers(source, again, progress=lambda *of: said.append(of))), expected)
    assert said[-1] == (2, 2)
    again.close()


def test_a_figure_that_a_job_does_not_have_is_nan(source):
    assert np.isnan(Answers(source).values(JOBS[:1], [("walked_m", "nobody", "", "m")])).all()


def test_a_shard_computes_its_part_and_stops_there(source):
    answers = Answers(source, shard=Shard(2, 3))
    with pytest.raises(ShardDone) as done:
        answers.values(JOBS, [])
    assert (done.value.mine, done.value.of, done.value.left) == (2, 6, 4)
    with pytest.raises(Missing) as missing:
        Answers(source, answers._kept, compute=False).ensure(JOBS)
    assert missing.value.places == (0, 2, 3, 5)


def test_everything_wrong_with_any_point_is_said_at_once(source):
    wrong = [Point("a", {"stations.saw.buffer": -1}, "base"), Point("b", {"stations.sow.buffer": 1}, "base")]
    with pytest.raises(ScenarioError) as error:
        Answers(source).check([*wrong, *POINTS])
    assert {"-1", "sow"} <= set(str(error.value).replace("'", " ").split())


class Held:
    """An executor that answers at once and counts what it was handed before it was asked."""

    most = 0

    def __init__(self):
        self.open = 0

    def submit(self, work, *with_these):
        self.open += 1
        Held.most = max(Held.most, self.open)
        future = Future()
        future.result = lambda timeout=None: self._answer(work, with_these)
        future.set_result(None)
        return future

    def _answer(self, work, with_these):
        self.open -= 1
        return work(*with_these)


def test_an_executor_is_never_handed_all_jobs_at_once(source, monkeypatch):
    monkeypatch.setattr("opsim.study.jobs.executors.answer_far_away", lambda *_: workers.Answer.of([]))
    answers = Answers(source, executor=Held())
    answers.ensure([Job(POINTS[0], n) for n in range(10 * AT_A_TIME)])
    assert Held.most == AT_A_TIME


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (lambda made: {**made, "packages": {**made["packages"], "numpy": "1.0"}}, r"numpy 1\.0, now"),
        (lambda made: {**made, "resolved_sha256": "0"}, "the scenario"),
        (lambda made: {**made, "recorded": {"times.csv": "0"}}, r"file times\.csv has changed"),
    ],
)
def test_a_worker_with_other_versions_or_files_is_refused(source, monkeypatch, other, says):
    here = workers.made_from
    monkeypatch.setattr(workers, "decided_by", lambda *_: "another")
    monkeypatch.setattr(workers, "made_from", lambda *of: other(here(*of)))
    with ThreadPoolExecutor(1) as threads, pytest.raises(OtherWorker, match=says):
        Answers(source, executor=threads).ensure(JOBS)


def test_a_worker_that_cannot_read_the_scenario_is_said(source, monkeypatch):
    def gone(*_):
        raise FileNotFoundError(2, "No such file or directory", "/there/line.yaml")

    monkeypatch.setattr(workers, "decided_by", gone)
    with ThreadPoolExecutor(1) as threads, pytest.raises(OtherWorker, match=r"every worker must.*line\.yaml"):
        Answers(source, executor=threads).ensure(JOBS)


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (
            ModuleNotFoundError("No module named 'plugin'"),
            "a worker lacks something that is here: No module named 'plugin'",
        ),
        (RuntimeError("Error during deserialization of the task graph"), "the scheduler or a worker has no opsim"),
    ],
)
def test_a_worker_without_what_is_needed_is_said(source, monkeypatch, error, says):
    def fails(*_):
        raise error

    monkeypatch.setattr("opsim.study.jobs.executors.answer_far_away", fails)
    with ThreadPoolExecutor(1) as threads, pytest.raises(OtherWorker, match=says):
        Answers(source, executor=threads).ensure(JOBS)


def test_a_worker_in_another_folder_reads_the_same_file(source, expected, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answers = Answers(Source("line.yaml", FIGURES), executor=(threads := ThreadPoolExecutor(1)))
    threads.submit(lambda: None).result()
    here = workers.answer_far_away

    def elsewhere(source, *rest):
        assert os.path.isabs(source.file)
        return here(source, *rest)

    monkeypatch.setattr("opsim.study.jobs.executors.answer_far_away", elsewhere)
    assert np.array_equal(everything(answers), expected)
    threads.shutdown()


POINT = Point("two", {"stations.saw.buffer": 3}, "base")


def decided(folder, text=LINE, point=POINT, **said):
    """As a process of its own would find it."""
    for kept in (module._made_from, module._sha256, module._folder):
        kept.cache_clear()
    from opsim.study.jobs import evaluate

    evaluate._variant.cache_clear()
    (folder / "line.yaml").write_text(text)
    return decided_by(replace(Source(str(folder / "line.yaml"), ("throughput_per_h",)), **said), point)


def test_what_only_says_how_answers_are_looked_at_decides_none(tmp_path):
    first = decided(tmp_path)
    assert decided(tmp_path, LINE.replace("[throughput_per_h, station_states]", "[walked_m]")) == first
    assert decided(tmp_path, LINE.replace("name: Two stations", "name: Other")) == first
    assert decided(tmp_path, LINE.replace("replications: 2", "replications: 9")) == first
    assert decided(tmp_path, LINE + "studies: {sweep: {vary: {stations.saw.buffer: [1, 2]}}}") == first
    assert decided(tmp_path, point=Point("another name", POINT.changes, "base")) == first


def test_what_decides_answers_makes_others(tmp_path):
    found = [
        decided(tmp_path),
        decided(tmp_path, LINE.replace("fixed: 25 s", "fixed: 26 s")),
        decided(tmp_path, LINE.replace("run: {", "run: {warm_up: 1 min, ")),
        decided(tmp_path, seed=4),
        decided(tmp_path, changes={"run.horizon": "30 min"}),
        decided(tmp_path, point=Point("two", {"stations.saw.buffer": 4}, "base")),
    ]
    assert len(set(found)) == len(found)


def test_a_file_that_a_change_names_decides_with_what_is_in_it(tmp_path):
    point = Point("times", {"tasks.cut": {"recorded": "times.csv", "automatic": True}}, "base")
    (tmp_path / "times.csv").write_text("duration_s\n20\n21\n")
    first = decided(tmp_path, point=point)
    (tmp_path / "times.csv").write_text("duration_s\n20\n22\n")
    assert decided(tmp_path, point=point) != first
