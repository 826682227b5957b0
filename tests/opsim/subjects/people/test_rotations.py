"""Job rotation: who works where, by the clock, by count and by rule, to the second."""

import random

import numpy as np
import pytest
from plans import ran

from opsim.log import COLUMNS, WALK, WORK

TWO_POSTS = """
opsim: 1
name: rotation
run: {start: Mon 06:00, horizon: 60 s}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
tasks: {do: {fixed: 4 s}}
stations:
  a: {at: here, tasks: [do]}
  b: {at: here, tasks: [do]}
  c: {at: here, tasks: [do]}
products: {p: {share: 0.5, route: [a]}, q: {share: 0.5, route: [b]}}
sources: {ps: {kind: saturated, products: [p]}, qs: {kind: saturated, products: [q]}}
workers:
  x: {walk: 2 m/s, skills: {a: 1, b: 1}}
  y: {like: x}
rotations: {turn: {workers: [x, y], posts: [a, b], every: 10 s}}
"""
BUFFERS = [("a: {at: here, tasks: [do]}", "a: {at: here, tasks: [do], buffer: 1}")]
BUFFERS += [("b: {at: here, tasks: [do]}", "b: {at: here, tasks: [do], buffer: 1}")]


def work(log, plan, worker):
    """[(from, to, station)] of a worker, by name."""
    rank = [one.name for one in plan.workers].index(worker)
    rows = log.where((log["kind"] == WORK) & (log["worker"] == rank))
    names = [plan.stations[station].name for station in rows["station"]]
    return sorted(zip(rows["start_s"].tolist(), rows["end_s"].tolist(), names))


def posts(log, plan, worker):
    """The stations where a worker begins, one letter each."""
    return "".join(name for _, _, name in work(log, plan, worker))


def test_by_the_clock_people_change_posts_and_finish_what_they_have_begun():
    """Tasks of 4 s: at 10 s the third one has lasted 2 s, and is finished at the old post until 12 s."""
    log, plan = ran(TWO_POSTS, *BUFFERS)
    assert work(log, plan, "x")[:6] == [
        *((0, 4, "a"), (4, 8, "a"), (8, 12, "a")),
        *((12, 16, "b"), (16, 20, "b"), (20, 24, "a")),
    ]
    assert posts(log, plan, "x") == "aaabbaaabbaaabb"
    assert posts(log, plan, "y") == "bbbaabbbaabbbaa"


def test_a_change_at_the_very_end_of_a_task_comes_before_the_next_one_begins():
    log, plan = ran(TWO_POSTS, *BUFFERS, ("every: 10 s", "every: 8 s"))
    assert posts(log, plan, "x") == "aabbaabbaabbaab"


def test_who_changes_posts_walks_when_there_is_work_for_him():
    """6 m at 2 m/s. y comes to b at 3 s, and is at his third part there when posts change at 12 s; at 15 s the next one
    calls x, who has been free since 12 s. From then on both change at the end of what they are at: 26 s, 37 s, 48 s.
    """
    edits = [("b: {at: here", "b: {at: there"), ("every: 10 s", "every: 12 s")]
    log, plan = ran(TWO_POSTS, *BUFFERS, *edits)
    walks = log.where((log["kind"] == WALK) & (log["worker"] == 0))
    assert walks["start_s"].tolist() == [15, 26, 37, 48]
    assert work(log, plan, "x")[2:7] == [(8, 12, "a"), (18, 22, "b"), (22, 26, "b"), (29, 33, "a"), (33, 37, "a")]


def test_by_count_all_change_when_one_post_has_done_so_many():
    """b takes twice as long: the third part of a at 12 s makes everybody change, what was begun at b is finished."""
    slow = ("b: {at: here, tasks: [do], buffer: 1}", "b: {at: here, tasks: [do, do], buffer: 1}")
    log, plan = ran(TWO_POSTS, *BUFFERS, ("every: 10 s", "after: 3"), slow)
    assert posts(log, plan, "x")[:8] == "aaabbbba"
    assert work(log, plan, "y")[:6] == [
        *((0, 4, "b"), (4, 8, "b"), (8, 12, "b"), (12, 16, "b")),
        *((16, 20, "a"), (20, 24, "a")),
    ]


def test_operations_that_end_together_are_one_change():
    """Both posts have done two at 8 s: one change, not two."""
    log, plan = ran(TWO_POSTS, *BUFFERS, ("every: 10 s", "after: 2"))
    assert posts(log, plan, "x") == "aabbaabbaabbaab"


