"""Anything at all in the blocks of hands, scoring, human effects and the frontier: read, or refused with a place.

Skill levels: names for ratings, wherever a skill is said.

``workforce``: workers by number, beside those with names.
"""

from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from plans import HERE as HERE_of_workforce
from plans import loaded

from opsim.engine.draws import Draws
from opsim.plan import compile_plan
from opsim.plan.warnings import risks_of
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.study.assumptions import assumptions_of
from opsim.study.resolved_scenario import resolved_text
from opsim.subjects.human.catalogue import catalogue

HERE = Path(__file__).parent
EVERYTHING, GOOD = (
    yaml.safe_load((HERE / f"{name}.yaml").read_text(encoding="utf-8")) for name in ("everything", "good")
)
NEW = {key: EVERYTHING[key] for key in ("ergonomics", "human", "frontier")}
SMALL = {
    **{key: block for key, block in GOOD.items() if key not in ("overrides", "scenarios")},
    **NEW,
    "run": {**GOOD["run"], "posture": "on"},
    "tasks": {"lift": EVERYTHING["tasks"]["lift"]},
    "workers": {"ana": {"skills": {"pack": 1.1}, "experience": {"lift": 200}}},
}
BLOCKS = (
    ("ergonomics",),
    ("human",),
    ("frontier",),
    ("run", "posture"),
    ("tasks", "lift", "handling"),
    ("tasks", "lift", "loaded"),
    ("tasks", "lift", "load"),
    ("workers", "ana", "experience"),
)
MODELS = [{"human": {**EVERYTHING["human"], one.effect: {"model": one.model}}} for one in catalogue()]
TEXTS = st.sampled_from(
    ["10 deg", "-1 deg", "1 kg", "1 s", "never", "16:00", "off", "grasp", "wright", "less x", "nan"]
)
ODD = st.none() | st.booleans() | st.integers() | st.floats() | TEXTS | st.text(max_size=4)
SOME = (
    ODD
    | st.lists(ODD, max_size=3)
    | st.dictionaries(st.sampled_from(["model", "rate", "twist"]) | st.text(), ODD, max_size=3)
)


def read_or_refuse(tree):
    try:
        read = scenarios_in(yaml.safe_dump(tree, allow_unicode=True).encode(), Path("line.yaml"))
    except ScenarioError as error:
        assert all(one.line and one.message for one in error.problems)
        return
    for variant in read.values():
        assert all(isinstance(risk, str) for risk in risks_of(variant.scenario))
        assert assumptions_of(variant, compile_plan(variant))


@settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(data=st.data())
def test_anything_in_these_blocks_is_planned_or_refused(data):
    tree = deepcopy(SMALL | data.draw(st.sampled_from(MODELS)))
    *way, key = data.draw(st.sampled_from(BLOCKS))
    parent = tree
    for part in way:
        parent = parent[part]
    while isinstance(parent[key], dict | list) and parent[key] and data.draw(st.booleans()):
        parent = parent[key]
        key = data.draw(st.sampled_from(sorted(parent) if isinstance(parent, dict) else range(len(parent))))
    if isinstance(parent, dict) and data.draw(st.booleans()):
        key = data.draw(st.just(key) | st.text(max_size=4))
    parent[key] = data.draw(SOME)
    read_or_refuse(tree)


SKILL_LEVELS_GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
LEVELS = SKILL_LEVELS_GOOD.replace("workers:\n", "skill_levels: {learner: 0.8, expert: 1.15}\nworkers:\n")


def ratings(text, variant="base"):
    workers = scenarios_in(text.encode(), Path("line.yaml"))[variant].scenario.workers
    return {name: worker.skills["pack"] for name, worker in workers.items()}


def test_a_level_is_its_rating_also_where_it_is_copied():
    assert ratings(LEVELS.replace("{pack: 1.1}", "{pack: expert}")) == {"ana": 1.15, "ben": 1.15}


def test_levels_reach_workers_through_defaults_and_overrides():
    text = LEVELS.replace("workers:\n  ana: {height: 1.62 m, skills: {pack: 1.1}}", "workers:\n  ana: {height: 1.62 m}")
    text = text.replace("layout:\n", "defaults: {workers: {skills: {pack: learner}}}\nlayout:\n", 1)
    text = text.replace("near: {", "near: {workers.ana.skills: {pack: expert}, skill_levels.expert: 1.2, ")
    assert ratings(text) == {"ana": 0.8, "ben": 0.8}
    assert ratings(text, "near") == {"ana": 1.2, "ben": 1.2}


def test_the_resolved_scenario_has_the_numbers():
    text = LEVELS.replace("{pack: 1.1}", "{pack: expert}")
    resolved = scenarios_in(text.encode(), Path("line.yaml"))["base"].resolved
    assert resolved["workers"]["ben"]["skills"] == {"pack": 1.15}


def test_a_wrong_level_that_many_copy_is_one_mistake():
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(LEVELS.replace("{pack: 1.1}", "{pack: export}").encode(), Path("line.yaml"))
    (one,) = caught.value.problems
    assert one.message == "no skill level 'export'" and one.hint == "did you mean 'expert'?"


WORKFORCE_GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
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
    again = scenarios_in(text.encode(), HERE_of_workforce / "test.yaml")["base"]
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
