import os
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

from opsim.problems import ScenarioError
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.jobs import evaluate as workers
from opsim.study.jobs.executors import AT_A_TIME, OtherWorker
from opsim.study.jobs.job import Missing, Shard, ShardDone
from opsim.study.jobs.journal import Journal
from tests.opsim.cli.calls import LINE, line

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
