"""The engine of every point of a study; the fast one is mostly a stand-in."""

import json

import numpy as np
import pytest
from stand_in_engine import install_rule, stand_in

from opsim.engine.choice import NotFast
from opsim.problems import ScenarioError
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.jobs import evaluate as engines
from opsim.study.jobs.evaluate import Engines, shape_of
from opsim.study.jobs.folder import open_study
from opsim.study.jobs.header import header_of
from opsim.study.jobs.journal import Journal
from tests.opsim.cli.calls import LINE, line

POINTS = [Point(f"buffer {n}", {"stations.saw.buffer": n}, "base") for n in (2, 4, 3)]
JOBS = [Job(point, n) for point in POINTS for n in range(2)]
FIGURES = ("throughput_per_h", "station_states")
TEAM = {"fixed": "25 s"}
TWO = {f"workers.{name}": {"skills": {"press": 1.0}} for name in ("ana", "ben", "cem")}


@pytest.fixture
def source(tmp_path):
    return Source(str(line(tmp_path, LINE)), FIGURES)


def values(answers, jobs=JOBS):
    return answers.values(jobs, answers.keys(jobs))


def everything_refused(plan):
    return ["belts"] if plan.stations[1].buffer == 3 else []


def test_both_engines_give_the_same_answers_and_a_journal_of_the_same_bytes(source, tmp_path, monkeypatch):
    made, found = stand_in(monkeypatch), {}
    for engine in ("simpy", "fast"):
        journal = Journal(own=tmp_path / f"{engine}.jsonl")
        found[engine] = values(Answers(source, journal, processes=1, engine=engine))
        journal.close()
    assert np.array_equal(found["simpy"], found["fast"]) and len(made.ran) == len(JOBS)
    assert (tmp_path / "simpy.jsonl").read_bytes() == (tmp_path / "fast.jsonl").read_bytes()


