"""Wrong words about who does what: zones, priorities, rounds, skill levels, shared work; and right ones.

Crews that cannot work: members, stations and ways that do not fit.

Wrong words about quality, tools, holds, teams and attended runs: what is said of each, and where.

Wrong words about job rotation: what is said of each, and where.
"""

import plans
import pytest
from plans import loaded

from opsim.problems import ScenarioError

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


TEXT = """
opsim: 1
name: crews
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}, big: {fixed: 10 s, team: 2}}
stations: {a: {at: hall, tasks: [t]}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [t]}}
products: {bag: {route: [a, b, c]}, bit: {route: [c]}}
release: {kind: poisson, every: 60 s, products: [bag]}
workers:
  ana: {skills: {a: 1, b: 1, c: 1}}
  ben: {skills: {a: 1, b: 1, c: 1}}
  cem: {skills: {a: 1, c: 1}}
crews: CREWS
"""
ONE = "{row: {kind: bucket_brigade, stations: [a, b, c], workers: [ana, ben]}}"


def read(crews=ONE, *edits):
    text = TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return loaded(text.replace("CREWS", crews))


def said(crews=ONE, *edits):
    with pytest.raises(ScenarioError) as caught:
        read(crews, *edits)
    return "\n".join(f"{p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


@pytest.mark.parametrize("crews", [
    ONE,
    "{row: {kind: rabbit_chase, stations: [b], workers: [ben]},"
    " end: {kind: bucket_brigade, stations: [c], workers: [cem]}}",
])  # fmt: skip
def test_crews_along_a_line_are_read(crews):
    read(crews)


@pytest.mark.parametrize(("old", "new", "expected"), [
    ("bucket_brigade", "bucket_chain", "crews.row.kind: expected bucket_brigade or rabbit_chase, found 'bucket_chain'"),
    ("[a, b, c]", "[a, d]", "crews.row.stations[1]: no station 'd' | known stations: a, b, c"),
    ("[ana, ben]", "[ana, bben]", "crews.row.workers[1]: no worker 'bben' | did you mean 'ben'?"),
    ("[a, b, c]", "[a, b, a]", "crews.row.stations[2]: a is twice here | a station has one place in one crew"),
    ("[ana, ben]", "[]", "crews.row.workers: "),
    ("ben]}}", "ben]}, x: {kind: rabbit_chase, stations: [c], workers: [ana]}}",
     "crews.x.stations[0]: c is in crew row already"),
    ("ben]}}", "ben]}, x: {kind: rabbit_chase, stations: [c], workers: [ana]}}",
     "crews.x.workers[0]: ana is in crew row already"),
    ("[ana, ben]", "[ana, cem]",
     "crews.row.workers[1]: cem has no skill at 'b', where his job may take him | add 'b: 1.0' to the skills of cem"),
    ("[a, b, c]", "[b, a, c]", "products.bag.route[1]: 'b' comes after 'a'; in crew row it comes before"),
])  # fmt: skip
def test_what_does_not_fit_is_told_with_its_place(old, new, expected):
    assert old in ONE
    assert expected in said(ONE.replace(old, new))


@pytest.mark.parametrize(("old", "new", "expected"), [
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t], batch: 2}",
     "crews.row.stations[1]: b has 'batch', whose jobs"),
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t], preempt: resume}",
     "crews.row.stations[1]: b has 'preempt'"),
    ("b: {at: hall, tasks: [t]}", "b: {at: hall, tasks: [t, big]}",
     "crews.row.stations[1]: b has task 'big' of a team"),
    ("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t]}, d: {at: hall, tasks: [t], share: {tasks: [t], with: a}}",
     "crews.row.stations[0]: a has tasks that it shares with another station"),
    ("bag: {route: [a, b, c]}", "bag: {route: [a, b, c], split: {c: {bit: 2}}}",
     "crews.row.stations[2]: c has a split"),
    ("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t], inspect: {then: {rework: a}}}",
     "stations.c.inspect.then.rework: jobs would go back from 'c' to 'a', and those of crew row never do"),
    ("bag: {route: [a, b, c]}", "bag: {routing: {start: a, a: b, b: {a: 0.5, c: 0.5}, c: out}}",
     "products.bag.routing.b.a: jobs would go back from 'b' to 'a'"),
    ("workers:", "allocation: {idle: patrol}\nworkers:",
     "allocation.idle: with idle workers on patrol there can be no crews"),
    ("workers:", "rotations: {r: {workers: [ana, cem], posts: [a, c], every: 1 h}}\nworkers:",
     "crews.row.workers[0]: ana changes posts in rotation r, and a crew keeps its members"),
    ("workers:", "lines: {l: {kind: indexed, stations: [a, b], takt: 60 s, unfinished: stop}}\nworkers:",
     "crews.row.stations[0]: a is part of the paced line l, which moves by itself"),
])  # fmt: skip
def test_what_a_crew_cannot_do_is_refused(old, new, expected):
    assert expected in said(ONE, (old, new))


