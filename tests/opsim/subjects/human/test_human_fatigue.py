"""Fatigue on the floor: neutral it is nothing; more of it is never more output; what the rows say is what happened."""

from itertools import pairwise

import numpy as np
import plans
import pytest
from checked_floors import differ, plan_of
from choices import Lots
from human_plans import LINE, planned, shipped, without_effects
from made.brigades import scenario as brigade
from made.floors import text_of
from made.people_blocks import people_floor_with

from opsim.engine.floor.run import run_plan
from opsim.history import tiredness
from opsim.kpi import figures
from opsim.laws.audit import audit
from opsim.log import FINISH, NO_TOOL, SETUP, WAIT, WORK

LFFRM = "human: {fatigue: {model: lffrm, slows: 0}, rest: {above: 1, until: 0.5}}"
MUSCLES = "human: {fatigue: {model: 3cc_r, slows: 0}, rest: {above: 1, until: 0.5}}"
BLOCKS = (
    ["shifts", "breaks"],
    ["shifts", "breaks", "overtime", "zones", "floaters"],
    ["shifts", "breaks", "bucket_brigades"],
    ["shifts", "breaks", "rotations"],
)


def with_human(values, human):
    return {**values, "human": human}


def finished(log):
    return int((log["kind"] == FINISH).sum())


@pytest.mark.parametrize(
    ("name", "hours"),
    [("serial_line", 3), ("u_cell", 1), ("bucket_brigade", 1), ("relief_worker", 2), ("moving_line", 1)],
)
def test_neutral_fatigue_is_the_run_without_it_bit_for_bit(name, hours):
    neutral = shipped(name, hours, LFFRM)
    log = run_plan(neutral)
    assert differ(run_plan(without_effects(neutral)), log) == []
    assert tiredness(log, neutral).end.max() > 0.01  # somebody was tired, and it cost nothing


@pytest.mark.parametrize(("name", "hours"), [("torque_guns", 0.5), ("job_rotation", 0.5), ("two_shift_plant", 1)])
@pytest.mark.parametrize("human", [LFFRM, MUSCLES])
def test_so_it_is_with_teams_held_tools_rotations_shifts_and_bodies(name, hours, human):
    neutral = shipped(name, hours, human)
    assert differ(run_plan(without_effects(neutral)), run_plan(neutral)) == []


@pytest.mark.parametrize("seed", range(8))
def test_so_it_is_on_random_floors_of_shifts_breaks_interruptions_and_crews(seed):
    values = people_floor_with(Lots(seed), BLOCKS[seed % len(BLOCKS)])
    neutral = plan_of(text_of(with_human(values, {"fatigue": {"model": "lffrm", "slows": 0}})))
    assert differ(run_plan(without_effects(neutral)), run_plan(neutral)) == []


@pytest.mark.parametrize("seed", range(6))
def test_so_it_is_with_random_crews(seed):
    text = brigade(seed)[:-1] + ', "human": {"fatigue": {"model": "lffrm", "slows": 0}}}'
    neutral = plans.plan(text)
    assert differ(run_plan(without_effects(neutral)), run_plan(neutral)) == []


def test_who_never_tires_is_never_slowed_however_much_it_would_slow_him():
    neutral = planned(LINE, "human: {fatigue: {model: lffrm, tires_half_in: never, slows: 1}}")
    assert differ(run_plan(without_effects(neutral)), run_plan(neutral)) == []


def line_with(fatigue):
    plan = planned(LINE, f"human: {{fatigue: {{model: lffrm, {fatigue}}}}}")
    log = run_plan(plan)
    audit(log, plan)
    return log, plan


def finish_times(log):
    return log.of(FINISH)["end_s"]


def test_more_fatigue_is_never_more_output_on_a_serial_line():
    """On the same random numbers no job is finished before its time in the line of less fatigue."""
    logs = [line_with(f"slows: {slows}")[0] for slows in (0.0, 0.1, 0.3, 0.6, 1.0)]
    outputs = [finished(log) for log in logs]
    assert outputs == sorted(outputs, reverse=True) and outputs[0] > outputs[-1]
    for less, more in pairwise(logs):
        n = finished(more)
        assert np.all(finish_times(more) >= finish_times(less)[:n])


def test_who_tires_faster_is_never_quicker_on_a_serial_line():
    logs = [line_with(f"slows: 0.5, tires_half_in: {time}")[0] for time in ("never", "8 h", "2 h", "30 min", "5 min")]
    outputs = [finished(log) for log in logs]
    assert outputs == sorted(outputs, reverse=True) and outputs[0] > outputs[-1]


def test_longer_breaks_lower_fatigue():
    means = []
    for minutes in (0, 10, 20, 40):
        breaks = f"breaks: {{lunch: {{at: '08:00', lasts: {minutes} min}}}}" if minutes else ""
        shift = f"shifts: {{day: {{from: '06:00', to: '10:00', {breaks}}}}}\n"
        text = (LINE + shift).replace("{skills:", "{shift: day, skills:")
        plan = planned(text, "human: {fatigue: {model: lffrm, tires_half_in: 1 h, recovers_half_in: 10 min}}")
        log = run_plan(plan)
        audit(log, plan)
        found = {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan)}
        means.append([found["fatigue_mean", name, ""] for name in ("", "ana", "ben", "cy")])
    assert np.all(np.diff(means, axis=0) < 0)


