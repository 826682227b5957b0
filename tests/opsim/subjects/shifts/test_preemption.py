"""A job of higher priority takes the server of a lower one: by hand arithmetic."""

import numpy as np
import pytest
from made.shops import begun, ran, spans

ONE = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], preempt: HOW}}
products: {low: {route: [saw]}, mid: {route: [saw], priority: 1}, top: {route: [saw], priority: 2}}
"""
BY_HAND = ONE.replace(", automatic: true", "") + "workers: {eve: {skills: {saw: 1}}}\n"


def test_what_was_begun_goes_on_where_it_was(tmp_path):
    log = ran(tmp_path, ONE.replace("HOW", "resume"), "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 20)]
    assert spans(log, "queue", cause="preempted") == [("low", 4, 14)]
    pieces = log.where((log["kind"] == 0) & (log["job"] == 0))
    assert pieces["progress_from"].tolist() == [0, 0.4] and pieces["progress_to"].tolist() == [0.4, 1.0]
    assert len(set(pieces["performance_id"].tolist())) == 1 and set(pieces["k"].tolist()) == {0}


def test_or_begins_anew(tmp_path):
    log = ran(tmp_path, ONE.replace("HOW", "restart"), "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 24)]
    pieces = log.where((log["kind"] == 0) & (log["job"] == 0))
    assert pieces["progress_to"].tolist() == [0.4, 1.0] and pieces["k"].tolist() == [0, 2]


def test_equal_priorities_do_not_interrupt_each_other(tmp_path):
    log = ran(tmp_path, ONE.replace("HOW", "resume"), "0,mid 4,mid 5,low")
    assert spans(log, "work") == [("mid", 0, 10), ("mid", 10, 20), ("low", 20, 30)]


def test_interruptions_nest(tmp_path):
    log = ran(tmp_path, ONE.replace("HOW", "resume"), "0,low 2,mid 5,top 6,low")
    assert spans(log, "work") == [
        *(("low", 0, 2), ("mid", 2, 5), ("top", 5, 15), ("mid", 15, 22), ("low", 22, 30), ("low", 30, 40))
    ]


@pytest.mark.parametrize("how", ["resume", "restart"])
def test_the_worker_turns_to_the_job_that_came(tmp_path, how):
    log = ran(tmp_path, BY_HAND.replace("HOW", how), "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 20 if how == "resume" else 24)]


def test_another_worker_takes_his_own_time_for_the_same_share(tmp_path):
    """Ben, at half the pace, is called away from low at 0.2 of it; Ana comes free at 14 s and does the other 0.8."""
    text = """
tasks: {cut: {fixed: 10 s}, turn: {fixed: 14 s}}
stations: {saw: {at: hall, tasks: [cut], preempt: resume}, lathe: {at: hall, tasks: [turn]}}
products: {low: {route: [saw]}, other: {route: [lathe]}, top: {route: [saw], priority: 2}}
workers: {ana: {skills: {saw: 1, lathe: 1}}, ben: {skills: {saw: 0.5}}}
"""
    log = ran(tmp_path, text, "0,other 0,low 4,top")
    assert spans(log, "work", "saw") == [("low", 0, 4), ("top", 4, 24), ("low", 24, 32)]


def test_a_worker_on_his_way_serves_who_took_the_server(tmp_path):
    head = """
