"""Human effects on a Worker of somebody's own model: as in a scenario, off where they are neutral."""

import pickle
from math import exp, log

import numpy as np
import pytest
import simpy

from opsim import Worker, exposure_of, run_plan
from opsim.kpi.catalogue import SCORED
from opsim.log import WORK
from opsim.subjects.exposure.figures import exposure
from opsim.subjects.human.plan import HumanPlan
from opsim.tasks import Fixed, Lognormal
from tests.plans import plan

MODELS = {
    "squat": "public_movements/deep_squat",
    "label": Lognormal(20.0, 0.3, 0.5),
}
SCENARIO = """
opsim: 1
name: twin
run: {horizon: 2 h, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {bench: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat, load: 9 kg}
  label: {dist: lognormal, mean: 20 s, cv: 0.3, between_share: 0.5}
stations: {bench: {at: bench, tasks: [squat, label], buffer: 1}}
products: {unit: {route: [bench]}}
release: {kind: saturated}
workers: {ana: {skills: {bench: 1.1}, height: 1.62 m, experience: {squat: 30}}}
human: HUMAN
"""
LEARNS = {
    "learning": {"model": "wright", "rate": 0.9, "measured_at": 20},
    "forgetting": {"model": "lfcm", "least_pause": "5 s"},
}
TIRES = {"model": "lffrm", "tires_half_in": "30 min", "recovers_half_in": "5 min", "slows": 0.4}
CLOCK = {"amplitude": 0.1, "peak": "16:00"}
START_S = 6 * 3600.0


def worked(human, *, experience=None, until=7200.0, story=None, models=MODELS, **how):
    env = simpy.Environment()
    given = {"seed": 5, "rating": 1.1, "body": {"height_m": 1.62}, "start_s": START_S} | how
    ana = Worker(env, "ana", models, human=human, experience=experience, **given)

    def on_and_on(worker):
        while True:
            for task in worker.tasks:
                yield worker.perform(task)

    env.process((story or on_and_on)(ana))
    env.run(until=until)
    return ana


def as_yaml(value):
    if not isinstance(value, dict):
        return repr(value)
    return "{" + ", ".join(f"{key}: {as_yaml(below)}" for key, below in value.items()) + "}"


@pytest.mark.parametrize(
    "human",
    [
        LEARNS,
        {**LEARNS, "fatigue": TIRES},
        {**LEARNS, "fatigue": TIRES, "acts_on": "time"},
        {**LEARNS, "fatigue": TIRES, "circadian": CLOCK},
        {**LEARNS, "fatigue": {**TIRES, "by": "posture"}},
        {**LEARNS, "fatigue": {"model": "3cc_r", "slows": 0.3}},
    ],
    ids=["learning", "fatigue", "fatigue acts on time", "circadian", "heavy tasks tire", "3cc_r"],
)
def test_times_and_shifts_are_those_of_a_scenario_with_the_same_effects(human):
    in_scenario = run_plan(plan(SCENARIO.replace("HUMAN", as_yaml(human))), 0).of(WORK)
    ana = worked(human, experience={"squat": 30}, handling={"squat": {"load_kg": 9}})
    own = ana.log.close().of(WORK)
    assert len(own) == len(in_scenario) > 300
    for column in ("start_s", "end_s", "k", "progress_to", "pace_shift"):
        assert np.array_equal(own[column], in_scenario[column]), column
    plain = worked(None).log.close().of(WORK)
    assert not np.array_equal(own["end_s"], plain["end_s"][: len(own)])


NEUTRAL = {
    "learning": {"model": "wright", "rate": 1, "measured_at": 7},
    "forgetting": {"model": "lfcm", "forgotten_in": "never", "least_pause": "0 s"},
    "fatigue": {"model": "lffrm", "slows": 0},
    "circadian": {"amplitude": 0, "peak": "03:00"},
}


def test_neutral_effects_leave_every_bit_alone():
    with_them, without = (worked(human).log.close() for human in (NEUTRAL, None))
    for column in without.columns:
        assert np.array_equal(with_them[column], without[column], equal_nan=True), column


def test_fatigue_by_hand():
    """600 s of work from fresh, half tired in 600 s: F = 0.5; 300 s of rest, half of it in 300 s: 0.25. A task of 10 s
    that then takes 1.4^F times as long: 10 x 1.4^0.25 = 10.878 s."""
    human = {"fatigue": {"model": "lffrm", "tires_half_in": "600 s", "recovers_half_in": "300 s", "slows": 0.4}}

    def story(worker):
        yield worker.perform("long")
        assert worker.fatigue == pytest.approx(0.5)
        yield worker.env.timeout(300.0)
        assert worker.fatigue == pytest.approx(0.25)
        done = yield worker.perform("short")
        assert done.duration_s == pytest.approx(10 * 1.4**0.25, abs=1e-6)
        assert done.pace_shift == pytest.approx(0.25 * log(1.4))

    ana = worked(human, story=story, models={"long": Fixed(600.0), "short": Fixed(10.0)}, rating=1.0, until=None)
    assert ana.env.now == pytest.approx(910.878, abs=1e-3)