def test_a_station_beside_a_crew_needs_somebody_of_its_own():
    text = TEXT.replace("bag: {route: [a, b, c]}", "bag: {route: [a, b, c, d]}").replace("c: 1}}", "c: 1, d: 1}}")
    text = text.replace("c: {at: hall, tasks: [t]}", "c: {at: hall, tasks: [t]}, d: {at: hall, tasks: [t]}")
    loaded(text.replace("CREWS", ONE))  # cem is in no crew
    with pytest.raises(ScenarioError) as caught:
        loaded(text.replace("cem: {skills: {a: 1, c: 1, d: 1}}", "cem: {skills: {a: 1}}").replace("CREWS", ONE))
    (problem,) = caught.value.problems
    assert problem.message.startswith("task 't' needs a worker, and all with the skill 'd' work for crew row")


def test_all_mistakes_are_told_at_once():
    told = said("{row: {kind: bucket_brigade, stations: [a, d], workers: [ana, eve, ana]}}")
    assert all(word in told for word in ("no station 'd'", "no worker 'eve'", "ana is twice here"))


WRONG_HANDS_GOOD = """
opsim: 1
name: hands
run: {horizon: 100 s, seed: 3}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [6 m, 0 m]}}
tools: {gun: {n: 1}, jig: {n: 2}}
tasks:
  make: {emulator: work/fasten, hold: {tool: gun, from: start, to: stop}}
  kit:
    motions: [work/reach, {emulator: work/fasten, repeat: 2}]
    hold: {tool: gun, from: reach.touch, to: fasten.2.stop}
  look: {fixed: 10 s, team: 2}
  mend: {fixed: 20 s, automatic: attended, needs: {jig: 1}}
stations:
  s1: {at: a, tasks: [make], buffer: 2, yield: 0.9}
  s2: {at: b, tasks: [kit], buffer: 2, inspect: {finds: 0.9, then: {rework: s3}, most: 2}}
  s3: {at: c, tasks: [look, mend], buffer: 9, needs: {jig: 1}}
products: {part: {route: [s1, s2]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0, s2: 1.0}}, w2: {skills: {s3: 1.0}}, w3: {skills: {s3: 1.0}}}
"""
WRONG_HANDS_PATROL = (
    ("release:", "allocation: {idle: patrol}\nrelease:"),
    ("w1: {", "w1: {patrol: [s1, s2], "),
    ("w2: {", "w2: {patrol: [s3], "),
    ("w3: {", "w3: {patrol: [s3], "),
)
SETUP = ("s1: {at: a,", "s1: {at: a, setup: {otherwise: mend},")


def wrong_hands_answer(*edits):
    return plans.answer(WRONG_HANDS_GOOD, *edits)