def test_the_shift_of_a_hand_worked_line():
    # 10 s of work, half tired in 10 s, 100 % longer at full fatigue, so log time + ln 2 x F; nobody waits:
    # k = 0: F = 0, 10 s; k = 1: F = 0.5, 10 x 2^0.5 = 14.142136 s; then F = 1 - 0.5 x 2^-1.4142136 = 0.812393,
    # 10 x 2^0.812393 = 17.561217 s
    text = """
opsim: 1
name: one
run: {horizon: 60 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 10 s}}
stations: {s: {at: a, tasks: [make], buffer: 1}}
products: {part: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}}}
human: {fatigue: {model: lffrm, tires_half_in: 10 s, recovers_half_in: 10 s, slows: 1}}
"""
    log, _ = plans.ran(text)
    work = log.of(WORK)
    assert work.duration_s[:3] == pytest.approx([10.0, 14.142136, 17.561217], abs=2e-6)
    assert work["pace_shift"][:3] == pytest.approx([0.0, 0.5 * np.log(2), 0.812393 * np.log(2)], abs=1e-6)


def test_who_waits_recovers():
    """The second of a line, who has half as long to do, is half as tired as the first at most."""
    text = LINE.replace("drill: {dist: lognormal, mean: 60 s", "drill: {dist: lognormal, mean: 20 s")
    plan = planned(text, "human: {fatigue: {model: lffrm, tires_half_in: 30 min, recovers_half_in: 5 min}}")
    found = {(f.kpi, f.subject): f.value for f in figures(run_plan(plan), plan) if f.part == ""}
    assert found["fatigue_mean", "ben"] < 0.5 * found["fatigue_mean", "ana"]


def test_pieces_of_a_performance_keep_their_shift_and_a_wait_for_a_tool_is_a_rest():
    plan = shipped("torque_guns", 0.5, "human: {fatigue: {model: lffrm, tires_half_in: 5 min, slows: 0.5}}")
    log = run_plan(plan)
    audit(log, plan)
    work = log.of(WORK, SETUP)
    order = np.argsort(work["performance_id"], kind="stable")
    same = np.diff(work["performance_id"][order]) == 0
    assert same.any()
    assert np.all(np.diff(work["pace_shift"][order])[same] == 0)
    assert np.any((log["kind"] == WAIT) & (log["cause"] == NO_TOOL))


def test_a_plain_factor_slows_as_much_and_leaves_no_shift_in_the_rows():
    shifted, plain = (
        run_plan(planned(LINE, f"human: {{acts_on: {acts_on}, fatigue: {{model: lffrm, slows: 0.4}}}}"))
        for acts_on in ("posture", "time")
    )
    assert np.array_equal(shifted["end_s"], plain["end_s"])
    assert shifted["pace_shift"][shifted["kind"] == WORK].max() > 0.01
    assert not plain["pace_shift"][plain["kind"] == WORK].any()


@pytest.mark.parametrize("seed", range(4))
def test_the_laws_hold_on_random_floors_of_tired_people(seed):
    values = people_floor_with(Lots(seed), BLOCKS[seed % len(BLOCKS)])
    fatigue = {"model": "lffrm", "tires_half_in": "5 min", "recovers_half_in": "1 min", "slows": 0.5}
    plan = plan_of(text_of(with_human(values, {"fatigue": fatigue})))
    audit(run_plan(plan), plan)


BENCH = """
opsim: 1
name: bench
run: {start: Mon 06:00, horizon: 2 h, seed: 8}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m]}}
shifts: {day: {from: '06:00', to: '08:00', breaks: {tea: {at: '07:00', lasts: 10 min}}}}
tasks: {raise: {emulator: work/lift, load: 8 kg}, stoop: {emulator: work/stoop, load: 4 kg}}
stations:
  one: {at: a, tasks: [raise], buffer: 1}
  two: {at: b, tasks: [stoop], buffer: 1}
products: {part: {route: [one, two]}}
release: {kind: saturated}
workers:
  ana: {shift: day, height: 1.65 m, mass: 62 kg, sex: f, skills: {one: 1.0}}
  ben: {shift: day, height: 1.80 m, mass: 82 kg, sex: m, skills: {two: 1.0}}
"""


def test_muscles_that_slow_more_never_finish_anything_sooner():
    logs = []
    for slows in (0.0, 0.3, 1.0):
        plan = planned(BENCH, f"human: {{fatigue: {{model: 3cc_r, slows: {slows}}}}}")
        log = run_plan(plan)
        audit(log, plan)
        logs.append(log)
    outputs = [finished(log) for log in logs]
    assert outputs == sorted(outputs, reverse=True) and outputs[0] > outputs[-1]
    for less, more in pairwise(logs):
        assert np.all(finish_times(more) >= finish_times(less)[: finished(more)])


def test_longer_breaks_and_lighter_loads_leave_fresher_muscles():
    def mean(text):
        plan = planned(text, "human: {fatigue: {model: 3cc_r, slows: 0}}")
        return {f.subject: f.value for f in figures(run_plan(plan), plan) if f.kpi == "fatigue_mean"}

    usual, longer, lighter = mean(BENCH), mean(BENCH.replace("10 min", "30 min")), mean(BENCH.replace("8 kg", "2 kg"))
    assert longer["ana"] < usual["ana"] and longer["ben"] < usual["ben"]
    assert lighter["ana"] < usual["ana"]
    assert lighter["ben"] == pytest.approx(usual["ben"], rel=1e-9)  # he does the same at the same times
