from opsim.scenario.like import without_likes
from opsim.scenario.yaml_nodes import read_tree


def resolved(text):
    tree, _ = read_tree(text.encode(), "x.yaml")
    tree, problems = without_likes(tree)
    return tree.plain(), [problem.message for problem in problems]


def test_like_copies_and_a_given_key_replaces_whole():
    tree, problems = resolved("workers:\n  ana: {walk: 1, skills: {a: 1, b: 1}}\n  ben: {like: ana, skills: {a: 2}}\n")
    assert tree["workers"]["ben"] == {"walk": 1, "skills": {"a": 2}}
    assert not problems


def test_like_may_come_before_what_it_copies_and_in_chains():
    chain = "".join(f"  w{n}: {{like: w{n + 1}, k{n}: {n}}}\n" for n in range(2000))
    tree, problems = resolved(f"workers:\n{chain}  w2000: {{last: 1}}\n")
    assert len(tree["workers"]["w0"]) == 2001
    assert tree["workers"]["w0"]["last"] == 1
    assert not problems


def test_a_circle_is_said_once_whoever_leads_into_it():
    _, problems = resolved("workers:\n  c: {like: a}\n  a: {like: b}\n  b: {like: a}\n")
    assert problems == ["this goes round in a circle: a is like b is like a"]


def test_oneself_is_a_circle():
    assert resolved("workers:\n  a: {like: a}\n")[1] == ["this goes round in a circle: a is like a"]


def test_stations_tasks_and_products_have_likes_too():
    tree, _ = resolved("stations: {a: {at: x}, b: {like: a}}\ntasks: {a: {fixed: 1 s}, b: {like: a}}\n")
    assert tree["stations"]["b"] == {"at": "x"}
    assert tree["tasks"]["b"] == {"fixed": "1 s"}
