"""What the sheet says of who does what."""

from plans import plan

from opsim.study.assumptions.assignment import assignment, qualities

TEXT = """
opsim: 1
name: sheet
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {base: {fixed: 4 s}, lid: {fixed: 6 s}, seal: {fixed: 8 s}}
stations:
  front: {at: a, tasks: [base, lid], buffer: 1, priority: 2, share: {tasks: [lid], with: back}}
  back: {at: a, tasks: [seal], buffer: 2}
products: {part: {route: [front, back], priority: 1}}
release: {kind: saturated}
workers:
  ana: {zone: [front], patrol: [front], skills: {front: {pace: 1.0, quality: 0.9}, back: 1.0}}
  ben: {floater: true, patrol: [back], skills: {back: 1.0}}
allocation: {idle: patrol, serve: one, priorities: [products, stations]}
"""
PLAIN = TEXT.replace("zone: [front], ", "").replace("floater: true, ", "").replace(", priority: 2", "")
PLAIN = (
    PLAIN.replace(", share: {tasks: [lid], with: back}", "").replace(", priority: 1", "").replace(", serve: one", "")
)


def test_everything_that_decides_who_works_is_said():
    said = [says for _, says in assignment(plan(TEXT))]
    assert len(said) == 6
    assert said[0].endswith("nobody whose own it is, and no floater, is free: ana (front)")
    assert said[1] == "ben: sent only where nobody is free whose own station it is, but before others leave their zones"
    assert said[2].startswith("where jobs of a higher priority call")
    assert said[3].endswith("before the rule: front (2)")
    assert said[4].startswith(
        "lid: done at front where back has no free server and at least half of its buffer is taken"
    )
    assert "one operation at a stop" in said[5]


def test_nothing_is_said_where_nothing_is_asked():
    assert not list(assignment(plan(PLAIN)))
    assert not list(qualities(plan(PLAIN.replace("{pace: 1.0, quality: 0.9}", "1.0"))))


def test_qualities_are_named_with_their_station():
    ((topic, says),) = qualities(plan(TEXT))
    assert topic == "quality" and "ana at front 0.9;" in says
