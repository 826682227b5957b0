"""What judges the fast engine is right itself: which blocks a floor uses, what ties in it, where two logs differ."""

import json
import os
import signal
import time
from dataclasses import replace

import numpy as np
import pytest
from checked_floors import plan_of
from engine_evidence.compared import Seen, seen
from engine_evidence.coverage import PLAN_WORDS, VOCABULARY, blocks_of, shown_by
from engine_evidence.equality import ENOUGH_FLOORS, compared, main, shortfalls
from engine_evidence.floors import floor_text, replication_of
from engine_evidence.more_times import LAWS
from engine_evidence.rows import first_difference
from engine_evidence.sample import SAMPLE
from engine_evidence.ties import contested_ties

from opsim.engine.floor.run import run_plan
from opsim.log import EventLog
from opsim.scenario.schema import DISTRIBUTIONS

SHOP = {
    "opsim": 1,
    "name": "shop",
    "run": {"horizon": "600 s", "seed": 3},
    "layout": {"places": {"hall": ["0 m", "0 m"]}},
    "tasks": {"turn": {"fixed": "10 s", "automatic": True}},
    "stations": {"lathe": {"at": "hall", "tasks": ["turn"]}},
    "products": {"bolt": {"route": ["lathe"]}},
    "release": {"kind": "renewal", "every": {"fixed": "60 s"}},
    "workers": {"ana": {"skills": {"lathe": 1.0}}, "ben": {"skills": {"lathe": 1.0}}},
}
HAND = {"tasks": {"turn": {"fixed": "7 s"}}, "release": {"kind": "renewal", "every": {"fixed": "30 s"}}}


def ties(more):
    plan = plan_of(json.dumps(SHOP | more))
    return contested_ties(plan, run_plan(plan))


def test_random_floors_draw_times_of_every_distribution():
    assert set(LAWS) == set(DISTRIBUTIONS)


def test_nothing_ties_where_one_job_comes_at_a_time():
    assert ties({}) == 0


def test_of_three_jobs_at_once_two_wait_alike_until_the_first_one_goes():
    """At 60, 120, ..., 540 s three come; the second begins 10 s later, while the third waits since the same instant."""
    assert ties({"release": {"kind": "renewal", "every": {"fixed": "60 s"}, "at_once": 3}}) == 9


def test_of_two_workers_who_are_the_same_one_is_sent_to_each_job():
    """At 30, 60, ..., 570 s a job calls, and both stand there free."""
    assert ties(HAND) == 19


@pytest.mark.parametrize(
    "ben",
    [
        {"skills": {"lathe": 0.9}},
        {"skills": {"lathe": 1.0}, "walk": "2 m/s"},
        {"skills": {"lathe": 1.0}, "floater": True},
        {"skills": {}},
    ],
)
def test_workers_who_differ_do_not_tie(ben):
    assert ties(HAND | {"workers": {"ana": {"skills": {"lathe": 1.0}}, "ben": ben}}) == 0


def test_a_job_that_comes_just_as_one_is_done_is_a_tie():
    """Every 10 s one comes, from 10 s on; from 20 s on the one before it is done at that instant: 20, 30, ..., 590."""
    assert ties({"release": {"kind": "renewal", "every": {"fixed": "10 s"}}}) == 58


PLANTED = {
    "cards": {"conwip": {"n": 3}},
    "tasks": {"turn": {"fixed": "10 s", "automatic": "attended"}},
    "release": {"kind": "poisson", "every": "60 s"},
    "allocation": {"rule": "nearest", "idle": "home"},
    "human": {"learning": {"model": "wright"}},
}
WORDS = {
    "cards": {"cards: whole way"},
    "tasks": {"task: attended"},
    "release": {"source: poisson"},
    "allocation": {"allocation: nearest", "idle: home"},
    "human": {"human: learning, wright", "human: acts on posture"},
}


@pytest.mark.parametrize("section", PLANTED)
def test_a_floor_without_a_block_is_seen_to_lack_it(section):
    whole = SHOP | HAND | PLANTED
    without = {key: value for key, value in whole.items() if key != section} | (
        {section: (SHOP | HAND)[section]} if section in SHOP else {}
    )
    assert WORDS[section] <= blocks_of(plan_of(json.dumps(whole)))
    assert not WORDS[section] & blocks_of(plan_of(json.dumps(without)))


