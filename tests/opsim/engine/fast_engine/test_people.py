"""Tools, holds, teams and attended runs together, on one floor with stops and people who go: one log.

Rows of tools: one for each piece, and waits that name the task whose tools were missing.

Crews in the compiled engine: each floor has something in it that goes from hand to hand, or waits behind another.

Posts given out by compiled steps against ``opsim.layout``.

Attended runs: the station's time and a worker who stays, also where somebody else does the rest of it.

Who is chosen for a team: by the rule, in natural order; nobody where too few are free.

Who is sent where, as SimPy's engine sends them: more stations than fit into one word of bits too.

Zones, floaters, priorities, the way ahead and stops of one operation: the pairs that SimPy's engine finds.
"""

from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made.machine import Floor, Given, empty_floor, entered
from opsim.engine.fast_engine.rotations import WIDTH, Posts, one_each, posts_of
from twins import twins

from opsim.engine.fast_engine.machine import cast
from opsim.engine.rules import ALLOCATION_RULES
from opsim.layout import _one_each
from opsim.log import BEHIND, BREAK, FINISH, HELD, NO_TOOL, TEAM, TOOL, TRANSPORT, WAIT, WALK, WORK

CELL = """
opsim: 1
name: hands
run: {start: Mon 06:00, horizon: 1800 s, seed: 8}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]}}
tools: {gun: {n: 1}, jig: {n: 2}}
tasks:
  bolt: {fixed: 8 s, hold: {tool: gun, from: 0.25, to: 0.75}, needs: {jig: 1}, repeat: 2}
  press: {fixed: 6 s, automatic: attended, hold: {tool: gun, from: 0.5, to: 1}}
  lift: {fixed: 5 s, team: 2, needs: {jig: 1}}
  spin: {fixed: 7 s, automatic: true, needs: {jig: 1}}
  pack: {fixed: 4 s}
defaults: {stations: {buffer: 4}}
stations:
  a: {at: p, tasks: [pack, bolt], servers: 2, setup: {otherwise: 5 s, by: product}}
  b: {at: q, tasks: [press, spin], yield: 0.8, needs: {jig: 1}, STOP}
  c: {at: r, tasks: [lift, pack], servers: 2, inspect: {finds: 0.9, then: {rework: a}, most: 1}}
products: {x: {share: 0.5, priority: 1, route: [a, b, c]}, y: {share: 0.5, lot: 2, route: [b, c]}}
release: {kind: renewal, every: {fixed: 20 s}}
workers:
  k: {walk: 1 m/s, skills: {a: 1.0, b: 1.0, c: 1.0}}
  l: {walk: 1 m/s, skills: {a: 0.8, c: 1.0}}
  m: {walk: 1 m/s, skills: {b: 1.2, c: 1.0}}
"""
STOPS = {
    "nothing": "servers: 1",
    "jam": "breakdowns: {jam: {every: {fixed: 25 s}, by: busy, repair: {fixed: 12 s}, job: resume}}",
    "preemption": "preempt: restart",
    "hours": "shift: open, at_close: finish",
}
SHIFTS = """
shifts:
  open: {from: 06:00, to: 06:15}
  day: {from: 06:00, to: 14:00, at_break: RULE, breaks: {tea: {at: 06:03, lasts: 2 min}, rest: {at: 06:10, lasts: 9 s}}}
"""


@pytest.mark.parametrize("stop", STOPS)
def test_hands_of_all_kinds_go_together(stop):
    log = twins(CELL + SHIFTS.replace("RULE", "finish"), ("STOP", STOPS[stop]))
    assert len(log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL))) > 20
    assert len(log.where((log["kind"] == WAIT) & (log["cause"] == TEAM))) > 5 and len(log.of(TOOL)) > 50


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"])
def test_hands_of_who_has_to_go(rule):
    text = CELL.replace("STOP", "servers: 1") + SHIFTS.replace("RULE", rule)
    log = twins(text, *((f"{w}: {{walk", f"{w}: {{shift: day, walk") for w in "kl"))
    assert len(log.of(TOOL)) > 50


TWO = """
opsim: 1
name: grips
run: {horizon: 95 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tools: {clamp: {n: 3}}
tasks: {one: {fixed: 4 s, needs: {clamp: 2}}, two: {fixed: 6 s, needs: {clamp: 3}}}
stations: {s: {at: a, tasks: [one], buffer: 1}, t: {at: a, tasks: [two], buffer: 1}}
products: {p: {route: [[s, t]]}}
release: {kind: saturated}
workers: {w1: {skills: {s: 1.0}}, w2: {skills: {t: 1.0}}}
"""


