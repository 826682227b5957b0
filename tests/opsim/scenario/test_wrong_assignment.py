"""Wrong words about who does what: zones, priorities, rounds, skill levels, shared work; and right ones."""

import plans
import pytest

GOOD = """
opsim: 1
name: assignment
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {base: {fixed: 4 s}, lid: {fixed: 6 s}, seal: {fixed: 8 s}}
stations:
  front: {at: a, tasks: [base, lid], buffer: 1, priority: 2, share: {tasks: [lid], with: back, when: full}}
  back: {at: a, tasks: [seal], buffer: 2}
products: {part: {route: [front, back]}}
release: {kind: saturated}
skill_levels: {learner: {pace: 0.8, quality: 0.9}, expert: 1.2}
workers:
  ana: {zone: [front], skills: {front: learner, back: {quality: 0.99}}}
  ben: {floater: true, patrol: [back], skills: {back: expert}}
allocation: {rule: most_downstream, priorities: [products, stations]}
"""
PATROL = ("ana: {zone", "ana: {patrol: [front], zone")


def answer(*edits):
    return plans.answer(GOOD, *edits)


CASES = [
    (
        "no such station",
        ("zone: [front]", "zone: [frond]"),
        ["ana.zone[0]: no station 'frond'", "did you mean 'front'?"],
    ),
    (
        "no skill",
        ("back: expert}", "back: expert}, zone: [front]"),
        ["ben.zone[0]: 'front' is in the zone of ben, who has"],
    ),
    ("twice", ("zone: [front]", "zone: [front, front]"), ["ana.zone[1]: 'front' is named twice"]),
    ("empty", ("zone: [front]", "zone: []"), ["ana.zone: expected at least one entry, found none"]),
    ("floater", ("floater: true", "floater: often"), ["ben.floater: expected true or false, found 'often'"]),
    ("priority", ("priority: 2", "priority: high"), ["front.priority: expected a whole number, found 'high'"]),
    ("unread priority", (", stations]", "]"), ["front.priority: front has a priority, and allocation.priorities does"]),
    (
        "priorities",
        ("[products, stations]", "[product]"),
        ["priorities[0]: expected stations or products, found 'product'"],
    ),
    ("rule", ("rule: most_downstream", "rule: most_downstrem"), ["did you mean 'most_downstream'?"]),
    ("serve", ("priorities:", "serve: one, priorities:"), ["'serve: one' is for who goes round"]),
    (
        "quality",
        ("quality: 0.9}", "quality: 1.2}"),
        ["skill_levels.learner.quality: a probability lies between 0 and 1"],
    ),
    ("no quality", ("quality: 0.99", "quality: 0"), ["ana.skills.back.quality: a quality must be more than 0"]),
    ("pace", ("{quality: 0.99}", "{pace: 11}"), ["ana.skills.back.pace: must be at most 10, found 11"]),
    ("key", ("{quality: 0.99}", "{qualty: 0.99}"), ["ana.skills.back.qualty: unknown key", "did you mean 'quality'?"]),
    ("level key", ("{pace: 0.8,", "{speed: 0.8,"), ["skill_levels.learner.speed: unknown key 'speed'"]),
    ("list", ("{quality: 0.99}", "[1.0]"), ["ana.skills.back: expected a number, found"]),
    ("share station", ("with: back", "with: bak"), ["front.share.with: no station 'bak'", "did you mean 'back'?"]),
    ("share itself", ("with: back", "with: front"), ["front shares work with itself"]),
    ("all shared", ("[base, lid]", "[lid]"), ["'lid' is the only task of front", "give front a task before it"]),
    ("share task", ("{tasks: [lid]", "{tasks: [lit]"), ["front.share.tasks[0]: no task 'lit'"]),
    (
        "share first",
        ("{tasks: [lid]", "{tasks: [base]"),
        ["must be the last of those of front", "write 'tasks: [lid, base]'"],
    ),
    ("share all", ("{tasks: [lid]", "{tasks: [base, lid]"), ["front.share.tasks: the shared tasks must be the last"]),
    ("share when", ("when: full", "when: halffull"), ["expected half_full or full, found 'halffull'"]),
    ("share unlimited", ("[seal], buffer: 2", "[seal]"), ["'back' has an unlimited buffer, which is never half full"]),
    ("share batch", ("[seal], buffer: 2", "[seal], buffer: 2, batch: {size: 2}"), ["back serves batches"]),
    ("share elsewhere", ("[front, back]", "[front, [back, front]]"), ["'part' does not always go from front to back"]),
    (
        "share from outside",
        ("{part: {", "{other: {share: 0.5, route: [back]}, part: {share: 0.5, "),
        ["'other' comes to back"],
    ),
    (
        "share then out",
        ("route: [front, back]", "routing: {start: front, front: {back: 0.9, out: 0.1}, back: out}"),
        ["'part' does not"],
    ),
    ("share key", ("{tasks: [lid]", "{task: [lid]"), ["front.share.task: unknown key 'task'", "did you mean 'tasks'?"]),
]


def test_all_of_it_is_right():
    assert answer() == "good"
    assert answer(PATROL, ("{rule:", "{idle: patrol, serve: one, rule:")) == "good"
    by_chance = "routing: {start: front, front: back, back: out}"
    assert answer(("route: [front, back]", by_chance)) == "good"


@pytest.mark.parametrize(("edit", "said"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_a_mistake_is_told_at_its_place_with_a_way_out(edit, said):
    found = answer(edit)
    assert all(part in found for part in said), found
    assert "1 problem in" in found, found
