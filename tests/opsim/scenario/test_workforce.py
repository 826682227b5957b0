"""``workforce``: workers by number, beside those with names."""

from pathlib import Path

import numpy as np
import pytest
from plans import HERE, loaded

from opsim.engine.draws import Draws
from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.study.resolved_scenario import resolved_text

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
CELL = """
opsim: 1
name: cell
run: {horizon: 30 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m], b: [5 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.4}
stations: {low: {at: a, tasks: [squat], buffer: 2}, desk: {at: b, tasks: [label]}}
products: {box: {route: [low, desk]}}
release: {kind: saturated}
"""


def workers(text, variant="base"):
    return loaded(text, variant).scenario.workers


def test_workers_are_numbered_and_can_do_everything_where_nothing_is_said():
    found = workers(CELL + "workforce: {n: 3}\n")
    assert list(found) == ["w1", "w2", "w3"]
    assert all(worker.skills == {"low": 1.0, "desk": 1.0} and worker.person is None for worker in found.values())


def test_keys_are_those_of_each_worker_over_the_one_they_are_like():
    text = CELL + "workers: {ana: {walk: 1 m/s, home: b, skills: {low: 1.1, desk: 1.0}}, ben: {like: ana}}\n"
    found = workers(text + "workforce: {n: 2, like: ben, prefix: new, height: 1.7 m, walk: 2 m/s}\n")
    assert list(found) == ["ana", "ben", "new1", "new2"]
    new = found["new2"]
    assert (new.walk_m_per_s, new.home, new.skills, new.height_m) == (2.0, "b", {"low": 1.1, "desk": 1.0}, 1.7)


def test_keys_of_the_defaults_are_those_of_each_worker_who_is_like_nobody():
    text = CELL + "defaults: {workers: {walk: 1 m/s, skills: {low: 1.0, desk: 0.9}}}\n"
    assert workers(text + "workforce: {n: 1}\n")["w1"].skills == {"low": 1.0, "desk": 0.9}
    with_ana = text + "workers: {ana: {skills: {low: 1.0, desk: 1.0}}}\n"
    assert workers(with_ana + "workforce: {n: 1, like: ana}\n")["w1"].walk_m_per_s == 1.0


def test_the_k_th_worker_is_the_k_th_recorded_person_whoever_else_works():
    text = CELL + "workforce: {n: 3, from: recorded}\n"
    alone = [worker.person for worker in workers(text).values()]
    beside = workers(text + "workers: {ana: {person: s05, skills: {low: 1}}, ben: {skills: {low: 1}}}\n")
    assert alone == ["s01", "s02", "s03"]
    assert [beside[name].person for name in ("w1", "w2", "w3", "ana", "ben")] == [*alone, "s05", None]


def test_a_recorded_person_cannot_be_two_workers():
    with pytest.raises(ScenarioError) as caught:
        loaded(CELL + "workforce: {n: 4, from: recorded}\nworkers: {ana: {person: s02, skills: {low: 1}}}\n")
    (one,) = caught.value.problems
    assert (one.path, one.message) == ("workforce.from", "the workforce takes s01 to s04, and s02 is ana already")
    assert one.hint == "give ana another person, or take 'from: population'"


def test_who_is_like_a_recorded_person_is_not_that_person():
    found = workers(CELL + "workforce: {n: 2, like: ana}\nworkers: {ana: {person: s02, skills: {low: 1, desk: 1}}}\n")
    assert [worker.person for worker in found.values()] == ["s02", None, None]


def test_number_and_skills_are_changed_by_overrides_and_levels_are_known():
    text = CELL + (
        "skill_levels: {learner: 0.8}\nworkers: {ana: {skills: {low: 1.0, desk: 1.0}}}\n"
        "workforce: {n: 2, like: ana}\n"
        "overrides: {more: {workforce.n: 14, workforce.skills.desk: learner}}\nscenarios: {base: [], more: [more]}\n"
    )
    assert list(workers(text, "more")) == ["ana", *(f"w{i}" for i in range(1, 15))]
    assert workers(text, "more")["w14"].skills == {"low": 1.0, "desk": 0.8}
    assert workers(text)["w2"].skills == {"low": 1.0, "desk": 1.0}


def test_more_workers_change_nobody_s_draws():
    def drawn(n):
        plan = compile_plan(loaded(CELL + f"workforce: {{n: {n}}}\n"))
        draws = Draws(plan, 0)
        return {
            (worker.name, task): [draws.duration_s(task, rank, k) for k in range(5)]
            for rank, worker in enumerate(plan.workers)
            for task in (0, 1)
        }

    few, many = drawn(3), drawn(11)
    assert len(many) == 22 and all(np.array_equal(times, many[key]) for key, times in few.items())
    assert len({tuple(times) for times in many.values()}) == 22


def test_the_resolved_scenario_names_every_worker_and_is_the_same_plan():
    one = loaded(CELL + "workforce: {n: 3, from: recorded}\n")
    text = resolved_text(one.resolved)
    assert "workforce" not in one.resolved and "w3" in text
    again = scenarios_in(text.encode(), HERE / "test.yaml")["base"]
    assert compile_plan(again).workers == compile_plan(one).workers
    assert again.resolved == one.resolved


def test_what_is_given_is_told_from_what_is_assumed():
    one = loaded(CELL + "workforce: {n: 2, walk: 1 m/s}\n")
    assert "workers.w2.walk" in one.given and "workers.w2.height" not in one.given


def test_a_workforce_may_lie_in_an_included_file(tmp_path):
    (tmp_path / "people.yaml").write_text("workforce: {n: 2, walk: 1 m/s}\n")
    text = CELL + "include: people.yaml\nworkforce: {n: 3}\n"
    found = scenarios_in(text.encode(), tmp_path / "cell.yaml")["base"].scenario.workers
    assert [(name, worker.walk_m_per_s) for name, worker in found.items()] == [("w1", 1), ("w2", 1), ("w3", 1)]


def test_a_library_that_is_missing_is_said_once():
    text = CELL.replace("public_movements", "public_movement") + "workforce: {n: 3, from: recorded}\n"
    with pytest.raises(ScenarioError) as caught:
        loaded(text)
    assert [one.path for one in caught.value.problems] == ["libraries.moves"]