def test_who_is_broken_off_rests_until_he_goes_on():
    human = {"fatigue": {"model": "lffrm", "tires_half_in": "600 s", "recovers_half_in": "300 s"}}

    def story(worker):
        doing = worker.perform("long")
        yield worker.env.timeout(600.0)
        doing.interrupt()
        piece = yield doing
        yield worker.env.timeout(300.0)
        assert worker.fatigue == pytest.approx(0.25)
        rest = worker.resume(piece)
        yield worker.env.timeout(600.0)
        assert worker.fatigue == pytest.approx(1 - 0.75 * 0.5)
        yield rest

    worked(human, story=story, models={"long": Fixed(6000.0)}, until=None)


def test_a_muscle_that_is_gone_on_with_is_loaded_by_what_is_left_of_the_task():
    """Broken off half-way and gone on with at once, a squat tires as the whole of it does."""
    human, half_s, tired = {"fatigue": {"model": "3cc_r"}}, [], []

    def story(worker):
        doing = worker.perform("squat")
        if half_s:
            yield worker.env.timeout(half_s[0])
            doing.interrupt()
            doing = worker.resume((yield doing))
        half_s.append((yield doing).duration_s / 2)
        tired.append(worker.fatigue)

    for _ in range(2):
        worked(human, story=story, models={"squat": MODELS["squat"]}, until=None)
    assert tired[1] == pytest.approx(tired[0], rel=1e-6) != 0.0


def test_learning_by_hand_and_by_experience():
    """Wright, 0.8: the fourth repetition takes 0.64 of the first."""
    human = {"learning": {"model": "wright", "rate": 0.8}}

    def seconds(**how):
        found = []

        def story(worker):
            for _ in range(4):
                found.append((yield worker.perform("fold")).duration_s)

        worked(human, story=story, models={"fold": Fixed(10.0)}, rating=1.0, until=None, **how)
        return found

    new = seconds()
    assert new[0] == 10.0 and new[1] == pytest.approx(8.0, abs=1e-5) and new[3] == pytest.approx(6.4, abs=1e-5)
    assert seconds(experience={"fold": 3})[0] == pytest.approx(6.4, abs=1e-5)


def test_the_clock_counts_from_start_s_and_from_wherever_the_environment_begins():
    """Best at 16:00, a tenth of log time: at 04:00 exp(0.1) times as long."""
    human = {"circadian": {"amplitude": 0.1, "peak": "16:00"}}
    for begins_s, start_s in ((0.0, 4 * 3600.0), (4 * 3600.0, 0.0)):
        env = simpy.Environment(initial_time=begins_s)
        done = env.run(Worker(env, "ana", {"fold": Fixed(10.0)}, human=human, start_s=start_s).perform("fold"))
        assert done.duration_s == pytest.approx(10 * exp(0.1), abs=1e-5)


def test_who_comes_at_six_is_as_fresh_as_who_comes_at_midnight():
    human = {"fatigue": TIRES}
    for begins_s in (0.0, 6 * 3600.0, -7.0):
        env = simpy.Environment(initial_time=begins_s)
        ana = Worker(env, "ana", {"fold": Fixed(60.0)}, human=human)
        env.run(ana.perform("fold"))
        assert ana.fatigue == pytest.approx(1 - 0.5 ** (60 / 1800))


def test_postures_follow_fatigue_and_are_those_that_are_scored():
    """As in a scenario: drawn from the same noise with the shift of the row."""
    done = []

    def story(worker):
        for _ in range(40):
            done.append((yield worker.perform("squat")))

    ana = worked({"fatigue": TIRES}, story=story, models={"squat": MODELS["squat"]}, until=None)
    last = done[-1]
    shifts = np.zeros(64)
    shifts[39] = last.pace_shift
    assert last.pace_shift > 0.01
    tired = ana.luck.slowed("squat", 0, shifts)
    assert np.allclose(last.positions_m(n_times=7), tired.positions_m(n_times=7)[39], rtol=0, atol=1e-9)
    fresh = ana.luck.performance("squat", 39)
    assert not np.allclose(last.positions_m(n_times=7), fresh.decoded("positions_m", n_times=7), rtol=0, atol=1e-4)
    by_log, by_pieces = exposure_of(ana.log), exposure_of(pickle.loads(pickle.dumps(done)))
    for name in ("rula", "trunk", "arm"):
        assert np.allclose(by_log.ledger.bins[name], by_pieces.ledger.bins[name], rtol=0, atol=1e-9)


def test_people_who_tire_are_scored_as_in_a_scenario():
    human = {**LEARNS, "fatigue": {**TIRES, "tires_half_in": "5 min"}}
    compiled = plan(SCENARIO.replace("HUMAN", as_yaml(human)).replace("2 h", "20 min"))
    theirs = {(one.kpi, one.subject, one.part): one.value for one in exposure(run_plan(compiled, 0), compiled, SCORED)}
    ana = worked(human, experience={"squat": 30}, handling={"squat": {"load_kg": 9}}, until=1200.0)
    seen = exposure_of(ana.log, start_s=START_S)
    elsewhere = ("exposure_by_station", "exposure_by_product")
    for key, value in theirs.items():
        assert key[0] in elsewhere or seen.value(*key) == pytest.approx(value, rel=1e-9, abs=1e-9, nan_ok=True), key
    fresh = exposure_of(worked(None, handling={"squat": {"load_kg": 9}}, until=1200.0).log, start_s=START_S)
    assert fresh.value("posture_dose", "ana") != pytest.approx(seen.value("posture_dose", "ana"), rel=1e-4)


def test_nobody_tires_where_nothing_is_said():
    assert worked(None, until=100.0).fatigue == 0.0 and worked(HumanPlan(), until=100.0).fatigue == 0.0
