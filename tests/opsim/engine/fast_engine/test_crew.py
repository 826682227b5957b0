"""Crews in the compiled engine: each floor has something in it that goes from hand to hand, or waits behind another."""

import pytest
from twins import twins

from opsim.log import BEHIND, BREAK, FINISH, TRANSPORT, WAIT, WORK

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
