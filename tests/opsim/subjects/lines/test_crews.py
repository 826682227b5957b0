"""Bucket brigades and rabbit chases, by hand arithmetic."""

import numpy as np
import pytest
from plans import plan, ran

from opsim.engine.draws import Draws
from opsim.log import FINISH, KINDS, WORK
from opsim.subjects.lines.figures import hand_overs

BENCH = """
opsim: 1
name: bench
run: {horizon: 1000 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {sew: {fixed: 12 s}}
stations: {bench: {at: hall, tasks: [sew], servers: 3, buffer: 0}}
products: {bag: {route: [bench]}}
release: {kind: saturated}
workers: {slow: {skills: {bench: 1}}, fast: {skills: {bench: 2}}}
crews: {line: {kind: bucket_brigade, stations: [bench], workers: [slow, fast]}}
"""
ROW = """
opsim: 1
name: row
run: {horizon: 100 s}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [6 m, 0 m]}}
tasks: {t: {fixed: 10 s}, u: {fixed: 10 s}}
stations:
  a: {at: p, tasks: [t], buffer: 0}
  b: {at: q, tasks: [u], buffer: 0}
  c: {at: r, tasks: [u], buffer: 0}
products: {bag: {route: [a, b, c]}}
release: {kind: saturated}
workers:
  w1: {walk: 1 m/s, skills: {a: 1, b: 1, c: 1}}
  w2: {walk: 1 m/s, skills: {a: 1, b: 1, c: 1}}
crews: {line: {kind: bucket_brigade, stations: [a, b, c], workers: [w1, w2]}}
"""
TWO = (("route: [a, b, c]", "route: [a, b]"), ("stations: [a, b, c]", "stations: [a, b]"))
CARRIED = ("{route: [a, b, c]}", "{route: [a, b, c], carried: true}")
RABBITS = ("kind: bucket_brigade", "kind: rabbit_chase")


def day(log, worker, until_s=float("inf")):
    """What a worker does until some time, such as "0-10 work a 1": at which station, or to which place, job and all.

    A wait has its cause.
    """
    rows = [i for i in range(len(log)) if log["worker"][i] == log.names["worker"].index(worker)]
    found = []
    for i in sorted(rows, key=lambda i: log["start_s"][i]):
        if log["end_s"][i] <= until_s:
            kind = KINDS[log["kind"][i]]
            names = {"work": ("station", "job"), "walk": ("place_to",), "wait": ("cause",), "break": ()}[kind]
            said = [
                str(log[name][i]) if name == "job" else log.names[name][log[name][i]] for name in names
            ]  # a job has no name
            found.append(" ".join([f"{log['start_s'][i]:g}-{log['end_s'][i]:g}", kind, *said]))
    return found


def test_who_comes_back_takes_over_in_the_middle_of_a_task():
    """fast does 12 s of work in 6 s: he takes over at 1/2, 1/4, 3/8, 5/16 and so on, to 1/3."""
    log, made = ran(BENCH)
    assert day(log, "slow", 17.25) == [
        *("0-6 work bench 1", "6-9 work bench 2", "9-13.5 work bench 3", "13.5-17.25 work bench 4")
    ]
    assert day(log, "fast", 17.25) == [
        *("0-6 work bench 0", "6-9 work bench 1", "9-13.5 work bench 2", "13.5-17.25 work bench 3")
    ]
    found = hand_overs(log, made, made.crews[0])
    assert found.position[:4].tolist() == [1 / 2, 1 / 4, 3 / 8, 5 / 16]
    assert found.position[-1] == pytest.approx(1 / 3, abs=1e-6)


def test_what_is_left_takes_a_time_of_his_own():
    text = BENCH.replace("sew: {fixed: 12 s}", "sew: {dist: lognormal, mean: 12 s, cv: 0.5, repeat: 3}")
    log, made = ran(text)
    draws = Draws(made, 0)
    pieces = [i for i in range(len(log)) if log["kind"][i] == WORK and log["progress_from"][i] > 0]
    assert len(pieces) > 50
    for i in pieces:
        worker = log["worker"][i]
        whole_s = draws.duration_s(0, worker, log["k"][i]) / made.workers[worker].rating[0]
        share = log["progress_to"][i] - log["progress_from"][i]
        assert log.duration_s[i] == pytest.approx(whole_s * share, abs=1e-5)