def test_a_station_to_which_nothing_comes_counts_for_nothing():
    idle = {"at": "hall", "tasks": ["turn"], "needs": {"jig": 1}, "buffer_after": 2, "preempt": "resume"}
    more = {"stations": {**SHOP["stations"], "idle": idle}, "tools": {"jig": {"n": 1}}}
    assert blocks_of(plan_of(json.dumps(SHOP | more))) == blocks_of(plan_of(json.dumps(SHOP)))


def test_the_sample_shows_the_whole_vocabulary():
    found = set()
    for number in SAMPLE:
        plan = plan_of(floor_text(number))
        found |= blocks_of(plan) | shown_by(plan, run_plan(plan, replication_of(number)))
    assert sorted(set(VOCABULARY) - found) == [], "`make made-floors` draws floors that show new words"
    assert found <= set(VOCABULARY)


def test_no_word_stands_in_the_vocabulary_twice():
    assert len(set(VOCABULARY)) == len(VOCABULARY)


def test_what_the_floors_fall_short_of_is_told():
    one = seen("shop", plan_of(json.dumps(SHOP)), 0, simpy_only=True)
    told = shortfalls([one] * ENOUGH_FLOORS)
    assert {line.split(": in ")[0] for line in told if ": in " in line} == set(VOCABULARY) - one.words
    assert {line for line in told if ": in " not in line} == {"shop: 9 finished jobs", "shop: nothing ties"}
    assert one.words & set(PLAN_WORDS) == blocks_of(plan_of(json.dumps(SHOP)))


def exit_code(monkeypatch, *words):
    monkeypatch.setattr("sys.argv", ["equality", *words])
    return main()


def test_where_nothing_is_compared_nothing_is_shown(monkeypatch):
    assert exit_code(monkeypatch, "--from", "5", "--to", "3") == 1
    assert exit_code(monkeypatch, "--simpy-only", "--from", "5", "--to", "6") == 0


@pytest.mark.parametrize("column", ["end_s", "k", "worker", "pace_shift"])
def test_one_bit_in_one_row_is_a_difference(column):
    log = run_plan(plan_of(json.dumps(SHOP | HAND)))
    at = int(np.flatnonzero(log["k"] >= 0)[5])
    changed = log[column].copy()
    changed[at] = np.nextafter(changed[at], np.inf) if changed.dtype.kind == "f" else changed[at] - 1
    other = EventLog(log.replication, log.horizon_s, log.columns | {column: changed}, log.names)
    assert first_difference(log, log) == ""
    assert first_difference(log, other).startswith(f"row {at} of {len(log)} and {len(log)}: {column}\n")


def other_log(log, column, change):
    """A log with another column, to the last bit."""
    return EventLog(log.replication, log.horizon_s, log.columns | {column: change(log[column].copy())}, log.names)


def minus_zero(times_s):
    times_s[np.flatnonzero(times_s == 0.0)[0]] = -0.0
    return times_s


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda log: other_log(log, "start_s", minus_zero), "start_s"),
        (lambda log: other_log(log, "job", lambda jobs: jobs.astype(np.int32)), "column job holds int64 and int32"),
        (lambda log: replace(log, horizon_s=601.0), "horizon 600.0 s and 601.0 s"),
        (lambda log: replace(log, replication=1), "replication 0 and 1"),
        (lambda log: replace(log, names=log.names | {"worker": ("zoe",)}), "the names of column worker"),
    ],
)
def test_what_equals_in_numbers_alone_is_a_difference(make, said):
    log = run_plan(plan_of(json.dumps(SHOP | HAND)))
    assert said in first_difference(log, make(log))


def test_a_row_that_is_missing_is_a_difference():
    log = run_plan(plan_of(json.dumps(SHOP)))
    assert "has no such row" in first_difference(log, log.where(np.arange(len(log)) < len(log) - 1))


def fatal(number):
    """What an engine may do that writes where it may not."""
    if number == 5:
        os._exit(1)
    return Seen(f"floor {number}", frozenset())


def test_a_floor_whose_process_dies_is_told_of_and_the_others_go_on(capsys):
    found = compared(range(9), fatal)
    assert [one.trouble for one in found] == [*5 * [""], "its process died", *3 * [""]]
    assert "its process died" in capsys.readouterr().out


def endless(number):
    """What compiled code may do: nothing in Python comes to its turn any more."""
    if number == 1:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM, signal.SIGINT})
        time.sleep(60)
    return Seen(f"floor {number}", frozenset())


def test_a_floor_that_does_not_end_is_told_of_and_the_others_go_on():
    assert [one.trouble for one in compared(range(3), endless, most_s=2.0)] == ["", "no end", ""]
