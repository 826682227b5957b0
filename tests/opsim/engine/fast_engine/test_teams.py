"""Teams: called, gathered, at work and broken up as in SimPy's engine."""

import pytest
from twins import twins

from opsim.log import TEAM, WAIT, WORK

CELL = """
opsim: 1
name: teams
run: {start: Mon 06:00, horizon: 900 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tools: {jig: {n: 1}}
tasks:
  lift: {dist: lognormal, mean: 10 s, cv: 0.3, team: 2, repeat: 2}
  press: {fixed: 8 s, automatic: attended, team: 2, needs: {jig: 1}}
  pack: {fixed: 4 s}
stations:
  s1: {at: a, tasks: [lift, pack], servers: 2, buffer: 3MORE}
  s2: {at: b, tasks: [pack, press], buffer: 3MORE}
products: {p: {share: 0.5, priority: 1, route: [s1, s2]}, q: {share: 0.5, lot: 2, route: [s2, s1]}}
release: {kind: renewal, every: {fixed: 30 s}}
workers:
  w1: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}
  w2: {walk: 2 m/s, skills: {s1: 0.5, s2: 1.0}}
  w3: {walk: 1 m/s, home: b, skills: {s1: 1.0, s2: 0.8}}
"""
STOPS = (
    *("breakdowns: {jam: {every: {fixed: 17 s}, by: busy, repair: {fixed: 7 s}, job: resume}}",),
    *("maintenance: {clean: {every: 40 s, lasts: 9 s, when: at_once}}", "preempt: resume"),
)


def n_waits(log):
    return len(log.where((log["kind"] == WAIT) & (log["cause"] == TEAM)))


def members(log):
    return log.where((log["kind"] == WORK) & (log["worker"] >= 0) & (log["job"] < 0))


@pytest.mark.parametrize("rule", ["oldest_job", "nearest", "best_skill"])
def test_the_same_people_go_and_wait_for_each_other(rule):
    log = twins(CELL.replace("MORE", "") + f"allocation: {{rule: {rule}}}\n")
    assert n_waits(log) > 50 and len(members(log)) > 50


@pytest.mark.parametrize("stop", STOPS)
def test_a_team_that_is_broken_up_leaves_the_same_rows(stop):
    assert len(members(twins(CELL.replace("MORE", f", {stop}")))) > 40


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "restart"])
def test_a_team_before_a_break(rule):
    breaks = "breaks: {tea: {at: 06:03, lasts: 1 min}, rest: {at: 06:08, lasts: 1 min}}"
    shift = f"shifts: {{day: {{from: 06:00, to: 14:00, at_break: {rule}, {breaks}}}}}\n"
    edits = [(f"{w}: {{walk", f"{w}: {{shift: day, walk") for w in ("w1", "w2")]
    assert len(members(twins(CELL.replace("MORE", "") + shift, *edits))) > 20