def test_who_catches_up_waits_behind():
    """All at one place; b takes 20 s: w1 comes to its end at a after 10 s, and waits until w2 is through."""
    log, _ = ran(ROW, *TWO, ("[3 m, 0 m]", "[0 m, 0 m]"), ("u: {fixed: 10 s}", "u: {fixed: 20 s}"))
    assert day(log, "w1", 50) == [
        *("0-10 wait behind", "10-20 work a 1", "20-30 wait behind", "30-40 work a 2", "40-50 wait behind")
    ]
    assert day(log, "w2", 50) == ["0-10 work a 0", "10-30 work b 0", "30-50 work b 1"]


def test_people_walk_back_station_by_station_and_meet_the_job_there():
    """At 46 s w2 goes back from c; at 49 s he is at b, as the job comes there that w1 has done at a."""
    log, _ = ran(ROW)
    assert day(log, "w2", 72) == [
        *("0-10 work a 0", "10-13 walk q", "13-23 work b 0", "23-26 walk r", "26-36 work c 0", "36-46 work c 1"),
        *("46-49 walk q", "49-59 work b 2", "59-62 walk r", "62-72 work c 2"),
    ]


def test_who_meets_somebody_that_carries_a_job_waits_for_it():
    """At 36 s w1 sets out from b with the job that w2 waits for at c; then w2 is at a as w1 is done there, at 55 s."""
    log, _ = ran(ROW, CARRIED)
    assert day(log, "w1", 55)[-4:] == ["26-36 work b 1", "36-39 walk r", "39-45 walk p", "45-55 work a 2"]
    assert day(log, "w2", 71)[4:] == [
        *("26-36 work c 0", "36-39 wait behind", "39-49 work c 1", "49-52 walk q", "52-55 walk p", "55-58 walk q"),
        *("58-68 work b 2", "68-71 walk r"),
    ]


def test_a_job_that_is_done_waits_for_who_is_on_his_last_way_to_it():
    """w2 leaves b at 39 s and is at a at 42 s, where the job is done at 40 s."""
    log, _ = ran(ROW, *TWO, ("t: {fixed: 10 s}", "t: {fixed: 20 s}"), ("u: {fixed: 10 s}", "u: {fixed: 16 s}"))
    assert day(log, "w1", 64) == [
        *("0-20 wait behind", "20-40 work a 1", "40-42 wait behind", "42-62 work a 2", "62-64 wait behind")
    ]
    assert day(log, "w2", 64) == [
        *("0-20 work a 0", "20-23 walk q", "23-39 work b 0", "39-42 walk p", "42-45 walk q", "45-61 work b 1"),
        "61-64 walk p",
    ]


def test_a_task_that_is_to_be_finished_is_not_taken_over_in_the_middle():
    """Both do b in 6 s and a in 20 s; w2 is back at a at 32 s, and waits until w1 is done there at 40 s."""
    edits = ("t: {fixed: 10 s}", "t: {fixed: 20 s, interruption: finish}"), ("u: {fixed: 10 s}", "u: {fixed: 6 s}")
    log, made = ran(ROW, *TWO, *edits)
    assert day(log, "w2", 49) == [
        *("0-20 work a 0", "20-23 walk q", "23-29 work b 0", "29-32 walk p", "32-40 wait behind", "40-43 walk q"),
        "43-49 work b 1",
    ]
    assert set(hand_overs(log, made, made.crews[0]).position.tolist()) == {20 / 26}


def test_without_a_rule_of_its_own_it_is():
    """At 32 s there is 8 s of a left."""
    log, made = ran(ROW, *TWO, ("t: {fixed: 10 s}", "t: {fixed: 20 s}"), ("u: {fixed: 10 s}", "u: {fixed: 6 s}"))
    assert day(log, "w2", 49)[-4:] == ["29-32 walk p", "32-40 work a 1", "40-43 walk q", "43-49 work b 1"]
    assert set(hand_overs(log, made, made.crews[0]).position.round(9).tolist()) == {round(12 / 26, 9)}


