"""Wrong words about quality, tools, holds, teams and attended runs: what is said of each, and where."""

import plans
import pytest

GOOD = """
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
PATROL = (
    ("release:", "allocation: {idle: patrol}\nrelease:"),
    ("w1: {", "w1: {patrol: [s1, s2], "),
    ("w2: {", "w2: {patrol: [s3], "),
    ("w3: {", "w3: {patrol: [s3], "),
)
SETUP = ("s1: {at: a,", "s1: {at: a, setup: {otherwise: mend},")


def answer(*edits):
    return plans.answer(GOOD, *edits)


CASES = [
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
    ("patrol", PATROL, ["task 'look' takes a team, and workers who patrol", "write 'idle: stay'"]),
    ("setup", [SETUP], ["stations.s1.setup.otherwise: 'mend' has 'needs', and a set-up is done by one worker"]),
    (
        "gap",
        [("saturated", "renewal, every: {fixed: 5 s, team: 2}")],
        ["release.every: a gap between jobs has no 'team'"],
    ),
]


@pytest.mark.parametrize(("edits", "said"), [pytest.param(*case[1:], id=case[0]) for case in CASES])
def test_a_wrong_word_is_answered_with_its_place_and_a_way_out(edits, said):
    found = answer(*edits)
    assert found.startswith("line.yaml:"), found
    assert not [words for words in said if words not in found], found


def test_the_good_words_are_good():
    assert answer() == "good"


def test_a_rework_station_is_on_a_way_where_products_have_a_routing():
    routing = "routing: {start: s1, s1: s2, s2: out, s3: s1}"
    assert answer(("route: [s1, s2]", routing)) == "good"
    assert "no way leads to 's3'" in answer(("route: [s1, s2]", routing), ("rework: s3", "rework: s1"))


def test_a_carrier_must_be_able_to_walk_to_the_rework_and_back():
    paths = ("layout: {places", "layout: {distance: paths, paths: [[a, b]], places")
    carried = ("part: {route", "part: {carried: true, route")
    found = answer(paths, carried)
    assert "no path leads from 'a' to 'c', and w1 has to walk there" in found
    assert answer(paths, carried, ("[[a, b]]", "[[a, b, c]]")).endswith("good")
    assert "has to walk there" not in answer(paths)
