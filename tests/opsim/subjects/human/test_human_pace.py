"""Off means off: every effect at its neutral values, through its own code, leaves the event log as it was."""

import numpy as np
import pytest
from checked_floors import differ
from human_plans import LINE, NEUTRAL, planned, shipped, without_effects

from opsim.clock import on_grid
from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import BAD, BLOCKED, FINISH, QUEUE, REWORK, WORK
from opsim.subjects.human.catalogue import entry

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


HOUR_S = 3600.0


def test_the_shift_of_a_row_is_that_of_the_clock_when_it_began():
    """Amplitude 0.1, peak at 09:00, start at 06:00: -0.1 cos(2 pi (06:00 + now - 09:00) / 24 h)."""
    log = run_plan(planned(LINE, "human: {circadian: {amplitude: 0.1, peak: '09:00'}}"))
    work = log["kind"] == WORK
    clock_s = 6 * HOUR_S + log["start_s"][work]
    assert log["pace_shift"][work] == pytest.approx(-0.1 * np.cos(2 * np.pi * (clock_s - 9 * HOUR_S) / (24 * HOUR_S)))


def test_a_run_that_starts_at_the_peak_is_quickest_at_its_start():
    log = run_plan(
        planned(LINE.replace("Mon 06:00", "Tue 16:00"), "human: {circadian: {amplitude: 0.1, peak: '16:00'}}")
    )
    assert log["pace_shift"][np.flatnonzero(log["kind"] == WORK)[0]] == pytest.approx(-0.1, abs=1e-4)


TIRED = "fatigue: {model: lffrm, tires_half_in: 1 h, slows: 0}"
INSPECTED = LINE.replace(
    "c: {at: three, tasks: [paint], buffer: 2}",
    "c: {at: three, tasks: [paint], buffer: 2, inspect: {finds: 0.5, then: {rework: c}}}",
)


def with_errors(share, text=LINE):
    return planned(text, f"human: {{{TIRED}, errors: {{at_full_fatigue: {share}}}}}")


def bad(log):
    return {int(job) for job in log["job"][(log["kind"] == FINISH) & (log["cause"] == BAD)]}


def test_more_errors_spoil_more_jobs_and_all_that_fewer_spoil():
    """Fatigue slows nobody here, so all else is the same; a defect is the same number below a larger chance."""
    none, some, many = (bad(run_plan(with_errors(share))) for share in (0, 0.1, 0.4))
    assert none == set() and some < many and some


def test_the_share_of_defects_is_what_the_levels_of_those_who_worked_make_of_it():
    """Hours at half an hour's half-time leave everybody near exhausted: three operations, (1 - 0.1)^3 = 0.729 good."""
    plan = planned(
        LINE.replace("horizon: 4 h", "horizon: 40 h"),
        "human: {fatigue: {model: lffrm, tires_half_in: 5 min, recovers_half_in: 1000 h, slows: 0}, "
        "errors: {at_full_fatigue: 0.1}}",
    )
    log = run_plan(plan)
    late = (log["kind"] == FINISH) & (log["start_s"] > 2 * 3600)
    n, share = np.count_nonzero(late), np.mean(log["cause"][late] == BAD)
    assert abs(share - 0.271) < 4 * np.sqrt(0.271 * 0.729 / n)


def test_defects_of_the_tired_are_found_and_reworked():
    plan = with_errors(0.4, INSPECTED)
    log = run_plan(plan)
    audit(log, plan)
    assert np.count_nonzero(log["kind"] == REWORK) > 5


@pytest.mark.parametrize(("name", "hours"), [("solder_rework", 2.0), ("work_sharing", 2.0), ("cherry_picking", 1.0)])
def test_no_errors_at_full_fatigue_change_no_bit_of_a_log(name, hours):
    plan = shipped(name, hours, f"human: {{{TIRED}, errors: {{at_full_fatigue: 0}}}}")
    assert plan.quality and plan.human.errors is not None
    assert differ(run_plan(plan), run_plan(shipped(name, hours))) == []


def test_the_quality_of_a_learner_and_fatigue_go_together():
    """0.8 of ben's work is good when he is fresh: with errors never more of it, and the same jobs are bad at least."""
    text = LINE.replace("{b: 1.0}", "{b: {pace: 1.0, quality: 0.8}}")
    plain, tired = (bad(run_plan(with_errors(share, text))) for share in (0, 0.3))
    assert plain < tired


def test_machines_that_work_alone_do_not_err():
    plan = planned(
        LINE.replace("drill: {dist", "drill: {automatic: true, dist").replace("  ben: {skills: {b: 1.0}}\n", ""),
        f"human: {{{TIRED}, errors: {{at_full_fatigue: 0.4}}}}",
    )
    assert [plan.stations[one.station].name for one in plan.quality] == ["a", "c"]


FLOORS = [
    *(("serial_line", 4.0), ("cherry_picking", 2.0)),  # a line, a pool
    *(("two_shift_plant", 7.0), ("night_shift", 8.0), ("relief_worker", 4.0)),  # breaks, closing, interruption
    *(("torque_guns", 2.0), ("bucket_brigade", 1.0), ("u_cell", 1.0)),  # tools held between moments, teams, crews
    *(("colour_changes", 4.0), ("paced_line", 2.0), ("moving_line", 1.0)),  # set-ups, andon, a moving line
    pytest.param("repack_cell", 1.0, marks=pytest.mark.slow),  # recorded movements: a library is read
]


@pytest.mark.parametrize(("name", "hours"), FLOORS)
def test_neutral_effects_change_no_bit_of_a_log(name, hours):
    plan = shipped(name, hours, NEUTRAL)
    assert plan.human.changes_times and plan.human.learning == entry("learning").cls(rate=1.0, measured_at=7.0)
    assert differ(run_plan(plan), run_plan(shipped(name, hours))) == []


@pytest.mark.parametrize(
    "human",
    [
        *(f"human: {{learning: {{model: {model}}}}}" for model in ("wright", "de_jong")),
        "human: {state_pace: {model: schultz}}",
        "human: {circadian: {amplitude: 0.1}}",
    ],
)
def test_the_same_comparison_sees_effects_that_are_not_neutral(human):
    plan = shipped("serial_line", 2.0, human)
    assert differ(run_plan(plan), run_plan(without_effects(plan))) != []