def test_a_tool_goes_from_hand_to_hand_whoever_waits_for_it():
    """Three sewers share two needles: what was begun never waits for one."""
    log, _ = ran(
        BENCH, ("sew: {fixed: 12 s}", "sew: {dist: lognormal, mean: 12 s, cv: 0.3, needs: {needle: 1}}"),
        ("workers: {", "tools: {needle: {n: 2}}\nworkers: {mid: {skills: {bench: 1.5}}, "), ("[slow,", "[slow, mid,"),
    )  # fmt: skip
    work = log.of(WORK)
    begun = work.where((work["progress_to"] < 1) & (work["end_s"] < log.horizon_s))
    assert len(begun) > 50
    for job, end_s in zip(begun["job"], begun["end_s"]):
        assert np.any((work["job"] == job) & (work["start_s"] == end_s))


def test_who_has_a_break_is_passed_over_and_comes_in_again_at_his_place():
    """mid leaves his bag at 0.4 of it; fast takes it up, then those of slow, until mid is back at 840 s."""
    shift = "shifts: {early: {from: 06:00, to: 14:00, breaks: {rest: {at: 06:04, lasts: 10 min}}}}\n"
    log, _ = ran(
        BENCH + shift,
        ("sew: {fixed: 12 s}", "sew: {fixed: 600 s}"),
        ("slow: {skills: {bench: 1}}", "slow: {skills: {bench: 1}}, mid: {shift: early, skills: {bench: 1}}"),
        ("[slow, fast]", "[slow, mid, fast]"),
    )
    assert day(log, "fast", 975) == [
        *("0-300 work bench 0", "300-480 work bench 1", "480-540 work bench 2", "540-810 work bench 3"),
        "810-975 work bench 4",
    ]
    assert day(log, "mid", 975) == ["0-240 work bench 1", "240-840 break", "840-975 work bench 5"]
    assert day(log, "slow", 975) == [
        *("0-480 work bench 2", "480-540 work bench 3", "540-810 work bench 4", "810-840 work bench 5"),
        "840-975 work bench 6",
    ]


@pytest.mark.parametrize("kind", ["bucket_brigade", "rabbit_chase"])
def test_who_sets_out_for_his_break_leaves_his_job_to_the_others_from_that_instant(kind):
    """w2 goes to the yard, half a minute away, at 4 s."""
    early = "early: {from: 06:00, to: 07:00, breaks: {tea: {at: 06:00:04, lasts: 80 s, place: yard}}}"
    log, _ = ran(
        ROW, ("horizon: 100 s", "start: Mon 06:00, horizon: 100 s"), ("bucket_brigade", kind),
        ("w2: {walk: 1 m/s, ", "w2: {walk: 1 m/s, shift: early, "), ("crews:", f"shifts: {{{early}}}\ncrews:"),
        ("r: [6 m, 0 m]", "r: [6 m, 0 m], yard: [0 m, 30 m]"),
        ("[w1, w2]", "[w1, w2]" if kind == "bucket_brigade" else "[w2, w1]"),
    )  # fmt: skip
    assert day(log, "w2", 84) == ["0-4 work a 0", "4-34 walk yard", "34-84 break"]
    assert day(log, "w1", 13)[:3] == ["0-4 wait behind", "4-10 work a 0", "10-13 walk q"]


def test_rabbits_go_straight_back_to_the_start():
    log, _ = ran(ROW, RABBITS)
    assert day(log, "w1", 52) == [
        *("0-10 work a 0", "10-13 walk q", "13-23 work b 0", "23-26 walk r", "26-36 work c 0", "36-42 walk p"),
        "42-52 work a 2",
    ]
    assert day(log, "w2", 59)[:3] == ["0-10 wait behind", "10-20 work a 1", "20-23 wait behind"]