WRONG_HANDS_CASES = [
    ("yield", [("yield: 0.9", "yield: 0")], ["stations.s1.yield: a yield must be more than 0"]),
    ("sum", [("yield: 0.9", "yield: 1.2")], ["stations.s1.yield: a probability lies between 0 and 1, found 1.2"]),
    ("both", [("yield: 0.9", "yield: 0.9, scrap: 0.1")], ["stations.s1.yield: scrap and yield both", "'yield: 0.9'"]),
    ("alarms", [("finds: 0.9", "false_alarms: 1")], ["inspect.false_alarms: this must be less than 1"]),
    ("key", [("finds: 0.9", "fins: 0.9")], ["stations.s2.inspect.fins: unknown key 'fins'", "did you mean 'finds'?"]),
    ("then", [("{rework: s3}", "{rewrk: s3}")], ["expected scrap or {rework: STATION}", "did you mean 'rework'?"]),
    ("most", [("{rework: s3}", "scrap")], ["inspect.most: most counts reworks, and nothing is reworked here"]),
    ("nowhere", [("rework: s3", "rework: s33")], ["inspect.then.rework: no station 's33'", "did you mean 's3'?"]),
    ("ahead", [("[s1, s2]", "[s1, s2, s3]")], ["'part' comes to 's3' only after s2: nothing can go back there"]),
    (
        "unskilled",
        [("w2: {skills: {s3: 1.0}}, w3: {skills: {s3: 1.0}}", "w2: {skills: {s1: 1.0}}")],
        ["the skill 's3'"],
    ),
    ("no tool", [("{tool: gun, from: start", "{tool: gnu, from: start")], ["tasks.make.hold.tool: no tool 'gnu'"]),
    (
        "no need",
        [("9, needs: {jig", "9, needs: {jgi")],
        ["stations.s3.needs.jgi: no tool 'jgi'", "did you mean 'jig'?"],
    ),
    ("none", [("jig: {n: 2}", "jig: {n: 0}")], ["tools.jig.n: must be at least 1, found 0"]),
    ("too few", [("jig: {n: 2}", "jig: {}")], ["a job at s3 in task mend needs 2 of 'jig', and there is 1", "n: 2"]),
    ("no mark", [("from: start", "from: strat")], ["tasks.make.hold.from: no mark 'strat'", "did you mean 'start'?"]),
    ("turned", [("from: start, to: stop", "from: stop, to: start")], ["tasks.make.hold.to: start comes before stop"]),
    ("one of many", [("reach.touch", "fasten.start")], ["no mark 'fasten.start'", "did you mean 'fasten.2.start'?"]),
    ("no body", [("emulator: work/fasten, hold", "fixed: 5 s, hold")], ["this task has no marks", "such as 0.25"]),
    (
        "shares",
        [("from: start, to: stop", "from: 0.5, to: 0.2")],
        ["hold.to: from (0.5) must come before to (0.2)", "from: 0.2, to: 0.5"],
    ),
    ("beyond", [("from: start, to: stop", "to: 1.5")], ["a share of the performance lies between 0 and 1, found 1.5"]),
    ("alone", [("team: 2", "team: 2, automatic: true")], ["tasks.look.team: nobody is needed", "automatic: attended"]),
    ("no hands", [("work/fasten, hold", "work/fasten, automatic: true, hold")], ["hold: nobody holds a tool where"]),
    ("whose", [("work/fasten, hold", "work/fasten, team: 2, hold")], ["tasks.make.hold: a tool is held by one worker"]),
    ("time", [("work/fasten, hold", "work/fasten, automatic: attended, hold")], ["takes its worker's time, not the"]),
    ("word", [("automatic: attended", "automatic: atended")], ["expected true, false or attended, found 'atended'"]),
    ("too small", [("w3: {skills: {s3: 1.0}}", "w3: {skills: {s1: 1.0}}")], ["a team of 2, and only 1 of the workers"]),
    ("patrol", WRONG_HANDS_PATROL, ["task 'look' takes a team, and workers who patrol", "write 'idle: stay'"]),
    ("setup", [SETUP], ["stations.s1.setup.otherwise: 'mend' has 'needs', and a set-up is done by one worker"]),
    (
        "gap",
        [("saturated", "renewal, every: {fixed: 5 s, team: 2}")],
        ["release.every: a gap between jobs has no 'team'"],
    ),
]


@pytest.mark.parametrize(("edits", "said"), [pytest.param(*case[1:], id=case[0]) for case in WRONG_HANDS_CASES])
def test_a_wrong_word_is_answered_with_its_place_and_a_way_out(edits, said):
    found = wrong_hands_answer(*edits)
    assert found.startswith("line.yaml:"), found
    assert not [words for words in said if words not in found], found


def test_the_good_words_are_good():
    assert wrong_hands_answer() == "good"


def test_a_rework_station_is_on_a_way_where_products_have_a_routing():
    routing = "routing: {start: s1, s1: s2, s2: out, s3: s1}"
    assert wrong_hands_answer(("route: [s1, s2]", routing)) == "good"
    assert "no way leads to 's3'" in wrong_hands_answer(("route: [s1, s2]", routing), ("rework: s3", "rework: s1"))


def test_a_carrier_must_be_able_to_walk_to_the_rework_and_back():
    paths = ("layout: {places", "layout: {distance: paths, paths: [[a, b]], places")
    carried = ("part: {route", "part: {carried: true, route")
    found = wrong_hands_answer(paths, carried)
    assert "no path leads from 'a' to 'c', and w1 has to walk there" in found
    assert wrong_hands_answer(paths, carried, ("[[a, b]]", "[[a, b, c]]")).endswith("good")
    assert "has to walk there" not in wrong_hands_answer(paths)


WRONG_ROTATIONS_GOOD = """
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


def wrong_rotations_answer(*edits):
    return plans.answer(WRONG_ROTATIONS_GOOD, *edits)


def test_a_rotation_that_is_right_is_read():
    assert wrong_rotations_answer() == "good"
    assert (
        wrong_rotations_answer(("every: 2 h", "after: 50"))
        == wrong_rotations_answer(("every: 2 h", "rule: least_time"))
        == "good"
    )
    assert (
        wrong_rotations_answer(("every: 2 h", "after: 50, rule: in_turn"), ("[label, lift]]", "[label, lift], []]"))
        == "good"
    )


WRONG_ROTATIONS_CASES = [
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


@pytest.mark.parametrize(
    ("edits", "words"), [case[1:] for case in WRONG_ROTATIONS_CASES], ids=[case[0] for case in WRONG_ROTATIONS_CASES]
)
def test_each_mistake_is_named_where_it_stands(edits, words):
    said = wrong_rotations_answer(*edits)
    assert all(word in said for word in words), said
    assert "line.yaml:11:" in said


def test_all_mistakes_are_told_at_once_of_wrong_rotations():
    said = wrong_rotations_answer(("[ana, ben]", "[anna, bem]"), ("[label, lift]]", "[lable, lift]]"))
    assert "3 problems" in said
