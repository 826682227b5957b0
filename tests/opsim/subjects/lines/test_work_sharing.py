"""Work that two neighbours share: who does it, by hand; nothing twice and nothing left out."""

import numpy as np
import pytest
from plans import plan, ran

from opsim.engine.rules import keeps_shared
from opsim.kpi.cycle_times import visits
from opsim.log import FINISH, WORK
from opsim.plan.loads.work_times import WorkTimes, tasks_at

LINE = """
opsim: 1
name: pair
run: {horizon: 60 s, seed: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {base: {fixed: 4 s}, lid: {fixed: 6 s}, close: {fixed: 8 s}}
stations:
  front: {at: hall, tasks: [base, lid], buffer: 1, share: {tasks: [lid], with: back}}
  back: {at: hall, tasks: [close], buffer: 2}
products: {part: {route: [front, back]}}
release: {kind: saturated}
workers: {w1: {skills: {front: 1.0}}, w2: {skills: {back: 1.0}}}
"""
SPREAD = ("{fixed: 6 s}", "{dist: exponential, mean: 6 s}")
LONG = ("horizon: 60 s", "horizon: 3000 s")


def lids(log, plan):
    """(job, station, start) of each shared task, by job."""
    rows = log.of(WORK)
    lid = [task.name for task in plan.tasks].index("lid")
    here = np.flatnonzero(rows["task"] == lid)
    found = [(int(rows["job"][i]), plan.stations[rows["station"][i]].name, float(rows["start_s"][i])) for i in here]
    return sorted(found)


def test_the_half_full_buffer_rule_by_hand():
    # 0-4 base 0; back is idle: left to it, 4-10. 4-8 base 1; nobody waits at back: left. 8-12 base 2; job 1 waits, half
    # of two places: done here, 12-18. Back: job 1 18-24 lid. 18-22 base 3; job 2 waits: here, 22-28. 28-32 base 4: too.
    log, p = ran(LINE)
    assert lids(log, p)[:5] == [(0, "back", 4), (1, "back", 18), (2, "front", 12), (3, "front", 22), (4, "front", 32)]


def test_full_leaves_more_to_the_next_station():
    log, p = ran(LINE, ("with: back}", "with: back, when: full}"))
    assert lids(log, p)[:3] == [(0, "back", 4), (1, "back", 18), (2, "back", 32)]


@pytest.mark.parametrize(
    ("n_inside", "buffer", "filled", "keeps"),
    [
        (0, 0, 0.5, False),
        (1, 0, 0.5, True),
        (1, 2, 0.5, False),
        (2, 2, 0.5, True),
        (2, 3, 0.5, False),
        (3, 2, 1.0, True),
    ],
)
def test_a_free_server_or_an_empty_buffer_gets_the_work(n_inside, buffer, filled, keeps):
    assert keeps_shared(n_inside, 1, buffer, filled) is keeps


@pytest.mark.parametrize(
    "edits",
    [
        (),
        (("base: {fixed: 4 s}", "base: {fixed: 4 s, automatic: true}"),),
        (("lid: {dist", "lid: {automatic: true, dist"),),
        (("lid: {dist", "lid: {repeat: 2, dist"),),
        (("products: {part: {", "products: {part: {carried: true, "),),
        (
            (
                "tasks: [close], buffer: 2",
                "tasks: [close], buffer: 2, inspect: {false_alarms: 0.3, then: {rework: back}}",
            ),
        ),
        (("front: {at: hall, ", "front: {at: hall, servers: 2, "), ("{w1:", "{w3: {skills: {front: 1.0}}, w1:")),
        (("release: {kind", "allocation: {when_blocked: held}\nrelease: {kind"),),
    ],
    ids=["plain", "automatic", "shared automatic", "repeated", "carried", "reworked there", "two", "held"],
)
def test_every_job_gets_the_shared_work_once_a_pass(edits):
    log, p = ran(LINE, LONG, SPREAD, *edits)
    rows, done = log.of(WORK), log.of(FINISH)["job"]
    rows = rows.where(np.isin(rows["job"], done) & (rows["progress_to"] == 1))
    n = {task.name: np.bincount(rows["job"][rows["task"] == rank], minlength=1) for rank, task in enumerate(p.tasks)}
    stations = {p.stations[rank].name for rank in np.unique(rows["station"][rows["task"] == 2])}
    assert len(done) > 100
    assert stations == {"front", "back"}
    repeat = p.tasks[2].repeat
    assert np.array_equal(n["lid"], repeat * n["base"])


