"""Skill levels: names for ratings, wherever a skill is said."""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
LEVELS = GOOD.replace("workers:\n", "skill_levels: {learner: 0.8, expert: 1.15}\nworkers:\n")


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