def test_each_piece_has_a_row_and_each_wait_its_task():
    log = twins(TWO)
    rows = log.of(TOOL)
    assert {2, 3} == {int((rows["start_s"] == start_s).sum()) for start_s in set(rows["start_s"].tolist())}
    waits = log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL))
    assert len(set(waits["task"].tolist())) == 2


ROW = """
opsim: 1
name: row
run: {start: Mon 06:00, horizon: 1200 s, seed: 3}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [6 m, 0 m]}}
tasks: {t: {dist: lognormal, mean: 10 s, cv: 0.4}, u: {fixed: 12 s, repeat: 2}}
stations:
  a: {at: p, tasks: [t], buffer: 0}
  b: {at: q, tasks: [u], buffer: 1, servers: 2}
  c: {at: r, tasks: [t], buffer: 0}
products: {bag: {route: [a, b, c], share: 0.7}, box: {route: [a, c], share: 0.3}}
release: {kind: saturated}
workers:
  w1: {walk: 1 m/s, skills: {a: 1, b: 1, c: 1}}
  w2: {walk: 1 m/s, skills: {a: 1, b: 1.5, c: 1}}
  w3: {walk: 2 m/s, skills: {a: 0.5, b: 1, c: 1}}
crews: {line: {kind: bucket_brigade, stations: [a, b, c], workers: [w3, w1, w2]}}
"""
RABBITS = ("kind: bucket_brigade", "kind: rabbit_chase")
CARRIED = (("share: 0.7}", "share: 0.7, carried: true}"), ("share: 0.3}", "share: 0.3, carried: true}"))


@pytest.mark.parametrize("edits", [(), (RABBITS,)], ids=["brigade", "rabbits"])
def test_jobs_go_from_hand_to_hand_alike(edits):
    log = twins(ROW, *edits)
    assert log.of(FINISH)["job"].size > 40
    pieces = log.of(WORK)
    assert ((pieces["progress_from"] > 0).any()) == (not edits)  # a brigade takes over in the middle
    waits = log.of(WAIT)
    assert (waits["cause"] == BEHIND).any()


@pytest.mark.parametrize("kind", ["free", "held"])
def test_jobs_that_are_carried_keep_their_order_alike(kind):
    log = twins(f"{ROW}allocation: {{when_blocked: {kind}}}\n", *CARRIED)
    assert log.of(TRANSPORT)["job"].size > 40


def test_a_card_picks_past_who_has_to_stay_behind_alike():
    assert twins(f"{ROW}cards: {{conwip: {{n: 3}}}}\n").of(FINISH)["job"].size > 30


@pytest.mark.parametrize("rule", ["hand_over", "resume", "restart"])
def test_who_has_a_break_lets_go_of_his_job_alike(rule):
    shift = (
        "shifts: {early: {from: 06:00, to: 14:00, at_break: RULE, "
        "breaks: {rest: {at: 06:05, lasts: 2 min}, tea: {at: 06:12, lasts: 3 min}}}}\n"
    )
    with_shift = ("{walk: 1 m/s, skills: {a: 1, b: 1.5", "{shift: early, walk: 1 m/s, skills: {a: 1, b: 1.5")
    log = twins(ROW + shift.replace("RULE", rule), with_shift)
    assert log.of(BREAK)["worker"].size == 2


as_posts = cast(Posts)


@entered
def give_out(floor: Floor, given: Given) -> None:
    one_each(floor, as_posts(given.any))


def compiled(n_posts, left, can, keys):
    """{person: post} by the steps. keys : by (person, post)"""
    arena, floor = empty_floor()
    n_members = max(left) + 1
    build = SimpleNamespace(
        arena=arena,
        ints=lambda values: arena.array("int", values),
        floats=lambda values: arena.array("float", values),
    )
    able = [(person, post) in can for post in range(n_posts) for person in range(n_members)]
    posts = posts_of(build, n_posts, n_members, able)
    posts.left.fill(left)
    for (person, post), key in keys.items():
        for i, number in enumerate(key):
            posts.keys[(post * n_members + person) * WIDTH + i] = number
    arena.freeze()
    give_out(floor.address, any=posts)
    return {person: posts.taken[person] for person in left if posts.taken[person] >= 0}


