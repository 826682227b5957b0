import pytest

from opsim.problems import ScenarioError
from opsim.scenario.templates import without_likes
from opsim.scenario.yaml import read_tree


def resolved(text):
    tree, _ = read_tree(text.encode(), "x.yaml")
    tree, problems = without_likes(tree)
    return tree.plain(), [problem.message for problem in problems]


def test_like_copies_and_a_given_key_replaces_whole():
    tree, problems = resolved("workers:\n  ana: {walk: 1, skills: {a: 1, b: 1}}\n  ben: {like: ana, skills: {a: 2}}\n")
    assert tree["workers"]["ben"] == {"walk": 1, "skills": {"a": 2}}
    assert not problems


def test_like_may_come_before_what_it_copies_and_in_chains():
    chain = "".join(f"  w{n}: {{like: w{n + 1}, k{n}: {n}}}\n" for n in range(1000))
    tree, problems = resolved(f"workers:\n{chain}  w1000: {{last: 1}}\n")
    assert len(tree["workers"]["w0"]) == 1001
    assert tree["workers"]["w0"]["last"] == 1
    assert not problems


def test_a_circle_is_said_once_whoever_leads_into_it():
    _, problems = resolved("workers:\n  c: {like: a}\n  a: {like: b}\n  b: {like: a}\n")
    assert problems == ["this goes round in a circle: a is like b is like a"]


def test_oneself_is_a_circle():
    assert resolved("workers:\n  a: {like: a}\n")[1] == ["this goes round in a circle: a is like a"]


def test_defaults_stand_below_likes_and_these_below_what_is_given():
    tree, problems = resolved(
        "defaults: {workers: {walk: 1, height: 2, mass: 3}}\n"
        "workers:\n  ana: {height: 20}\n  ben: {like: ana, mass: 30}\n  cai: {}\n"
    )
    assert tree == {
        "workers": {
            "ana": {"walk": 1, "height": 20, "mass": 3},
            "ben": {"walk": 1, "height": 20, "mass": 30},
            "cai": {"walk": 1, "height": 2, "mass": 3},
        }
    }
    assert not problems


def test_a_time_that_is_given_replaces_the_whole_time_that_is_copied():
    tree, _ = resolved(
        "defaults: {tasks: {dist: gamma, cv: 0.3, repeat: 2}}\n"
        "tasks:\n  a: {mean: 1 s}\n  b: {fixed: 3 s}\n  c: {like: a, mean: 2 s}\n  d: {like: a, dist: erlang, k: 2}\n"
    )
    assert tree["tasks"] == {
        "a": {"dist": "gamma", "cv": 0.3, "repeat": 2, "mean": "1 s"},
        "b": {"repeat": 2, "fixed": "3 s"},
        "c": {"dist": "gamma", "cv": 0.3, "repeat": 2, "mean": "2 s"},
        "d": {"repeat": 2, "dist": "erlang", "k": 2},
    }


def test_likes_that_copy_without_end_are_refused():
    chain = "".join(f"  w{n}: {{like: w{n + 1}, k{n}: {n}}}\n" for n in range(3000))
    with pytest.raises(ScenarioError, match="copy more than 1,000,000 keys"):
        resolved(f"workers:\n{chain}  w3000: {{last: 1}}\n")


@pytest.mark.parametrize(
    ("defaults", "said"),
    [
        ("[1]", "expected a block of sections, found a list of 1"),
        ("{wrokers: {}}", "no defaults for 'wrokers'"),
        ("{workers: 3}", "expected a block of keys, found 3"),
        ("{workers: {like: a}}", "defaults are like nothing"),
    ],
)
def test_wrong_defaults_are_said(defaults, said):
    assert said in resolved(f"defaults: {defaults}\nworkers: {{a: {{walk: 1}}}}\n")[1]


def test_stations_tasks_and_products_have_likes_too():
    tree, _ = resolved("stations: {a: {at: x}, b: {like: a}}\ntasks: {a: {fixed: 1 s}, b: {like: a}}\n")
    assert tree["stations"]["b"] == {"at": "x"}
    assert tree["tasks"]["b"] == {"fixed": "1 s"}