@pytest.mark.parametrize("at_once", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_the_fast_engine_itself_gives_a_journal_of_the_same_bytes(source, tmp_path, at_once):
    for engine, processes in (("simpy", 1), ("fast", at_once)):
        journal = Journal(own=tmp_path / f"{engine}.jsonl")
        Answers(source, journal, processes=processes, engine=engine).ensure(JOBS)
        journal.close()
    by_simpy, by_fast = (
        sorted((tmp_path / f"{engine}.jsonl").read_bytes().splitlines()) for engine in ("simpy", "fast")
    )
    assert by_simpy == by_fast and len(by_fast) >= len(JOBS)


def test_a_study_goes_on_with_the_other_engine(source, tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    journal = Journal(own=tmp_path / "all.jsonl")
    Answers(source, journal, processes=1).ensure(JOBS[:4])
    by_fast, by_simpy = (
        values(Answers(source, journal, processes=1, engine="fast")),
        values(Answers(source, processes=1)),
    )
    assert np.array_equal(by_fast, by_simpy)
    assert len(made.ran) == 2


def test_points_that_differ_in_numbers_are_looked_at_and_compiled_once(source, monkeypatch):
    made, told = stand_in(monkeypatch), []
    Answers(source, processes=1, engine="fast", chosen=told.append).ensure(JOBS)
    assert len(made.asked_for) == 1 and [one.engine for one in told] == ["fast"]


def test_points_of_other_words_are_each_made_ready_before_the_first_of_them_is_run(source, monkeypatch):
    made = stand_in(monkeypatch)
    points = [Point(word, {"run.variability": word}, "base") for word in ("none", "full")]
    ready = made.ready
    monkeypatch.setattr(made, "ready", lambda *args: (ready(*args), made.ran and pytest.fail("too late")))
    Answers(source, processes=1, engine="fast").ensure([Job(point, 0) for point in points])
    assert len(made.asked_for) == 2 and len(made.ran) == 2


def test_everything_that_cannot_be_run_is_said_before_anything_is_run(tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    for name in ("mine", "yours"):
        install_rule(tmp_path, monkeypatch, "opsim.sequencing", name)
    source = Source(str(line(tmp_path, LINE)), FIGURES)
    points = [Point(rule, {"flow.dispatch": rule}, "base") for rule in ("fifo", "mine", "yours")]
    with pytest.raises(ScenarioError) as refused:
        Answers(source, processes=1, engine="fast").ensure([Job(point, 0) for point in points])
    assert ["'mine'" in str(refused.value), "'yours'" in str(refused.value)] == [True, True]
    assert {one.path for one in refused.value.problems} == {"flow.dispatch"}
    assert made.ran == made.asked_for == []


def test_auto_takes_simpy_where_it_must_point_by_point(tmp_path, monkeypatch):
    made, told = stand_in(monkeypatch), []
    install_rule(tmp_path, monkeypatch, "opsim.sequencing", "mine")
    monkeypatch.setattr("opsim.engine.choice.VISIT_S", 10.0)
    source = Source(str(line(tmp_path, LINE)), FIGURES)
    jobs = [Job(Point(rule, {"flow.dispatch": rule}, "base"), 0) for rule in ("fifo", "mine")]
    Answers(source, processes=1, engine="auto", chosen=told.append).ensure(jobs)
    assert len(made.ran) == 1 and [one.engine for one in told] == ["fast", "simpy"]


def test_a_point_that_looked_like_others_and_is_not_is_run_by_simpy_all_the_same(source, monkeypatch):
    made = stand_in(monkeypatch, refuses=everything_refused)
    monkeypatch.setattr("opsim.engine.choice.VISIT_S", 10.0)
    found = values(Answers(source, processes=1, engine="auto"))
    assert len(made.ran) == 4 and np.array_equal(found, values(Answers(source, processes=1)))


def test_where_fast_is_asked_for_such_a_point_is_refused_when_it_is_come_to(source, monkeypatch):
    stand_in(monkeypatch, refuses=everything_refused)
    answers = Answers(source, processes=1, engine="fast")
    with pytest.raises(NotFast, match="belts"):
        answers.ensure(JOBS)
    assert answers.has(JOBS[:4], [("throughput_per_h", "", "", "1/h")]).shape == (4, 1)


def test_what_was_not_worth_it_may_be_so_with_more_replications(source, monkeypatch):
    made = stand_in(monkeypatch)
    monkeypatch.setattr("opsim.engine.choice.VISIT_S", 0.05)
    answers = Answers(source, processes=1, engine="auto")
    answers.ensure(JOBS[:1])
    assert made.ran == []
    answers.ensure([Job(POINTS[0], n) for n in range(20)])
    assert len(made.ran) == 19


@pytest.mark.parametrize(("horizons", "engine"), [("1 90", "auto"), ("90 2 1", "auto"), ("1 2", "simpy")])
def test_of_points_that_are_alike_the_first_and_the_last_tell_how_much_work_there_is(
    source, monkeypatch, horizons, engine
):
    """SimPy would take half a second an hour: (0.5 s + 45 s) / 2 x 2 points, or x 3; or 1.5 s."""
    stand_in(monkeypatch)
    monkeypatch.setattr(engines, "simpy_s", lambda plan: plan.horizon_s / 7200)
    found = Engines(source, "auto")
    points = [Point(h, {"run.horizon": f"{h} h"}, "base") for h in horizons.split()]
    found.prepare([Job(point, 0) for point in points])
    assert {found.of(point) for point in points} == {engine}


def test_work_is_done_on_all_cores_that_may_be_used(source, monkeypatch):
    monkeypatch.setattr(engines, "simpy_s", lambda plan: 15.0)
    taken = {}
    for at_once in (1, 2, 8):
        stand_in(monkeypatch)
        found = Engines(source, "auto", at_once=at_once)
        found.prepare(JOBS[:2])
        taken[at_once] = found.of(POINTS[0])
    assert taken == {1: "auto", 2: "simpy", 8: "simpy"}


def test_what_is_compiled_here_is_not_counted_on_where_others_compute(source, monkeypatch):
    stand_in(monkeypatch).is_compiled = True
    monkeypatch.setattr(engines, "simpy_s", lambda plan: 3.0)
    for here, engine in ((True, "auto"), (False, "simpy")):
        found = Engines(source, "auto")
        found.prepare(JOBS[:2], here=here)
        assert found.of(POINTS[0]) == engine


def test_a_team_of_one_and_of_two_are_both_made_ready(source, monkeypatch):
    made = stand_in(monkeypatch)
    points = [Point(f"team of {n}", {"tasks.drill": TEAM | {"team": n}} | TWO, "base") for n in (1, 2, 3)]
    Answers(source, processes=1, engine="fast").ensure([Job(point, 0) for point in points])
    assert [one.tasks[1].team for one in made.asked_for] == [1, 2]


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        ({"a": 2}, {"a": 7}, True),
        ({"a": 0}, {"a": 7}, False),
        ({"a": 1}, {"a": 2}, False),
        ({"a": 1.0}, {"a": 0.9}, False),
        ({"a": 1}, {"a": 1.0}, True),
        ({"a": "100 %"}, {"a": "95 %"}, False),
        ({"a": "95 %"}, {"a": "90%"}, True),
        ({"a": "1 s"}, {"a": "2 s"}, True),
        ({"a": "1"}, {"a": "2"}, False),
        ({"a": "40 s"}, {"a": "55.5 s"}, True),
        ({"a": "0 s"}, {"a": "55.5 s"}, False),
        ({"a": "40 s"}, {"a": "40 min"}, False),
        ({"a": "rule1"}, {"a": "rule2"}, False),
        ({"a": True}, {"a": 1}, False),
        ({"a": None}, {"a": "none"}, False),
        ({"a": ["1 m", 2]}, {"a": ["3 m", 4]}, True),
        ({"a": {"b": 3}}, {"a": {"b": 2}}, True),
        ({"a": {"b": 1}}, {"a": {"c": 1}}, False),
        ({"a": 1}, {"b": 1}, False),
    ],
)
def test_points_are_alike_where_only_numbers_differ(one, other, alike):
    assert (shape_of(Point("one", one)) == shape_of(Point("other", other))) is alike


def test_points_of_other_variants_are_not_alike():
    assert shape_of(Point("one", {}, "base")) != shape_of(Point("one", {}, "other"))


def test_an_unknown_engine_is_refused(source):
    with pytest.raises(ValueError, match="did you mean 'fast'"):
        Engines(source, "fats")


def test_the_folder_of_a_study_says_which_engines_answered(source, tmp_path, monkeypatch):
    stand_in(monkeypatch)
    header = header_of("sweep", source, "base", {})

    def ensure(jobs, engine):
        with open_study(tmp_path / "out", header) as study:
            study.answers(processes=1, engine=engine).ensure(jobs)
        file = tmp_path / "out" / "engine.json"
        return json.loads(file.read_text()) if file.exists() else None

    assert ensure(JOBS[:2], "simpy") is None
    assert ensure(JOBS[:4], "fast") == {"asked": "fast", "used": {"fast": "as asked"}, "earlier": ["simpy"]}
    assert ensure(JOBS[:4], "simpy")["asked"] == "fast"
    assert ensure(JOBS, "simpy")["earlier"] == ["fast"]
    with open_study(tmp_path / "out", header, overwrite=True):
        assert not (tmp_path / "out" / "engine.json").exists()