@st.composite
def cases(draw):
    """Some people, who can be at some of a few posts, with keys that are often the same."""
    n_posts = draw(st.integers(1, 5))
    left = sorted(draw(st.sets(st.integers(0, 6), min_size=1, max_size=6)))
    pairs = [(person, post) for person in left for post in range(n_posts)]
    can = {pair for pair in pairs if draw(st.integers(0, 2))}
    keys = {pair: tuple(float(draw(st.integers(0, 2))) for _ in range(WIDTH)) for pair in pairs}
    return n_posts, left, can, keys


@settings(max_examples=300, deadline=None)
@given(cases())
def test_each_post_goes_to_whom_the_rule_gives_it(case):
    n_posts, left, can, keys = case
    known = _one_each(n_posts, left, lambda person, post: (person, post) in can, lambda *pair: keys[pair], 0)
    assert compiled(*case) == known


ATTENDED_CELL = """
opsim: 1
name: attended
run: {horizon: 900 s, seed: 6}
layout: {places: {a: [0 m, 0 m]}}
tasks: {bake: {dist: lognormal, mean: 10 s, cv: 0.4, automatic: attended}, fill: {fixed: 3 s}}
stations: {s: {at: a, tasks: [fill, bake], servers: 2, buffer: 2, STOP}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {w1: {skills: {s: 1.0}}, w2: {skills: {s: 0.5}}}
"""


def test_a_run_that_is_broken_off_is_gone_on_with_by_anybody():
    log = twins(ATTENDED_CELL, ("STOP", "maintenance: {wash: {every: 21 s, lasts: 4 s, when: at_once}}"))
    work = log.of(WORK)
    assert len(work.where(work["progress_from"] > 0)) > 10


def test_a_run_that_is_lost_is_another_one():
    jam = "breakdowns: {jam: {every: {fixed: 19 s}, by: busy, repair: {fixed: 4 s}, job: restart}}"
    assert len(twins(ATTENDED_CELL, ("STOP", jam)).of(WORK)) > 50


MANY = """
opsim: 1
name: members
run: {horizon: 600 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {carry: {fixed: 10 s, team: 3, per: lot, repeat: 2}, sort: {fixed: 7 s, team: 2}}
stations: {s: {at: a, tasks: [carry], servers: 2, buffer: 3}, t: {at: b, tasks: [sort], servers: 2, buffer: 3}}
products: {x: {share: 0.5, lot: 3, route: [s, t]}, y: {share: 0.5, route: [t, s]}}
release: {kind: renewal, every: {fixed: 25 s}}
workers: {WORKERS}
allocation: {rule: best_skill, priorities: [stations]}
"""


def team_rows(n, *edits):
    workers = ", ".join(
        f"m{i}: {{walk: 1 m/s, home: {'ab'[i % 2]}, skills: {{s: {1 - i / 20}, t: {0.5 + i / 20}}}}}" for i in range(n)
    )
    log = twins(MANY.replace("WORKERS", workers), *edits)
    return log.where((log["kind"] == WORK) & (log["job"] < 0))


def test_of_many_the_best_are_chosen():
    assert len(set(team_rows(7)["worker"].tolist())) == 7


def test_whoever_is_there_is_chosen_where_just_enough_are():
    assert len(team_rows(3)) > 30


def test_zones_and_floaters_choose_members_too():
    floats = ("m0: {", "m0: {floater: true, "), ("m1: {", "m1: {zone: [t], ")
    assert team_rows(5, *floats)["worker"].tolist() != team_rows(5)["worker"].tolist()


N_WORKERS = 7
SHORT, LONG = 9, 130
"""Stations: some, and more than two words of 64."""
SLOWLY = pytest.param(LONG, marks=pytest.mark.slow)


def hall(n_stations: int, *, rule: str, idle: str, priority: bool) -> str:
    """Jobs that come in bursts to stations here and there, of people who can each do a third of them."""
    ranks = range(n_stations)
    first = ", priority: 2" if priority else ""
    skills = [{f"s{s}": 1 + (s * w) % 3 / 4 for s in ranks if (s + w) % 3 == 0} for w in range(N_WORKERS)]
    rounds = [", patrol: [" + ", ".join(able) + "]" if idle == "patrol" else "" for able in skills]
    return "\n".join(
        [
            "opsim: 1",
            "name: hall",
            "run: {horizon: 25 min, seed: 8}",
            "layout: {places: {" + ", ".join(f"p{i}: [{i % 4} m, {i // 8} m]" for i in ranks) + "}}",
            "tasks: {t: {dist: exponential, mean: 20 s}}",
            "stations:",
            *(f"  s{i}: {{at: p{i // 6}, tasks: [t], servers: 2{'' if i % 5 else first}}}" for i in ranks),
            "products:",
            *(f"  q{i}: {{route: [s{i}, s{(5 * i + 3) % n_stations}]}}" for i in ranks),
            "sources:",
            *(f"  from{i}: {{kind: poisson, every: {n_stations * 16} s, products: [q{i}]}}" for i in ranks),
            "workers:",
            *(f"  w{w}: {{skills: {skills[w]}{rounds[w]}}}".replace("'", "") for w in range(N_WORKERS)),
            f"allocation: {{rule: {rule}, idle: {idle}}}",
        ]
    )