def test_by_the_least_time_so_far_the_post_goes_to_who_was_there_for_the_shortest_time():
    """x, y and z at a and a rest. At first x and z are at a, by turns; at 10 s y has been there least and is alone; at
    20 s all have 10 s at either, so it goes by turns, y and x; at 30 s z has been there least.
    """
    edits = [("y: {like: x}", "y: {like: x}\n  z: {like: x}"), ("workers: [x, y]", "workers: [x, y, z]")]
    edits += [("posts: [a, b]", "posts: [a, []]"), ("every: 10 s", "every: 10 s, rule: least_time")]
    edits += [("{a: 1, b: 1}", "{a: 1}"), ("qs: {kind: saturated", "qs: {kind: poisson, every: 10 h")]
    edits += [("a: {at: here, tasks: [do]}", "a: {at: here, tasks: [do], servers: 3, buffer: 3}")]
    edits += [
        ("b: {at: here, tasks: [do]}", "b: {at: here, tasks: [free]}"),
        ("{do: {", "{free: {fixed: 1 s, automatic: true}, do: {"),
    ]
    log, plan = ran(TWO_POSTS, *edits)
    begun = {worker: [start_s for start_s, _, _ in work(log, plan, worker)] for worker in "xyz"}
    assert begun["x"][:6] == [0, 4, 8, 20, 24, 28]
    assert begun["y"][:5] == [10, 14, 18, 22, 26]
    assert begun["z"][:6] == [0, 4, 8, 30, 34, 38]


def test_a_rule_alone_is_asked_after_every_operation():
    log, plan = ran(TWO_POSTS, *BUFFERS, ("every: 10 s", "rule: least_time"))
    assert posts(log, plan, "x") == "abababababababa"


def test_a_rest_is_a_post_where_nobody_works():
    """One of two is at a, the other rests."""
    edits = [("posts: [a, b]", "posts: [a, []]"), ("skills: {a: 1, b: 1}", "skills: {a: 1}")]
    log, plan = ran(TWO_POSTS, *BUFFERS, *edits, ("y: {like: x}", "y: {like: x}\n  z: {skills: {b: 1}}"))
    assert [start_s for start_s, _, _ in work(log, plan, "x")] == [0, 4, 8, 20, 24, 28, 40, 44, 48]
    assert [start_s for start_s, _, _ in work(log, plan, "y")] == [12, 16, 32, 36, 52, 56]


def test_stations_in_no_post_are_open_to_everybody():
    """c is in no post: who is at a may work there too."""
    edits = [("route: [b]", "route: [c]"), ("skills: {a: 1, b: 1}", "skills: {a: 1, b: 1, c: 1}")]
    log, plan = ran(
        TWO_POSTS, *BUFFERS, *edits, ("c: {at: here, tasks: [do]}", "c: {at: here, tasks: [do], buffer: 1}")
    )
    assert set(posts(log, plan, "x")) == set(posts(log, plan, "y")) == {"a", "c"}


def test_one_worker_alone_goes_from_post_to_post():
    edits = [("\n  y: {like: x}", ""), ("workers: [x, y]", "workers: [x]")]
    log, plan = ran(TWO_POSTS, *BUFFERS, *edits)
    assert posts(log, plan, "x") == "aaabbaaabbaaabb"


def test_who_is_off_shift_leaves_his_post_to_the_others():
    """Three for two posts, of whom y comes at 06:00:20 and x goes at 06:00:40."""
    edits = [
        (
            "run: {",
            "shifts: {first: {from: '06:00:00', to: '06:00:40'}, second: {from: '06:00:20', to: '07:00'}}\nrun: {",
        ),
        ("x: {walk: 2 m/s,", "x: {shift: first, walk: 2 m/s,"),
        ("y: {like: x}", "y: {like: x, shift: second}\n  z: {skills: {a: 1, b: 1}}"),
        ("workers: [x, y]", "workers: [x, y, z]"),
        ("every: 10 s", "every: 20 s"),
    ]
    log, plan = ran(TWO_POSTS, *BUFFERS, *edits)
    assert posts(log, plan, "x")[:5] == "aaaaa" and posts(log, plan, "z")[:5] == "bbbbb"
    assert max(end_s for _, end_s, _ in work(log, plan, "x")) == 40
    last = [{name for start_s, _, name in work(log, plan, worker) if start_s >= 44} for worker in "yz"]
    assert sorted(map(sorted, last)) == [["a"], ["b"]]


@pytest.mark.parametrize("when", ["every: 7 s", "after: 5", "after: 4, rule: least_time", "rule: least_time"])
def test_the_order_of_declaration_decides_nothing(when):
    """But for the two lists of the rotation: turned round, the stations and the workers give the same rows."""
    lines = TWO_POSTS.replace("every: 10 s", when).split("\n")
    stations, workers = lines.index("stations:") + 1, lines.index("workers:") + 1
    lines[stations : stations + 3] = lines[stations : stations + 3][::-1]
    lines[workers : workers + 2] = ["  y: {walk: 2 m/s, skills: {a: 1, b: 1}}", "  x: {like: y}"]
    one, _ = ran(TWO_POSTS, *BUFFERS, ("every: 10 s", when))
    other, _ = ran("\n".join(lines), *BUFFERS)
    assert len(one) > 20
    assert all(
        np.array_equal(one[column], other[column], equal_nan=COLUMNS[column] is np.float64) for column in COLUMNS
    )


