"""Tools by hand arithmetic: who has which from when to when, and who waits."""

import plans
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.laws.audit import audit
from opsim.log import BLOCKED, HELD, NO_TOOL, TOOL, WORK

CELL = """
opsim: 1
name: tools
run: {horizon: 100 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [0 m, 0 m], c: [0 m, 0 m]}}
tools: {jig: {n: 1}, clamp: {n: 2}}
tasks: {one: {fixed: 4 s}, two: {fixed: 6 s}, slow: {fixed: 20 s}}
stations:
  s1: {at: a, tasks: [one, two], buffer: 1}
  s2: {at: b, tasks: [one, two], buffer: 1}
  s3: {at: c, tasks: [slow], buffer: 0}
products: {part: {route: [[s1, s2]]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""


def ran(*edits):
    return plans.ran(CELL, *edits)


def spans(log, kind, station=None, cause=None):
    rows = log.of(kind)
    keep = rows["start_s"] >= 0
    if station is not None:
        keep &= rows["station"] == log.names["station"].index(station)
    if cause is not None:
        keep &= rows["cause"] == cause
    rows = rows.where(keep)
    return sorted(zip(rows["start_s"].tolist(), rows["end_s"].tolist()))


def test_a_task_has_its_tool_for_as_long_as_it_lasts():
    log, _ = ran(("two: {fixed: 6 s}", "two: {fixed: 6 s, needs: {jig: 1}}"))
    assert spans(log, TOOL, "s1")[:3] == [(4, 10), (16, 22), (28, 34)]
    assert spans(log, HELD, "s2", NO_TOOL)[:2] == [(4, 10), (20, 22)]
    assert spans(log, TOOL, "s2")[:3] == [(10, 16), (22, 28), (34, 40)]


def test_a_station_keeps_its_tool_until_the_job_has_left():
    log, _ = ran(("s1: {at: a,", "s1: {at: a, needs: {jig: 1},"), ("[[s1, s2]]", "[s1, s3]"))
    assert spans(log, BLOCKED, "s1")[:2] == [(20, 30), (40, 50)]
    assert spans(log, TOOL, "s1")[:3] == [(0, 10), (10, 30), (30, 50)]


def test_a_worker_at_hand_is_free_while_a_tool_is_missing():
    log, _ = ran(
        ("two: {fixed: 6 s}", "two: {fixed: 6 s, needs: {jig: 1}}"),
        ("{skills: {s2: 1.0}}", "{skills: {s2: 1.0, s1: 1.0}}"),
    )
    assert spans(log, HELD, "s2", NO_TOOL)[0] == (4, 10)
    assert not [span for span in spans(log, TOOL) if span[1] - span[0] not in (6, 2, 4)]


def test_several_tools_are_taken_all_at_once_or_none():
    """s1 needs a jig and two clamps, s2 one clamp: neither keeps one from the other while it waits for the rest."""
    both = "needs: {jig: 1, clamp: 2}"
    log, p = ran(("s1: {at: a,", f"s1: {{at: a, {both},"), ("s2: {at: b,", "s2: {at: b, needs: {clamp: 1},"))
    assert spans(log, TOOL, "s1")[:6] == [(0, 10)] * 3 + [(20, 30)] * 3
    assert spans(log, TOOL, "s2")[:2] == [(10, 20), (30, 40)]
    assert [tool.n for tool in p.tools] == [2, 1]


def test_tools_go_to_who_waits_longest_and_can_have_all_he_needs():
    """The jig goes round s1, s2, s3 in the order of asking, though s1 is ready to ask again at once."""
    log, _ = ran(
        ("[[s1, s2]]", "[[s1, s2, s3]]"),
        *((f"{s}: {{at: {a},", f"{s}: {{at: {a}, needs: {{jig: 1}},") for s, a in zip(("s1", "s2", "s3"), "abc")),
    )
    assert [log.names["station"][s] for s in log.of(TOOL)["station"]][:6] == ["s1", "s2", "s3", "s1", "s2", "s3"]


def test_a_job_of_higher_priority_gets_the_tool_first():
    text = (
        ("[[s1, s2]]}", "[s1]}, rush: {share: 0.5, priority: 1, route: [s2]}, late: {share: 0.25, route: [s3]}"),
        ("part: {", "part: {share: 0.25, "),
        ("slow: {fixed: 20 s}", "slow: {fixed: 10 s}"),
        *((f"{s}: {{at: {a},", f"{s}: {{at: {a}, needs: {{jig: 1}},") for s, a in zip(("s1", "s2", "s3"), "abc")),
        ("{kind: saturated}", "{kind: renewal, every: {fixed: 1 s}}"),
        ("buffer: 0", "buffer: 99"),
        ("buffer: 1}\n  s2", "buffer: 99}\n  s2"),
        ("buffer: 1}\n  s3", "buffer: 99}\n  s3"),
    )
    log, _ = ran(*text)
    rush = [log.names["station"][s] for s in log.of(TOOL)["station"]]
    assert rush.count("s2") > len(rush) - 2


def test_rows_of_waiting_say_which_task_wants_the_tool():
    log, _ = ran(("two: {fixed: 6 s}", "two: {fixed: 6 s, needs: {jig: 1}}"))
    waits = log.of(HELD)
    wanted = {log.names["task"][task] for task in waits["task"][waits["cause"] == NO_TOOL]}
    assert wanted == {"two"}


def test_use_of_a_tool_is_the_share_of_time_in_which_jobs_have_it():
    log, p = ran(("two: {fixed: 6 s}", "two: {fixed: 6 s, needs: {jig: 1}}"))
    found = {(f.kpi, f.subject): f.value for f in figures(log, p)}
    assert found["tool_use", "jig"] == pytest.approx((100 - 4) / 100)
    assert found["tool_use", "clamp"] == 0
    waited = sum(end - start for start, end in spans(log, HELD, cause=NO_TOOL))
    assert found["tools_waited_for", ""] == pytest.approx(waited / 100)


def test_a_tool_that_nobody_needs_changes_no_row():
    without = CELL.replace("tools: {jig: {n: 1}, clamp: {n: 2}}\n", "")
    one, other = run_plan(plan(CELL)), run_plan(plan(without))
    assert spans(one, WORK) == spans(other, WORK) and len(one) == len(other)


def test_a_tool_is_not_kept_for_a_job_whose_worker_is_elsewhere():
    """One gun and one worker for two stations: one needs the gun for a task, at the other it is taken in the midst.

    Were the gun kept while the job waits for the worker, he would wait for it at the other station for ever.
    """
    log, _ = ran(
        ("one: {fixed: 4 s}", "one: {fixed: 4 s, hold: {tool: jig, from: 0.5}}"),
        ("two: {fixed: 6 s}", "two: {fixed: 6 s, needs: {jig: 1}}"),
        ("s1: {at: a, tasks: [one, two]", "s1: {at: a, tasks: [one]"),
        ("s2: {at: b, tasks: [one, two]", "s2: {at: b, tasks: [two]"),
        ("w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}", "w1: {skills: {s1: 1.0, s2: 1.0}}"),
    )
    assert spans(log, WORK)[-1][1] == 100 and len(spans(log, WORK)) > 18


def test_who_gets_a_tool_first_is_for_the_rule_that_sends_workers():
    """Both jobs may have the jig; w1 is sent to the one with the longer queue, and the other waits for the tool."""
    log, _ = ran(
        ("one: {fixed: 4 s}", "one: {fixed: 4 s, needs: {jig: 1}}"),
        ("s2: {at: b, tasks: [one, two], buffer: 1}", "s2: {at: b, tasks: [one, two], buffer: 5}"),
    )
    assert spans(log, TOOL, "s2")[0] == (0, 4)
    assert spans(log, HELD, "s1", NO_TOOL)[0] == (0, 4)


def test_work_that_is_broken_off_lets_the_tool_of_its_task_go():
    jam = "breakdowns: {jam: {every: {fixed: 3 s}, by: busy, repair: {fixed: 9 s}, job: resume}},"
    log, _ = ran(("one: {fixed: 4 s}", "one: {fixed: 4 s, needs: {jig: 1}}"), ("s1: {at: a,", f"s1: {{at: a, {jam}"))
    assert spans(log, TOOL)[:3] == [(0, 3), (3, 7), (12, 13)]


SHARED = """
opsim: 1
name: shared gun
run: {horizon: 1 h, seed: 1}
layout: {places: {here: [0 m, 0 m]}}
tools: {gun: {n: 1}}
tasks: {x: {fixed: 60 s, needs: {gun: 1}}}
defaults: {stations: {at: here, tasks: [x], buffer: 1}}
stations: {a: {}, b: {}, c: {}}
products: {a: {route: [[a, b, c]]}}
release: {kind: saturated}
workers: {u: {skills: {a: 1}}, v: {skills: {b: 1}}, w: {skills: {c: 1}}}
allocation: {rule: nearest}
"""


@pytest.mark.parametrize("rule", ["nearest", "oldest_job"])
def test_a_tool_goes_to_who_has_waited_longest_and_not_always_to_the_same_station(rule):
    p = plan(SHARED.replace("nearest", rule))
    log = run_plan(p)
    audit(log, p)
    assert [len(spans(log, WORK, station)) for station in "abc"] == [20, 20, 20]
    assert spans(log, TOOL, "b")[:2] == [(60, 120), (240, 300)]


def test_a_tool_is_not_kept_for_who_has_waited_longest_while_nobody_is_free_for_him():
    """The worker of b and c is one: while she is at c without a gun, a takes it again and again."""
    text = SHARED.replace("c: {}}", "c: {tasks: [long]}}").replace("tasks: {x", "tasks: {long: {fixed: 10 min}, x")
    text = text.replace("v: {skills: {b: 1}}, w: {skills: {c: 1}}", "v: {skills: {b: 1, c: 1}}")
    log = run_plan(p := plan(text))
    audit(log, p)
    (first, last), *_ = spans(log, WORK, "c")
    between = [start for start, _ in spans(log, TOOL, "a") if first + 60 <= start < last - 60]
    assert len(between) == 8