@pytest.mark.parametrize("n_stations", [SHORT, SLOWLY])
@pytest.mark.parametrize("rule", ALLOCATION_RULES)
def test_the_same_people_go_to_the_same_stations(rule, n_stations):
    log = twins(hall(n_stations, rule=rule, idle="stay", priority=False))
    assert len(set(log.of(WORK)["worker"])) == N_WORKERS
    assert len(set(log.of(WORK)["station"])) > n_stations / 2


@pytest.mark.parametrize("idle", ["stay", "home", "patrol"])
@pytest.mark.parametrize("n_stations", [SHORT, LONG])
def test_what_blocks_put_before_the_rule_and_who_is_idle(idle, n_stations):
    log = twins(hall(n_stations, rule="longest_queue", idle=idle, priority=True))
    assert len(log.of(WALK)) > 20


SHOP = """
opsim: 1
name: assignment
run: {horizon: 900 s, seed: 5}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]}}
tasks: {cut: {fixed: 6 s}, weld: {fixed: 9 s}}
defaults: {stations: {servers: 2, buffer: 9}}
stations: {a: {at: p, tasks: [cut]}, b: {at: q, tasks: [weld]}, c: {at: r, tasks: [cut]}}
products: {x: {share: 0.5, route: [a, b, c]}, y: {share: 0.5, priority: 1, route: [c, a]}}
release: {kind: renewal, every: {fixed: 6 s}, at_once: 1}
workers:
  w1: {walk: 1 m/s, skills: {a: 1.0, b: 1.0, c: 1.0}}
  w2: {walk: 1 m/s, skills: {a: 1.0, b: 0.5, c: 1.0}}
  w3: {walk: 1 m/s, skills: {a: 0.5, b: 1.0, c: 1.0}}
allocation: {rule: oldest_job}
"""
PRIOR = "cut", "weld"
"""Tasks of the stations that have a priority."""


def served(log):
    """Where who works, in turn."""
    rows = log.of(WORK)
    return list(zip(rows["worker"].tolist(), rows["station"].tolist(), rows["start_s"].tolist()))


def test_zones_and_floaters_come_before_the_rule():
    plain = twins(SHOP)
    zones = (
        ("w1: {", "w1: {zone: [b], "),
        ("w2: {", "w2: {zone: [a], floater: true, "),
        ("w3: {", "w3: {floater: true, "),
    )
    assert served(twins(SHOP, *zones)) != served(plain)


@pytest.mark.parametrize("first", ["", "stations", "products", "products, stations", "stations, products"])
def test_priorities_count_in_the_order_that_is_said(first):
    edits = [("rule: oldest_job", f"rule: oldest_job, priorities: [{first}]")]
    edits += [(f"tasks: [{task}]}}, ", f"tasks: [{task}], priority: 1}}, ") for task in PRIOR if "stations" in first]
    assert (served(twins(SHOP, *edits)) == served(twins(SHOP))) == (not first)


@pytest.mark.parametrize("rule", ["most_downstream", "best_skill", "nearest", "longest_queue"])
def test_rules_choose_the_same_pairs(rule):
    assert served(twins(SHOP, ("oldest_job", rule))) != served(twins(SHOP))


@pytest.mark.parametrize("serve", ["one", "exhaustive"])
@pytest.mark.parametrize(
    "places", ["p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]", "p: [0 m, 0 m], q: [0 m, 0 m], r: [1 m, 0 m]"]
)
def test_who_patrols_serves_the_same_stops(serve, places):
    rounds = [(f"{w}: {{walk", f"{w}: {{patrol: [a, b, c], walk") for w in ("w1", "w2", "w3")]
    at = ("p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]", places)
    log = twins(SHOP, *rounds, at, ("rule: oldest_job", f"rule: oldest_job, idle: patrol, serve: {serve}"))
    assert len(log.of(WALK)) > 20
