"""Wrong words about job rotation: what is said of each, and where."""

import plans
import pytest

GOOD = """
opsim: 1
name: rotation
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m]}}
tasks: {do: {fixed: 4 s}}
stations: {pack: {at: a, tasks: [do]}, label: {at: a, tasks: [do]}, lift: {at: a, tasks: [do]}}
products: {p: {route: [pack, label, lift]}}
release: {kind: poisson, every: 10 s}
workers: {ana: {skills: {pack: 1, label: 1}}, ben: {skills: {pack: 1, lift: 1}}, cem: {skills: {lift: 1}}}
rotations: {turn: {workers: [ana, ben], posts: [pack, [label, lift]], every: 2 h}}
"""


def answer(*edits):
    return plans.answer(GOOD, *edits)


def test_a_rotation_that_is_right_is_read():
    assert answer() == "good"
    assert answer(("every: 2 h", "after: 50")) == answer(("every: 2 h", "rule: least_time")) == "good"
    assert answer(("every: 2 h", "after: 50, rule: in_turn"), ("[label, lift]]", "[label, lift], []]")) == "good"


CASES = [
    ("when", [(", every: 2 h", "")], ["rotations.turn: nothing says when people change posts", "'every: 2 h'"]),
    ("both", [("every: 2 h", "every: 2 h, after: 5")], ["turn.after: changes by the clock (every) and by count"]),
    ("unit", [("every: 2 h", "every: 2")], ["rotations.turn.every: 2 has no unit"]),
    ("count", [("every: 2 h", "after: 0")], ["rotations.turn.after"]),
    ("key", [("every: 2 h", "evry: 2 h")], ["unknown key 'evry'", "did you mean 'every'?"]),
    ("rule", [("every: 2 h", "rule: leest_time")], ["turn.rule: no rule 'leest_time'", "did you mean 'least_time'?"]),
    ("worker", [("[ana, ben]", "[ana, benn]")], ["turn.workers[1]: no worker 'benn'", "did you mean 'ben'?"]),
    ("twice", [("[ana, ben]", "[ana, ben, ana]")], ["turn.workers[2]: ana is twice here"]),
    ("station", [("[label, lift]]", "[lable, lift]]")], ["turn.posts[1]: no station 'lable'", "did you mean 'label'?"]),
    ("post", [("posts: [pack,", "posts: [3,")], ["turn.posts[0]: expected a station or a list of them, found 3"]),
    ("one", [("[pack, [label, lift]]", "[pack]")], ["rotations.turn.posts", "at least 2"]),
    ("skill", [("[ana, ben]", "[ana, cem]"), ("[label, lift]]", "label]")], ["cem has no skill at any of the posts"]),
    ("nobody", [("[ana, ben]", "[ben]"), ("[label, lift]]", "label]")], ["none of the members has a skill at 'label'"]),
    (
        "two",
        [("rotations: {", "rotations: {more: {workers: [ben], posts: [pack, lift], after: 9}, ")],
        ["ben is in rotation more already"],
    ),
]


@pytest.mark.parametrize(("edits", "words"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_each_mistake_is_named_where_it_stands(edits, words):
    said = answer(*edits)
    assert all(word in said for word in words), said
    assert "line.yaml:11:" in said


def test_all_mistakes_are_told_at_once():
    said = answer(("[ana, ben]", "[anna, bem]"), ("[label, lift]]", "[lable, lift]]"))
    assert "3 problems" in said