def test_the_slowest_rabbit_sets_the_pace_of_all():
    """He takes 3 x 20 s, and 3 + 3 + 6 s of walking: two bags in 72 s, though the other could make one in 42 s."""
    log, _ = ran(
        ROW, RABBITS, ("horizon: 100 s", "horizon: 7400 s"),
        ("w2: {walk: 1 m/s, skills: {a: 1, b: 1, c: 1}}", "w2: {walk: 1 m/s, skills: {a: 0.5, b: 0.5, c: 0.5}}"),
    )  # fmt: skip
    finish_s = log["end_s"][log["kind"] == FINISH]
    assert finish_s[-1] - finish_s[-1 - 2 * 50] == 50 * 72


def test_jobs_that_skip_a_station_stay_behind():
    """a takes 10 s and b 40 s: the second bag needs no b, and waits at a until the first has left b for c."""
    log, _ = ran(
        ROW, ("[3 m, 0 m], r: [6 m, 0 m]", "[0 m, 0 m], r: [0 m, 0 m]"), ("u: {fixed: 10 s}", "u: {fixed: 40 s}"),
        ("c: {at: r, tasks: [u], buffer: 0}", "c: {at: r, tasks: [t], servers: 2, buffer: 0}"),
        ("{bag: {route: [a, b, c]}}", "{bag: {route: [a, b, c], share: 0.5}, purse: {route: [a, c], share: 0.5}}"),
        ("{kind: saturated}", "{kind: saturated, sequence: [bag, purse]}"),
    )  # fmt: skip
    assert day(log, "w1", 60)[:3] == ["0-10 wait behind", "10-20 work a 1", "20-50 wait behind"]
    assert "50-60 work c 1" in day(log, "w1", 60)
    assert log["job"][log["kind"] == FINISH].tolist()[:2] == [0, 1]


def test_only_members_work_at_the_stations_of_a_crew_and_they_work_nowhere_else():
    text = ROW.replace("a: 1, b: 1, c: 1}}\n  w2", "a: 1, b: 1, c: 1, x: 1}}\n  w2")
    log, _ = ran(
        text, ("  c: {at: r", "  x: {at: r, tasks: [u]}\n  c: {at: r"), ("[a, b, c]}}", "[a, b, c, x]}}"),
        ("crews:", "  eve: {skills: {a: 1, x: 1}}\ncrews:"),
    )  # fmt: skip
    rows = log.of(WORK)
    at = {(log.names["worker"][w], log.names["station"][s]) for w, s in zip(rows["worker"], rows["station"])}
    members = {(worker, station) for worker in ("w1", "w2") for station in "abc"}
    assert ("eve", "x") in at and at - {("eve", "x")} <= members


@pytest.mark.parametrize("kind", ["bucket_brigade", "rabbit_chase"])
def test_a_stopped_station_stops_its_member_and_whoever_comes_goes_on_there(kind):
    jam = "breakdowns: {jam: {every: {fixed: 25 s}, repair: {fixed: 7 s}}}"
    log, _ = ran(
        ROW, ("kind: bucket_brigade", f"kind: {kind}"), ("horizon: 100 s", "horizon: 2000 s"),
        ("b: {at: q, tasks: [u], buffer: 0}", f"b: {{at: q, tasks: [u], buffer: 0, {jam}}}"),
    )  # fmt: skip
    assert (log["kind"] == FINISH).sum() > 60
    assert ((log["kind"] == WORK) & (log["progress_from"] > 0)).sum() > 5


def test_the_order_of_declaration_decides_nothing():
    workers = [line for line in ROW.splitlines() if line.startswith("  w")]
    turned = ROW.replace("\n".join(workers), "\n".join(reversed(workers)))
    assert turned != ROW
    logs = [ran(text)[0] for text in (ROW, turned)]
    assert all((logs[0][name] == logs[1][name]).all() for name in ("start_s", "end_s", "worker", "station", "job"))


def test_crews_are_planned_by_rank_in_the_order_of_their_lists():
    (crew,) = plan(ROW.replace("workers: [w1, w2]", "workers: [w2, w1]")).crews
    assert (crew.name, crew.kind, crew.stations, crew.workers) == ("line", "bucket_brigade", (0, 1, 2), (1, 0))