opsim: 1
name: far
run: {horizon: 200 s}
layout: {places: {hall: [0 m, 0 m], gate: [10 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""
    text = BY_HAND.replace("HOW", "resume").replace("eve: {", "eve: {home: gate, walk: 1 m/s, ")
    log = ran(tmp_path, text, "0,low 4,top", head)
    assert spans(log, "work") == [("top", 10, 20), ("low", 20, 30)]
    assert [(float(a), float(b)) for a, b in zip(log["start_s"], log["end_s"]) if b == 10 and a == 0] == [(0, 10)]


def test_of_two_on_servers_the_lower_then_the_later_gives_way(tmp_path):
    text = ONE.replace("HOW", "resume").replace("tasks: [cut]", "tasks: [cut], servers: 2")
    log = ran(tmp_path, text, "0,mid 1,low 2,top")
    assert spans(log, "work") == [("mid", 0, 10), ("low", 1, 2), ("top", 2, 12), ("low", 10, 19)]
    log = ran(tmp_path, text, "0,low 1,low 2,top")
    assert spans(log, "queue", cause="preempted") == [("low", 2, 10)]


def test_a_server_that_changed_hands_is_set_up_again(tmp_path):
    text = ONE.replace("HOW", "resume, setup: {otherwise: 3 s, attended: false}")
    log = ran(tmp_path, text, "0,low 4,top")
    assert spans(log, "setup") == [("top", 4, 7), ("low", 17, 20)]
    assert spans(log, "work") == [("low", 0, 4), ("top", 7, 17), ("low", 20, 26)]
    pieces = log.where((log["kind"] == 0) & (log["job"] == 0))
    assert pieces["progress_to"].tolist() == [0.4, 1.0] and np.unique(pieces["performance_id"]).size == 1


def test_a_setup_is_finished_before_the_job_gives_way(tmp_path):
    text = ONE.replace("HOW", "resume, setup: {otherwise: 6 s, attended: false, first: mid}")
    log = ran(tmp_path, text, "0,low 4,top")
    assert spans(log, "setup") == [("low", 0, 6), ("top", 6, 12), ("low", 22, 28)]
    assert begun(log)[:3] == "top"


def test_a_broken_station_pre_empts_nobody(tmp_path):
    jam = "resume, breakdowns: {jam: {every: {fixed: 3 s}, repair: {fixed: 20 s}}}"
    log = ran(tmp_path, ONE.replace("HOW", jam), "0,low 4,top")
    assert spans(log, "work")[:2] == [("low", 0, 3), ("top", 23, 26)]


def test_the_only_fixture_goes_with_the_server(tmp_path):
    text = ONE.replace("HOW", "resume, needs: {vice: 1}") + "tools: {vice: {n: 1}}\n"
    log = ran(tmp_path, text, "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 20)]


def test_parts_are_taken_once(tmp_path):
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], preempt: resume}, cast: {at: hall, tasks: [cut]}}
stores: {bin: {at: hall, initial: 2}}
products:
  bolt: {route: [cast, bin]}
  low: {route: [saw], parts: {saw: {bolt: 1}}}
  top: {route: [saw], priority: 2, parts: {saw: {bolt: 1}}}
"""
    log = ran(tmp_path, text, "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 20)]
    assert len(spans(log, "join")) == 2


def test_a_held_tool_is_given_up_with_the_server(tmp_path):
    text = ONE.replace("HOW", "resume").replace("automatic: true", "automatic: true, needs: {gun: 1}")
    log = ran(tmp_path, text + "tools: {gun: {n: 1}}\n", "0,low 4,top")
    assert spans(log, "work") == [("low", 0, 4), ("top", 4, 14), ("low", 14, 20)]


def test_who_loses_the_server_loses_the_place_downstream_too(tmp_path):
    """Else who took the server waits for the place of a job that waits for the server."""
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}, pack: {fixed: 30 s, automatic: true}}
stations:
  saw: {at: hall, tasks: [cut], preempt: resume, blocking: before}
  packer: {at: hall, tasks: [pack], buffer: 0}
products: {low: {route: [saw, packer]}, top: {route: [saw, packer], priority: 2}}
CARDS
"""
    for cards in ("", "cards: {loop: {n: 1, from: packer}}"):
        log = ran(tmp_path, text.replace("CARDS", cards), "0,low 4,top")
        assert spans(log, "work", "saw") == [("low", 0, 4), ("top", 4, 14), ("low", 44, 50)]
        assert spans(log, "held", cause="place") == [("low", 14, 44)]


def test_a_team_that_was_called_before_does_not_come_to_the_set_up(tmp_path):
    text = """
tasks: {lift: {fixed: 10 s, team: 2}}
stations: {saw: {at: hall, tasks: [lift], servers: 2, preempt: resume, setup: {otherwise: 3 s}}}
products: {low: {route: [saw]}, mid: {route: [saw], priority: 1}, top: {route: [saw], priority: 2}}
workers: {ana: {skills: {saw: 1}}, ben: {skills: {saw: 1}}}
"""
    log = ran(tmp_path, text, "0,mid 1,low 2,top")
    assert spans(log, "setup") == [("low", 10, 13), ("top", 10, 13)]
    jobs = log.where(log["job"] >= 0)
    assert spans(jobs, "work") == [("mid", 0, 10), ("top", 13, 23), ("low", 23, 33)]
