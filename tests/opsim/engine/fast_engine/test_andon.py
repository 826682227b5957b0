"""Who is called to jobs of a line in the compiled engine: he takes over, or helps, or has to go before he is there."""

import pytest
from twins import twins

from opsim.log import BREAK, SENT_ON, WALK, WORK

LINES = """
opsim: 1
name: called
run: {start: Mon 06:00, horizon: 3000 s, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {t1: {dist: lognormal, mean: 50 s, cv: 0.4}, t2: {dist: lognormal, mean: 50 s, cv: 0.4}}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2, t2]}, r1: {at: a, tasks: [t1]}, r2: {at: b, tasks: [t2]}}
lines:
  indexed: {kind: indexed, stations: [s1, s2], takt: 70 s, unfinished: UNFINISHED, andon: ANDON}
  moving: {kind: moving, stations: [r1, r2], takt: 60 s, unfinished: UNFINISHED, andon: ANDON, length: 6 m, drift: 1 m,
           upstream: 2 m}
products: {x: {route: [s1, s2], share: 0.5}, y: {route: [r1, r2], share: 0.5}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, at_break: RULE, breaks: BREAKS}}
workers:
  w1: {walk: 1 m/s, skills: {s1: 1.0, r1: 1.0}}
  w2: {walk: 1 m/s, shift: early, skills: {s2: 1.0, r2: 1.0}}
  w3: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0, r1: 0.8, r2: 0.8}}
  joker: {walk: 0.5 m/s, home: b, shift: early, skills: {s1: 1.5, s2: 2.0, r1: 1.0, r2: 1.0}}
  other: {walk: 1 m/s, home: a, skills: {s1: 1.0, r2: 2.0}}
"""
BREAKS = ", ".join(f"b{n}: {{at: '06:{2 + 4 * n:02d}', lasts: 100 s}}" for n in range(11))


JAMS = ("s2: {at: b, tasks: [t2, t2]}", "s2: {at: b, tasks: [t2, t2], breakdowns: {jam: JAM}}")
JAM = "{every: {fixed: 90 s}, repair: {fixed: 10 s}, job: resume}"


def of_both(does, unfinished="send_on", rule="resume_any", edits=()):
    text = LINES.replace("ANDON", f"{{workers: [joker, other], at: 30 s, does: {does}}}").replace("RULE", rule)
    return twins(text.replace("UNFINISHED", unfinished).replace("BREAKS", f"{{{BREAKS}}}"), *edits)


@pytest.mark.parametrize("rule", ["finish", "hand_over", "resume", "restart"])
@pytest.mark.parametrize("does", ["help", "take_over"])
def test_who_is_called_is_there_for_both_lines_alike(does, rule):
    log = of_both(does, rule=rule)
    joker = log.names["worker"].index("joker")
    for kind, least in ((WORK, 5), (WALK, 5), (BREAK, 8)):
        assert (log.of(kind)["worker"] == joker).sum() >= least


@pytest.mark.parametrize("does", ["help", "take_over"])
def test_lines_that_stop_until_who_was_called_is_done_go_on_alike(does):
    assert of_both(does, "stop").of(SENT_ON)["job"].size == 0


def test_work_of_two_that_is_broken_off_goes_on_alone_alike():
    log = of_both("help", "stop", edits=(JAMS, ("JAM}", JAM + "}")))
    pieces = log.of(WORK).where(log.of(WORK)["progress_from"] > 0)
    assert (pieces["station"] == log.names["station"].index("s2")).sum() > 20