def test_a_job_reworked_before_the_shared_work_gets_it_once_after_all():
    log, _ = ran(
        LINE, LONG, SPREAD, ("buffer: 1, share", "buffer: 1, yield: 0.7, inspect: {then: {rework: front}}, share")
    )
    rows, done = log.of(WORK), log.of(FINISH)["job"]
    lid, base = (np.bincount(rows["job"][rows["task"] == rank], minlength=done.max() + 1)[done] for rank in (2, 0))
    assert np.all((lid >= 1) & (lid <= base)) and np.any(lid < base)


def test_two_shared_tasks_are_looked_at_one_by_one():
    edits = (("lid: {fixed: 6 s}", "lid: {fixed: 3 s}, cap: {fixed: 3 s}"), ("[base, lid]", "[base, lid, cap]"))
    log, p = ran(
        LINE, LONG, *edits, ("tasks: [lid]", "tasks: [lid, cap]"), ("close: {fixed: 8 s}", "close: {fixed: 9 s}")
    )
    rows, names = log.of(WORK), [task.name for task in p.tasks]
    at = {
        name: {int(j): int(s) for j, s, t in zip(rows["job"], rows["station"], rows["task"]) if names[t] == name}
        for name in ("lid", "cap")
    }
    both = at["lid"].keys() & at["cap"].keys()
    ways = {(p.stations[at["lid"][job]].name, p.stations[at["cap"][job]].name) for job in both}
    assert ways <= {("front", "front"), ("front", "back"), ("back", "back")} and len(ways) >= 2


def test_shares_may_follow_each_other():
    text = LINE.replace(
        "close: {fixed: 8 s}", "close: {fixed: 5 s}, tag: {dist: exponential, mean: 4 s}, pack: {fixed: 7 s}"
    )
    text = text.replace(
        "[close], buffer: 2}",
        "[close, tag], buffer: 2, share: {tasks: [tag], with: last}}\n  last: {at: hall, tasks: [pack], buffer: 2}",
    )
    text = text.replace("[front, back]", "[front, back, last]").replace("w2:", "w3: {skills: {last: 1.0}}, w2:")
    log, p = ran(text, LONG, SPREAD)
    rows, done = log.of(WORK), log.of(FINISH)["job"]
    rows = rows.where(np.isin(rows["job"], done))
    for rank in range(len(p.tasks)):
        assert np.array_equal(np.sort(rows["job"][rows["task"] == rank]), np.sort(done))
    assert len(done) > 100


def test_sharing_makes_more_than_either_of_the_two_alone():
    tasks = [
        ("fixed: 4 s", "dist: exponential, mean: 4 s"),
        ("fixed: 8 s", "dist: exponential, mean: 4 s"),
        SPREAD,
        LONG,
    ]
    share = ", share: {tasks: [lid], with: back}"
    made = {
        "shared": ran(LINE, *tasks)[0],
        "front": ran(LINE, *tasks, (share, ""))[0],
        "back": ran(LINE, *tasks, (share, ""), ("[base, lid]", "[base]"), ("[close]", "[lid, close]"))[0],
    }
    n = {name: len(log.of(FINISH)) for name, log in made.items()}
    assert n["shared"] > 1.1 * max(n["front"], n["back"])


def test_visits_hold_all_that_was_done_in_one_coming():
    log, p = ran(LINE)
    found = visits(log, p)
    front = [station.name for station in p.stations].index("front")
    work_s = found.work_s[(found.station == front) & found.whole]
    assert work_s.tolist()[:5] == [4, 4, 10, 10, 10]


def test_loads_deal_the_shared_work_out_evenly():
    p = plan(LINE)
    back, front = (WorkTimes(p).least_visit_s(rank, 0) for rank in range(2))
    assert (front, back) == pytest.approx((9, 9))  # 4 + 5 / 6 of 6, and 8 + 1 / 6 of 6
    assert sum(part for rank in range(2) for task, part in tasks_at(p, rank) if p.tasks[task].name == "lid") == 1
    p = plan(LINE.replace("close: {fixed: 8 s}", "close: {fixed: 30 s}"))
    assert [WorkTimes(p).least_visit_s(rank, 0) for rank in range(2)] == pytest.approx([30, 10])
