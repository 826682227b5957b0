"""Muscles that tire, and work that is heavy, on both engines: the loads are Python's draws."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from human_plans import planned
from twins import of_both

from opsim.engine.fast_engine import run_plan
from opsim.engine.fast_engine.run import Machine
from opsim.engine.floor.run import run_plan as run_simpy
from opsim.log import BREAK, REST, WORK
from opsim.subjects.human import muscle_fatigue as burden

FLOOR = """
opsim: 1
name: bench
run: {start: Mon 06:00, horizon: 40 min, seed: 8}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m]}}
shifts: {day: {from: '06:00', to: '06:35', breaks: {tea: {at: '06:15', lasts: 4 min}}, at_break: resume_any}}
tasks:
  raise: {emulator: work/lift, load: 8 kg}
  stoop: {emulator: work/stoop, load: 4 kg}
  note: {fixed: 4 s}
stations:
  one: {at: a, tasks: [raise, note], buffer: 1, breakdowns: {jam: {every: {dist: exponential, mean: 4 min}, repair: {fixed: 20 s}}}}
  two: {at: b, tasks: [stoop], buffer: 1}
products: {part: {route: [one, two]}}
release: {kind: saturated}
workers:
  ana: {shift: day, height: 1.65 m, mass: 62 kg, sex: f, skills: {one: 1.0, two: 0.9}}
  ben: {height: 1.80 m, mass: 82 kg, sex: m, skills: {two: 1.0, one: 1.0}}
"""  # noqa: E501
MUSCLES = (
    "human: {fatigue: {model: 3cc_r, slows: 0.6}, rest: {above: 0.06, until: 0.02}, errors: {at_full_fatigue: 0.5}}"
)
POSTURE = "human: {fatigue: {model: lffrm, by: posture, tires_half_in: 10 min, recovers_half_in: 2 min, slows: 0.5}}"


def test_muscles_tire_and_rest_as_they_do_in_the_reference():
    log = of_both(planned(FLOOR, MUSCLES))
    work = log.of(WORK)
    assert np.count_nonzero((log["kind"] == BREAK) & (log["cause"] == REST)) > 3
    assert (work["progress_to"] < 1.0).any() and work["pace_shift"].max() > 0.02


def test_a_task_without_a_body_is_a_rest_for_muscles_as_in_the_reference():
    log = of_both(planned(FLOOR, "human: {fatigue: {model: 3cc_r, slows: 5}}"))
    assert log.of(WORK)["pace_shift"].max() > 0.1


def test_heavy_work_tires_more_as_in_the_reference():
    even = POSTURE.replace("by: posture, ", "")
    heavy, light = (of_both(planned(FLOOR, human)).of(WORK)["pace_shift"] for human in (POSTURE, even))
    assert not np.array_equal(heavy[: len(light)], light[: len(heavy)])


@pytest.mark.parametrize("human", [MUSCLES, POSTURE])
def test_a_floor_that_runs_again_asks_anew_about_other_people(human):
    """Replications of one workforce, then of another, on the same memory."""
    plan = planned(FLOOR.replace("seed: 8", "seed: 8, staffing: redrawn"), human)
    machine = Machine(plan)
    for replication in (0, 0, 1, 0):
        log, fast = run_simpy(plan, replication), machine.run(replication)
        assert np.array_equal(log["end_s"], fast["end_s"]) and np.array_equal(log["worker"], fast["worker"])


@pytest.fixture
def nothing_known(monkeypatch):
    """NOTE: what the same people do is kept in a process, and would not be asked for where another test did so."""
    monkeypatch.setattr(burden, "_KEPT", type(burden._KEPT)())


@pytest.mark.usefixtures("nothing_known")
@pytest.mark.parametrize("human", [MUSCLES, POSTURE])
def test_what_python_raises_when_it_is_asked_is_raised_by_the_run(human, monkeypatch):
    def fails(*_args):
        raise RuntimeError("no such movement")

    monkeypatch.setattr(burden, "_drawn", fails)
    with pytest.raises(RuntimeError, match="no such movement"):
        run_plan(planned(FLOOR, human))


@pytest.mark.usefixtures("nothing_known")
@pytest.mark.parametrize("human", [MUSCLES, POSTURE])
def test_an_answer_that_failed_is_asked_for_again_in_the_next_run(human, monkeypatch):
    plan = planned(FLOOR, human)

    def fails(*_args):
        raise KeyboardInterrupt

    with monkeypatch.context() as broken:
        broken.setattr(burden, "_drawn", fails)
        with pytest.raises(KeyboardInterrupt):
            run_plan(plan)
    of_both(plan)


def test_a_model_of_fatigue_that_nobody_knows_is_refused_by_its_name():
    plan = planned(FLOOR, POSTURE)
    stranger = type("Stranger", (SimpleNamespace,), {})
    with pytest.raises(NotImplementedError, match="Stranger"):
        run_plan(replace(plan, human=replace(plan.human, fatigue=stranger())))