@pytest.mark.parametrize("seed", range(20))
def test_everybody_begins_only_at_his_post(seed):
    """Replayed beside the log: of n members and m posts, who has begun where, by the clock."""
    rng = random.Random(seed)
    n_people, n_posts, every_s = rng.randint(1, 5), rng.randint(2, 4), rng.randint(3, 30)
    names = [f"s{i}" for i in range(n_posts)]
    people = [f"w{i}" for i in range(n_people)]
    stations = "".join(f"  {name}: {{at: here, tasks: [do], buffer: 2, servers: 3}}\n" for name in names)
    text = f"""
opsim: 1
name: random rotation
run: {{horizon: 300 s, seed: {seed}}}
layout: {{places: {{here: [0 m, 0 m]}}}}
tasks: {{do: {{dist: exponential, mean: 5 s}}}}
stations:
{stations}
products: {{p: {{route: [{", ".join(names)}]}}}}
release: {{kind: saturated}}
workers: {{{", ".join(f"{w}: {{skills: {{{', '.join(f'{name}: 1' for name in names)}}}}}" for w in people)}}}
rotations: {{r: {{workers: [{", ".join(people)}], posts: [{", ".join(names)}], every: {every_s} s}}}}
"""
    log, plan = ran(text)
    n_slots, begun = max(n_people, n_posts), 0
    for number, worker in enumerate(people):
        for start_s, _, station in work(log, plan, worker):
            turn = int(start_s // every_s)
            slot = (number + turn) % n_slots
            assert station == names[slot % n_posts], (worker, start_s)
            begun += 1
    assert begun > 20


@pytest.mark.parametrize("seed", range(30))
def test_with_shifts_breaks_and_skills_everybody_begins_only_at_the_post_of_those_who_are_there(seed):
    """What is gone on with after a break is at the old post; all else is where the plan says that his post is."""
    rng = random.Random(100 + seed)
    n_people, n_posts = rng.randint(2, 6), rng.randint(2, 4)
    names, every_s = [f"s{i}" for i in range(n_posts)], rng.randint(40, 700)
    rule = rng.choice(["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"])
    stations = "".join(f"  {name}: {{at: here, tasks: [do], buffer: 2, servers: 3}}\n" for name in names)
    shifts = {"x": ("06:00", "06:40"), "y": ("06:20", "07:00"), "z": ("06:30", "07:30")}
    hours = [
        f"  {name}: {{from: '{a}', to: '{b}', at_break: {rule}, at_end: {rng.choice(['finish', rule])}, "
        f"breaks: {{rest: {{at: '06:35', lasts: {rng.randint(1, 4)} min}}}}}}\n"
        for name, (a, b) in shifts.items()
    ]
    people, members = [], ", ".join(f"w{n}" for n in range(n_people))
    for number in range(n_people):
        able = names if number == 0 else [name for name in names if rng.random() < 0.7] or names[:1]
        shift = f"shift: {rng.choice(list(shifts))}, " if number else ""
        people.append(f"  w{number}: {{{shift}skills: {{{', '.join(f'{name}: 1' for name in able)}}}}}\n")
    text = f"""
opsim: 1
name: random rotation
run: {{start: Mon 06:00, horizon: 2 h, seed: {seed}}}
layout: {{places: {{here: [0 m, 0 m]}}}}
shifts:
{"".join(hours)}
tasks: {{do: {{dist: exponential, mean: 25 s}}}}
stations:
{stations}
products: {{p: {{route: [{", ".join(names)}]}}}}
release: {{kind: saturated}}
workers:
{"".join(people)}
rotations: {{r: {{workers: [{members}], posts: [{", ".join(names)}], every: {every_s} s}}}}
"""
    log, plan = ran(text)
    (rotation,), duties = plan.rotations, [worker.duties for worker in plan.workers]
    can, begun = rotation.can(plan.workers), 0
    rows = log.where((log["kind"] == WORK) & (log["worker"] >= 0) & (log["progress_from"] == 0))
    seen = set()
    for start_s, worker, station, performance in zip(
        rows["start_s"], rows["worker"], rows["station"], rows["performance_id"]
    ):
        there = [n for n in range(n_people) if _on_duty(duties[rotation.workers[n]], start_s)]
        if performance not in seen:
            at = rotation.by_turns(there, int(start_s // every_s), can)
            assert station in rotation.posts[at[rotation.workers.index(worker)]], (start_s, worker)
            begun += 1
        seen.add(performance)
    assert begun > 20


def _on_duty(duties, now_s):
    return duties is None or any(duty.start_s <= now_s < duty.end_s for duty in duties)
