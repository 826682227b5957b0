from dataclasses import replace

import numpy as np
import pytest
from human_plans import LINE, planned, shipped, without_effects

from opsim.clock import on_grid
from opsim.engine.floor.run import run_plan
from opsim.log import FINISH, WORK
from opsim.subjects.human.catalogue import entry, models_of
from opsim.subjects.human.plan import HumanPlan

ONE = """
opsim: 1
name: One bench
run: {start: Fri 13:00, horizon: 3 d, seed: 2}
layout: {distance: euclidean, places: {here: [0 m, 0 m]}}
tasks: {fit: {fixed: 100 s}}
stations: {bench: {at: here, tasks: [fit], buffer: 1}}
products: {part: {route: [bench]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, days: [Mon, Fri]}}
workers: {ana: {skills: {bench: 1.0}, shift: early}}
"""


def finished(plan, replication=0):
    return int(np.count_nonzero(run_plan(plan, replication)["kind"] == FINISH))


def times_s(plan):
    log = run_plan(plan)
    return log.duration_s[log["kind"] == WORK]


def test_times_fall_as_wright_says_by_hand():
    """100 s, then 80 s, 100 * 3^-0.3219 = 70.21 s, 64 s."""
    found = times_s(planned(ONE, "human: {learning: {model: wright, rate: 0.8}}"))
    assert found[:4] == pytest.approx([100.0, 80.0, 70.2104, 64.0], abs=1e-3)


def test_experience_goes_before_the_first_repetition():
    text = ONE.replace("shift: early}}", "shift: early, experience: {fit: 7}}}")
    found = times_s(planned(text, "human: {learning: {model: wright, rate: 0.8}}"))
    assert found[0] == on_grid(100.0 * 8.0**-0.32192809488736235)


def test_a_weekend_takes_repetitions_away_and_a_year_of_memory_few():
    """Friday 13:00 to 14:00, then Monday 06:00: the pause is longer than a day."""
    learning = "learning: {model: wright, rate: 0.8}"
    weekend = ONE.replace("horizon: 3 d", "horizon: 2 d 18 h")
    never, slow, fast = (
        times_s(planned(weekend, f"human: {{{learning}, forgetting: {{model: lfcm, forgotten_in: {span}}}}}"))
        for span in ("never", "900 d", "3 d")
    )
    n_friday = np.flatnonzero(np.diff(fast) > 1.0)[0] + 1
    assert fast[n_friday] > slow[n_friday] > never[n_friday]
    assert np.array_equal(fast[:n_friday], never[:n_friday])
    assert fast[n_friday] < 100.0


@pytest.mark.parametrize("model", models_of("learning"))
def test_learning_raises_the_output_of_a_line_on_the_same_numbers(model):
    """A saturated line whose every time is no longer finishes no later."""
    on = planned(LINE, f"human: {{learning: {{model: {model}}}}}")
    assert finished(on) > 1.1 * finished(without_effects(on))


@pytest.mark.slow
@pytest.mark.parametrize("model", models_of("learning"))
def test_learning_raises_the_output_in_every_replication(model):
    on = planned(LINE, f"human: {{learning: {{model: {model}}}}}")
    assert all(finished(on, n) > finished(without_effects(on), n) for n in range(1, 11))


def test_faster_learners_never_finish_less():
    plans = [planned(LINE, f"human: {{learning: {{model: wright, rate: {rate}}}}}") for rate in (1.0, 0.95, 0.9, 0.8)]
    done = [finished(plan) for plan in plans]
    assert done == sorted(done) and done[0] < done[-1]


def test_who_has_a_measured_pace_behind_him_is_slower_than_recorded_until_then():
    new = planned(LINE, "human: {learning: {model: de_jong, measured_at: 1000}}")
    assert finished(new) < finished(without_effects(new))


def _nth_times(plan, n, replications):
    logs = [run_plan(plan, replication) for replication in range(replications)]
    return np.array([log.duration_s[np.flatnonzero((log["kind"] == WORK) & (log["worker"] == 0))][:n] for log in logs])


def test_learning_leaves_the_coefficient_of_variation_of_every_repetition_alone():
    """Of the 1st, 2nd, 4th, ... 32nd repetition over 60 replications: learning scales all of them by one number each.

    So their CV is that without learning on the same numbers, to the rounding of times to the grid; and it is the task's
    0.25 within four standard errors, 0.25 / sqrt(2 * 60 * 6) each for the six classes pooled.
    """
    plan = replace(planned(LINE, "human: {learning: {model: wright, rate: 0.8}}"), horizon_s=2700.0)
    learned, plain = (_nth_times(one, 32, 60)[:, [0, 1, 3, 7, 15, 31]] for one in (plan, without_effects(plan)))
    cv, before = (times.std(axis=0, ddof=1) / times.mean(axis=0) for times in (learned, plain))
    assert learned.mean(axis=0)[-1] < 0.4 * plain.mean(axis=0)[-1]
    assert cv == pytest.approx(before, rel=1e-6)
    assert abs(np.sqrt(np.mean(cv**2)) - 0.25) < 4 * 0.25 / np.sqrt(2 * 60 * 6)


def test_forgetting_alone_changes_nothing():
    plan = shipped("serial_line", 1.0)
    alone = replace(plan, human=HumanPlan(forgetting=entry("forgetting").cls(least_pause_s=0.0)))
    assert np.array_equal(times_s(plan), times_s(alone))
