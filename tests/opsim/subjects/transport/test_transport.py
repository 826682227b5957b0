import numpy as np
import pytest
from plans import line, plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.log import FINISH, TRANSPORT, WAIT, WALK, WORK

CARRIED = """
opsim: 1
name: carried
run: {horizon: 60 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {t: {fixed: 2 s}, slow: {fixed: 30 s}}
stations: {sa: {at: a, tasks: [t]}, sb: {at: b, tasks: [t], buffer: 0}}
products: {x: {route: [sa, sb], carried: true}}
release: {kind: renewal, every: {fixed: 20 s}}
workers: {w: {walk: 2 m/s, home: a, skills: {sa: 1.0, sb: 1.0}}}
"""


def test_the_worker_carries_the_job_and_goes_on_where_he_put_it_down():
    p = plan(CARRIED)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    carried = log.of(TRANSPORT)
    assert (carried["start_s"].tolist(), carried["end_s"].tolist()) == ([22.0, 45.0], [25.0, 48.0])
    walks = log.of(WALK)
    # with the first job 22-25 s; back for the second, which calls at 40 s; with it 45-48 s
    assert walks["start_s"].tolist() == [22.0, 40.0, 45.0]
    assert walks["job"].tolist() == [0, 1, 1]
    assert log.of(FINISH)["end_s"].tolist() == [27.0, 50.0]


def test_the_carrier_waits_with_the_job_while_the_next_station_is_full():
    p = plan(
        CARRIED.replace("sb: {at: b, tasks: [t]", "sb: {at: b, tasks: [slow]")
        .replace("sb: 1.0}}}", "sb: 1.0}}, v: {home: b, skills: {sb: 1.0}}}")
        .replace("w: {walk: 2 m/s, home: a, skills: {sa: 1.0, sb: 1.0}", "w: {walk: 2 m/s, home: a, skills: {sa: 1.0}")
    )
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    waits = log.of(WAIT)
    held = waits.where((waits["job"] == 1) & (waits["worker"] == 1))
    # v works on the first job 25-55 s; w, back at 43 s, is done with the second at 45 s and waits with it till 55 s
    assert held["end_s"].tolist() == [55.0]
    assert log.of(TRANSPORT)["start_s"].tolist() == [22.0, 55.0]


def test_carrying_without_a_distance_is_passing_on_at_once():
    text = line(3, 1, horizon="3000 s", warm_up="0 s")
    near = text.replace("[2 m, 0 m]", "[1 m, 0 m]").replace("[3 m, 0 m]", "[1 m, 0 m]")
    passed, carried = (run_plan(plan(t)) for t in (near, near.replace("s3]}", "s3], carried: true}")))
    assert len(passed.of(FINISH)) > 1000
    assert np.array_equal(passed.of(FINISH)["end_s"], carried.of(FINISH)["end_s"])
    assert len(carried.of(TRANSPORT)) == 0


@pytest.mark.parametrize("horizon", ["23.5 s", "46 s"])
def test_a_job_on_its_way_at_the_horizon_is_inside(horizon):
    p = plan(CARRIED.replace("horizon: 60 s", f"horizon: {horizon}"))
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert len(log.of(TRANSPORT)) >= 1 and len(log.of(WORK)) >= 1


ROUND = CARRIED.replace("skills: {sa: 1.0, sb: 1.0}", "patrol: [sa, sb], skills: {sa: 1.0, sb: 1.0}")


def test_who_carries_on_his_round_serves_where_he_put_the_job_down():
    p = plan(ROUND + "allocation: {idle: patrol}\n")
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    served = log.of(WORK).where(log.of(WORK)["worker"] == 0)
    walks = log.of(WALK)
    assert len(log.of(FINISH)) >= 2
    assert not np.any(walks["task"] >= 0)
    for job, station, start_s in zip(served["job"], served["station"], served["start_s"]):
        came = walks.where(walks["end_s"] <= start_s)
        place = int(came["place_to"][-1]) if len(came) else 0
        assert place == p.stations[station].place, (job, station, start_s)
    # nobody is sent to a call: all his walks are of the round, or with a job
    sent = walks.where((walks["job"] >= 0) & ~np.isin(walks["start_s"], log.of(TRANSPORT)["start_s"]))
    assert len(sent) == 0


LOT = CARRIED.replace("carried: true", "carried: true, mass: 6 kg, lot: 5")
HEAVY = LOT.replace("workers: {w: {", "workers: {w: {most_load: 13 kg, ")


def test_who_cannot_carry_all_walks_again_for_the_rest():
    p = plan(HEAVY)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    # five units worked on till 30 s; two are carried at once, so three times there and twice back, 3 s each: 30 to 45 s
    carried = log.of(TRANSPORT)
    assert (carried["start_s"][0], carried["end_s"][0]) == (30.0, 45.0)
    walks = log.of(WALK)
    assert walks["end_s"][:5].tolist() == [33.0, 36.0, 39.0, 42.0, 45.0]
    assert walks["place_to"][:5].tolist() == [1, 0, 1, 0, 1]


@pytest.mark.parametrize(
    ("mass", "most_load", "walks"),
    [("6 kg", "30 kg", 1), ("6 kg", "29.9 kg", 3), ("0.1 kg", "0.3 kg", 3), ("6 kg", None, 1)],
)
def test_as_much_is_carried_at_once_as_the_limit_lets(mass, most_load, walks):
    limit = "" if most_load is None else f"most_load: {most_load}, "
    p = plan(HEAVY.replace("most_load: 13 kg, ", limit).replace("mass: 6 kg", f"mass: {mass}"))
    assert len(log_of_first(run_plan(p))) == walks


def log_of_first(log):
    """The walks with the first job."""
    walks = log.of(WALK)
    return walks.where(walks["job"] == 0)
