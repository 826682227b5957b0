import numpy as np
import pytest
from human_plans import LINE, planned, shipped, without_effects

from opsim.clock import on_grid
from opsim.engine.floor import run_plan
from opsim.log import BLOCKED, FINISH, QUEUE, WORK

TWO = """
opsim: 1
name: Two benches
run: {start: Mon 06:00, horizon: 10 min, seed: 2}
layout: {distance: euclidean, places: {one: [0 m, 0 m], two: [0 m, 0 m]}}
tasks: {saw: {fixed: 10 s}, glue: {fixed: 30 s}}
stations: {a: {at: one, tasks: [saw], buffer: 1}, b: {at: two, tasks: [glue], buffer: 2}}
products: {part: {route: [a, b]}}
release: {kind: saturated}
workers: {ana: {skills: {a: 1.0}}, ben: {skills: {b: 1.0}}}
"""
HURRY = "human: {state_pace: {model: schultz, faster: 0.2, slower: 0.1}}"


def rows_of(log, worker):
    return log.where((log["kind"] == WORK) & (log["worker"] == worker))


def test_pace_by_hand():
    """Nobody feeds ana (0.5), and the buffer behind her is empty: -0.2 * 0.5. Nobody is behind ben (0.5).

    He begins with an empty buffer before him, 0.1 * (0.5 - 0), later with a full one, -0.2 * (1 - 0.5). Once his buffer
    is full, ana is in no hurry: 0.1 * (1 - 0.5) where she begins then.
    """
    log = run_plan(planned(TWO, HURRY))
    ana, ben = rows_of(log, 0), rows_of(log, 1)
    assert ana["pace_shift"][0] == pytest.approx(-0.1)
    assert ana["pace_shift"][-2] == pytest.approx(0.05)
    assert ben["pace_shift"][0] == pytest.approx(0.05)
    assert ben["pace_shift"][-2] == pytest.approx(-0.1)
    assert ben.duration_s[0] == on_grid(30.0 * float(np.exp(ben["pace_shift"][0])))


def test_acting_on_time_the_rows_have_no_shift_and_the_same_times():
    on_posture = run_plan(planned(TWO, HURRY))
    on_time = run_plan(planned(TWO, HURRY.replace("{state_pace", "{acts_on: time, state_pace")))
    work = on_time["kind"] == WORK
    assert np.all(on_time["pace_shift"][work] == 0) and np.any(on_posture["pace_shift"][work] != 0)
    assert np.array_equal(on_time["end_s"], on_posture["end_s"])


def test_people_who_hurry_for_others_finish_more():
    plan = planned(LINE, "human: {state_pace: {model: schultz, faster: 0.3}}")
    hurried, plain = (np.count_nonzero(run_plan(one)["kind"] == FINISH) for one in (plan, without_effects(plan)))
    assert hurried > plain


@pytest.mark.parametrize(("name", "hours"), [("bucket_brigade", 0.5), ("assembly", 1.0), ("forklift", 1.0)])
def test_every_shift_is_within_what_the_model_allows(name, hours):
    log = run_plan(shipped(name, hours, "human: {state_pace: {model: schultz, faster: 0.2, slower: 0.1}}"))
    shifts = log["pace_shift"][log["kind"] == WORK]
    assert np.all((shifts >= -0.2) & (shifts <= 0.1)) and np.unique(shifts).size > 1


def test_every_shift_is_what_the_rows_of_jobs_say_of_the_buffers_then():
    """Of ben, between ana and cy: jobs that queue before him or stand blocked behind ana, against jobs before cy."""
    text = LINE.replace("c: {at: three, tasks: [paint], buffer: 2}", "c: {at: three, tasks: [paint], buffer: 3}")
    log = run_plan(planned(text, HURRY))

    def jobs(kind, station, now):
        here = (log["kind"] == kind) & (log["station"] == station)
        return np.count_nonzero(here & (log["start_s"] <= now) & (now < log["end_s"]))

    expected = []
    for now in (ben := rows_of(log, 1))["start_s"]:
        before = min(1.0, (jobs(QUEUE, 1, now) + jobs(BLOCKED, 0, now)) / 2)
        ahead = before - min(1.0, jobs(QUEUE, 2, now) / 3)
        expected.append(-0.2 * ahead if ahead > 0 else -0.1 * ahead)
    assert ben["pace_shift"] == pytest.approx(np.array(expected), abs=1e-12)
    assert np.unique(expected).size > 4
