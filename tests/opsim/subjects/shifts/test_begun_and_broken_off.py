"""What becomes of human effects, and of set-ups, where work is broken off as it begins, waits, or changes hands."""

import numpy as np
import pytest
from human_plans import planned
from made.shops import ran, spans

from opsim.engine.floor.run import run_plan
from opsim.history import practice
from opsim.laws.audit import CHECKS, audit
from opsim.log import NO_TOOL, WAIT, WORK

TIRES = "human: {fatigue: {model: lffrm, tires_half_in: 1 min, recovers_half_in: 1 min, slows: 0.5}}\n"
CLOCK = "human: {circadian: {amplitude: 0.3}}\n"
FORGETS = "human: {learning: {model: wright}, forgetting: {model: lfcm, forgotten_in: 1 h, least_pause: 1 s}}\n"
SAW = """
tasks: {cut: {fixed: 10 s}, turn: {fixed: 30 s}}
stations:
  saw: {at: hall, tasks: [cut], preempt: resume, setup: {otherwise: 6 s}}
  lathe: {at: hall, tasks: [turn]}
products: {low: {route: [saw]}, top: {route: [saw], priority: 2}, other: {route: [lathe]}}
workers: {eve: {skills: {saw: 1, lathe: 1}}}
"""
RUN = """
opsim: 1
name: Half an hour of the station, then his own task
run: {start: Mon 06:00, horizon: 2 h}
layout: {places: {x: [0 m, 0 m]}}
tasks: {run: {fixed: 30 min, automatic: attended}, check: {fixed: 5 min}}
stations: {a: {at: x, tasks: [run, check], buffer: 5}}
products: {p: {route: [a]}}
release: {kind: saturated}
shifts: {day: {from: '06:00', to: '14:00', at_break: RULE, breaks: {tea: {at: '06:30', lasts: 10 min}}}}
workers: {ana: {skills: {a: 1}, shift: day}}
"""
CELL = """
opsim: 1
name: One tool for two
run: {start: Mon 06:00, horizon: 60 s}
layout: {places: {a: [0 m, 0 m], b: [0 m, 0 m]}}
tools: {gun: {n: 1}}
tasks: {make: {fixed: 10 s, hold: {tool: gun, to: 0.5}}}
stations: {s1: {at: a, tasks: [make], buffer: 1}, s2: {at: b, tasks: [make], buffer: 1}}
products: {part: {route: [[s1, s2]]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}}
"""
GUN = """
opsim: 1
name: One tool between breaks
run: {start: Mon 06:00, horizon: 4 h, seed: 3}
tools: {gun: {n: 1}}
layout: {places: {x: [0 m, 0 m], y: [3 m, 0 m], z: [6 m, 0 m]}}
tasks:
  fasten: {dist: lognormal, mean: 4 min, cv: 0.3, hold: {tool: gun, from: 0.0, to: 0.9}}
  check: {dist: lognormal, mean: 1 min, cv: 0.3}
stations:
  a: {at: x, tasks: [fasten], buffer: 5}
  b: {at: y, tasks: [fasten], buffer: 5}
  c: {at: z, tasks: [check], buffer: 5}
products: {p: {share: 0.3, route: [a]}, q: {share: 0.3, route: [b]}, r: {share: 0.4, route: [c]}}
release: {kind: poisson, every: 2 min}
shifts:
  one:
    from: '06:00'
    to: '14:00'
    breaks: {x: {at: '07:00', lasts: 5 min}, y: {at: '08:00', lasts: 5 min}, z: {at: '09:00', lasts: 5 min}}
  two:
    like: one
    breaks: {x: {at: '07:03', lasts: 5 min}, y: {at: '08:03', lasts: 5 min}, z: {at: '09:10', lasts: 5 min}}
workers: {ana: {shift: one, skills: {a: 1, b: 1, c: 1}}, ben: {shift: two, skills: {a: 1, b: 1, c: 1}}}
"""


def rows_of(rows, name):
    """The rows of a task, by time."""
    return rows.where(rows["task"] == rows.names["task"].index(name))


def test_work_that_goes_on_after_a_set_up_keeps_its_own_shift(tmp_path):
    """Of ``low``, broken off at 4 s for ``top``, which comes with a set-up, as the rest of ``low`` does."""
    log = ran(tmp_path, SAW + TIRES, "0,low 4,top")
    pieces = log.where((log["kind"] == WORK) & (log["job"] == 0))
    assert pieces["progress_from"].tolist() == [0.0, 0.4]
    assert np.unique(pieces["pace_shift"]).tolist() == [0.0]


def test_a_set_up_that_was_begun_for_who_lost_the_server_is_no_part_of_his_task(tmp_path):
    """Three of six seconds of it are done when the station is oiled; nobody comes before ``top`` takes the server."""
    oil = "preempt: resume, maintenance: {oil: {every: 1 h, first: 3 s, lasts: 5 s, when: at_once}}"
    log = ran(tmp_path, SAW.replace("preempt: resume", oil).replace("6 s", "6 s, first: top"), "0,low 1,other 10,top")
    assert spans(log, "setup") == [("low", 0, 3), ("low", 43, 49)]
    assert spans(log, "work") == [("other", 3, 33), ("top", 33, 43), ("low", 49, 59)]
    assert rows_of(log.of(WORK), "cut")["progress_from"].tolist() == [0.0, 0.0]


@pytest.mark.parametrize("rule", ["resume", "hand_over", "restart"])
def test_what_is_broken_off_as_it_begins_is_as_slow_as_when_it_begins_in_truth(rule):
    """His run ends as his break begins, at 06:30: what he checks at 06:40 begins with ten minutes of rest behind it."""
    plan = planned(RUN.replace("RULE", rule), TIRES.replace("1 min", "1 h", 1).replace("1 min", "10 min"))
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    first = rows_of(log.of(WORK), "check")
    model = plan.human.fatigue
    rested = model.rested(model.passed(model.fresh(), 1.0, 0.0, 1.0, 1800.0, 0.0), 600.0)
    assert first["start_s"][0] == 2400.0
    assert first["pace_shift"][0] == pytest.approx(model.shift(model.level(rested)))


@pytest.mark.parametrize("rule", ["resume", "hand_over", "restart"])
def test_what_is_broken_off_as_it_begins_is_no_repetition(rule):
    plan = planned(RUN.replace("RULE", rule), FORGETS)
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    found = practice(log, plan)
    assert found.repetition[0] == 1.0 and log["start_s"][found.row[0]] == 2400.0


def test_who_waits_for_a_tool_is_as_slow_as_when_he_begins():
    plan = planned(CELL, CLOCK)
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    work = log.of(WORK)
    first = work.where(work["worker"] == log.names["worker"].index("w2"))
    assert first["start_s"][0] > 4.0
    assert first["pace_shift"][0] == plan.human.circadian.shift(plan.human.start_s + first["start_s"][0])


def test_who_leaves_a_tool_he_waits_for_begins_as_slow_as_he_is_then():
    """Breaks come while he waits, and he checks something before he comes back to it."""
    plan = planned(GUN, TIRES.replace("1 min", "1 h", 1).replace("1 min", "10 min"))
    for replication in range(2):
        log = run_plan(plan, replication)
        assert audit(log, plan) == CHECKS
    assert np.any((log["kind"] == WAIT) & (log["cause"] == NO_TOOL))
