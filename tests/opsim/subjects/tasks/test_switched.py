"""What each switch of variability takes away, what it leaves, and that the mean stays."""

from dataclasses import dataclass

import numpy as np
import pytest
import simpy

from opsim import Worker
from opsim.external_worker import library_model
from opsim.streams import stream
from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, Recorded, switched
from opsim.worker_effects import worker_effect

SWITCHES = ("within_only", "between_only", "none", "shuffled")
TRACE = Recorded((1.0, 2.0, 6.0), by_index=True)
LIFT = library_model("bench_work/lift")
MODELS = [Lognormal(20.0, 0.4, 0.5), Gamma(20.0, 0.4, 0.3), LIFT]
each_model = pytest.mark.parametrize("model", MODELS, ids=["lognormal", "gamma", "emulated"])


def drawn(model, n_workers, n=64, seed=0):
    """(n_workers, n) durations of workers drawn from the population, each by generators of his own."""
    workers = [model.draw_worker(np.random.default_rng([seed, w])) for w in range(n_workers)]
    rngs = [np.random.default_rng([seed, w, 1]) for w in range(n_workers)]
    return np.array([model.sample(n, rng, worker=worker).duration_s for worker, rng in zip(workers, rngs)])


def test_full_is_the_model_itself():
    for model in (*MODELS, TRACE, Fixed(3.0)):
        assert switched(model, "full") is model


def test_an_unknown_word_is_refused_with_the_nearest():
    with pytest.raises(ValueError, match="no 'shufled'; did you mean 'shuffled'"):
        switched(Fixed(3.0), "shufled")


@each_model
@pytest.mark.parametrize("switch", SWITCHES)
def test_the_mean_over_the_population_stays(switch, model):
    """Within four standard errors, from the spread of the means of 144 workers; said exactly without drawing."""
    changed = switched(model, switch)
    assert changed.mean_duration_s() == model.mean_duration_s()
    means = drawn(changed, 144).mean(axis=1)
    assert abs(means.mean() - model.mean_duration_s()) <= 4 * means.std(ddof=1) / 12 + 1e-9


@each_model
def test_with_none_everybody_takes_the_mean_bit_for_bit(model):
    changed = switched(model, "none")
    assert np.all(drawn(changed, 5) == model.mean_duration_s())
    assert np.all(changed.sample(5, np.random.default_rng(0)).duration_s == model.mean_duration_s())
    worker = changed.draw_worker(np.random.default_rng(1))
    assert changed.mean_duration_s(worker) == model.mean_duration_s()


@each_model
def test_with_between_only_each_worker_always_takes_his_own_mean(model):
    changed = switched(model, "between_only")
    effects = [model.draw_worker(np.random.default_rng([0, w])) for w in range(6)]
    means = [model.mean_duration_s(effect) for effect in effects]
    assert np.array_equal(drawn(changed, 6), np.repeat(np.array(means)[:, None], 64, axis=1))
    assert np.ptp(means) > 0
    assert [changed.mean_duration_s(effect) for effect in effects] == means


@each_model
def test_with_within_only_everybody_has_his_own_spread_about_one_mean(model):
    changed, mean_s = switched(model, "within_only"), model.mean_duration_s()
    effects = [model.draw_worker(np.random.default_rng([0, w])) for w in range(6)]
    own = drawn(model, 6) / np.array([model.mean_duration_s(effect) for effect in effects])[:, None]
    assert np.allclose(drawn(changed, 6), own * mean_s, rtol=1e-12)
    assert [changed.mean_duration_s(effect) for effect in effects] == [mean_s] * 6


def test_within_only_leaves_the_variance_within_and_takes_that_between():
    model = Lognormal(20.0, 0.4, 0.5)
    logs = np.log(drawn(switched(model, "within_only"), 2000, n=16))
    within = logs.var(axis=1, ddof=1).mean()
    assert within == pytest.approx(0.5 * np.log1p(0.16), rel=0.03)
    between = logs.mean(axis=1).var(ddof=1) - within / 16
    assert abs(between) < 4 * within / 16 * (2 / 2000) ** 0.5


@each_model
def test_shuffled_durations_are_those_of_full_bit_for_bit(model):
    assert np.array_equal(drawn(switched(model, "shuffled"), 5), drawn(model, 5))
    worker = switched(model, "shuffled").draw_worker(np.random.default_rng(1))
    assert switched(model, "shuffled").mean_duration_s(worker) == model.mean_duration_s(worker)


def test_shuffled_takes_the_bond_of_posture_and_duration_and_keeps_how_bodies_move():
    """Coordinates of the draw keep mean and spread over the population; what correlates with duration no more does."""
    n, rng = 4000, np.random.default_rng(4)
    bonded, loose = (model.sample(n, rng) for model in (LIFT, switched(LIFT, "shuffled")))
    duration = LIFT.scale.block("duration").start
    r = [np.corrcoef(np.log(one.duration_s), one.scores.T)[0, 1:] for one in (bonded, loose)]
    assert np.abs(r[0][duration]) > 0.99  # log duration is a coordinate of the draw
    assert np.abs(r[1]).max() < 4.5 / n**0.5
    assert np.abs(r[0][:duration]).max() > 0.2
    assert np.allclose(bonded.scores.mean(axis=0), loose.scores.mean(axis=0), atol=4 * (2 / n) ** 0.5 * 1.2)
    assert np.allclose(bonded.scores.std(axis=0), loose.scores.std(axis=0), rtol=0.1)


def seen(performances):
    """(n, 2) the share of its time at which the first mark falls, and how far the pelvis sinks, in metres."""
    share = performances.mark_s[:, 0] / performances.duration_s
    height_m = performances.positions_m(n_times=15)[:, :, LIFT.skeleton.names.index("pelvis"), 2]
    return np.stack([share, height_m[:, 0] - height_m.min(axis=1)], axis=1)


def test_shuffled_takes_the_bond_of_what_is_seen_of_one_worker_s_bodies_and_keeps_their_mean_and_spread():
    """The first mark's share and the pelvis's depth tell of a worker's duration (|r| above 0.2 for one of them), under
    shuffled they do not; means stay within four standard errors, spreads within a tenth.
    """
    n, ana = 700, LIFT.draw_worker(np.random.default_rng(2))
    models = (LIFT, switched(LIFT, "shuffled"))
    bonded, loose = (model.sample(n, np.random.default_rng(4), worker=ana) for model in models)
    one, two = seen(bonded), seen(loose)
    told = [np.corrcoef(np.log(drawn.duration_s), what.T)[0, 1:] for drawn, what in ((bonded, one), (loose, two))]
    assert np.abs(told[0]).max() > 0.2
    assert np.abs(told[1]).max() < 4 / n**0.5
    assert np.all(np.abs(one.mean(axis=0) - two.mean(axis=0)) < 4 * one.std(axis=0) * (2 / n) ** 0.5)
    assert np.allclose(one.std(axis=0), two.std(axis=0), rtol=0.1)


def test_shuffled_gives_the_body_of_another_performance_of_the_same_worker():
    """His mean posture is his own and not the population's; no body is that of the performance whose time it has."""
    far = max((LIFT.draw_worker(np.random.default_rng(s)) for s in range(8)), key=lambda effect: apart(effect.z))
    own, other = (m.sample(400, np.random.default_rng(1), worker=far) for m in (LIFT, switched(LIFT, "shuffled")))
    assert np.array_equal(own.duration_s, other.duration_s)
    assert not np.any(np.all(own.scores == other.scores, axis=1))
    assert apart(other.scores.mean(axis=0), own.scores.mean(axis=0)) < 0.3 * apart(own.scores.mean(axis=0))


def apart(z, other=None):
    """Distance of two means, of joint coordinates, over the posture: from the population's where one is given."""
    posture = LIFT.scale.block("posture")
    return np.linalg.norm((z - (LIFT.workforce.between.mean if other is None else other))[posture])


@dataclass(frozen=True)
class Asked:
    """A body as an object."""

    pace: float | None = None
    height_m: float | None = None


@pytest.mark.parametrize("body", [{"pace": 0.6}, Asked(0.6), {"pace": 1.25, "person": LIFT.workers[0]}])
@pytest.mark.parametrize("switch", ["none", "within_only"])
def test_a_pace_that_is_asked_for_divides_the_population_s_mean(switch, body):
    """Said exactly; of 4000 times within four standard errors, where there is spread."""
    changed, pace = switched(LIFT, switch), getattr(body, "pace", None) or body["pace"]
    worker = changed.draw_worker(np.random.default_rng(3), body)
    assert changed.mean_duration_s(worker) == LIFT.mean_duration_s() / pace
    times = changed.sample(4000, np.random.default_rng(4), worker=worker).duration_s
    assert abs(times.mean() - LIFT.mean_duration_s() / pace) <= 4 * times.std() / 4000**0.5 + 1e-9
    assert np.all(times == times[0]) is np.bool_(switch == "none")


@pytest.mark.parametrize("body", [{"pace": 0.6}, Asked(0.6)])
@pytest.mark.parametrize("switch", ["between_only", "shuffled"])
def test_where_workers_keep_their_own_means_a_pace_is_in_them_as_in_full(switch, body):
    changed = switched(LIFT, switch)
    full, worker = (model.draw_worker(np.random.default_rng(3), body) for model in (LIFT, changed))
    assert changed.mean_duration_s(worker) == LIFT.mean_duration_s(full)
    assert LIFT.mean_duration_s(full) == pytest.approx(LIFT.mean_duration_s() / 0.6, rel=0.05)
    times = changed.sample(64, np.random.default_rng(4), worker=worker).duration_s
    own = LIFT.sample(64, np.random.default_rng(4), worker=full).duration_s
    assert np.array_equal(times, own) if switch == "shuffled" else np.all(times == LIFT.mean_duration_s(full))


@pytest.mark.parametrize("body", [None, {}, {"pace": None}, Asked(height_m=1.7)])
@pytest.mark.parametrize("switch", ["none", "within_only"])
def test_who_is_asked_for_no_pace_has_the_population_s_mean_bit_for_bit(switch, body):
    changed = switched(LIFT, switch)
    assert changed.mean_duration_s(changed.draw_worker(np.random.default_rng(3), body)) == LIFT.mean_duration_s()


@pytest.mark.parametrize("switch", ["none", "within_only"])
def test_a_pace_changes_nothing_where_the_model_does_not_read_it(switch):
    changed = switched(Lognormal(20.0, 0.4, 0.5), switch)
    assert changed.mean_duration_s(changed.draw_worker(np.random.default_rng(3), {"pace": 0.6})) == 20.0


@pytest.mark.parametrize("switch", ["none", "between_only", "within_only"])
def test_bodies_are_those_of_the_same_draw_at_the_new_pace(switch):
    changed, effect = switched(LIFT, switch), LIFT.draw_worker(np.random.default_rng(2))
    own, other = (model.sample(4, np.random.default_rng(3), worker=effect) for model in (LIFT, changed))
    assert np.array_equal(own.scores, other.scores)
    assert np.allclose(own[1].positions_m(n_times=9), other[1].positions_m(n_times=9), rtol=0, atol=1e-12)
    assert np.allclose(own.mark_s / own.duration_s[:, None], other.mark_s / other.duration_s[:, None], rtol=1e-12)
    assert not np.allclose(own.duration_s, other.duration_s)


@pytest.mark.parametrize("switch", SWITCHES)
def test_where_workers_do_not_differ_all_spread_counts_as_within(switch):
    model = Exponential(20.0)
    plain = model.sample(64, np.random.default_rng(5)).duration_s
    changed = switched(model, switch)
    assert changed.draw_worker(np.random.default_rng(0)) is None
    times = changed.sample(64, np.random.default_rng(5)).duration_s
    assert np.array_equal(times, plain if switch in ("within_only", "shuffled") else np.full(64, 20.0))


@pytest.mark.parametrize("switch", SWITCHES)
def test_a_trace_is_its_mean_or_stays_a_trace(switch):
    changed = switched(TRACE, switch)
    if switch in ("within_only", "shuffled"):
        assert changed is TRACE
    else:
        assert not changed.by_index
        assert changed.sample(5, np.random.default_rng(0)).duration_s.tolist() == [3.0] * 5
    assert changed.mean_duration_s() == 3.0


@pytest.mark.parametrize("switch", SWITCHES)
def test_what_a_model_has_beyond_the_seam_is_found_through_the_switch(switch):
    changed = switched(LIFT, switch)
    assert changed.report is LIFT.report and changed.mark_names == LIFT.mark_names
    assert changed.skeleton is LIFT.skeleton
    assert not hasattr(changed, "no_such_thing")


def test_a_known_worker_of_the_emulator_can_be_named():
    changed, name = switched(LIFT, "between_only"), LIFT.workers[0]
    times = changed.sample(3, np.random.default_rng(0), worker=name).duration_s
    assert times.tolist() == [LIFT.mean_duration_s(name)] * 3


@pytest.mark.parametrize("switch", SWITCHES)
def test_a_condition_is_refused(switch):
    with pytest.raises(ValueError, match="switched variability knows no condition"):
        switched(LIFT, switch).sample(3, np.random.default_rng(0), condition={"duration_s": 2.0})


class Hand:
    """The least that the seam asks for: times with a mark, people who differ, no rows, no body."""

    skeleton = None

    def mean_duration_s(self, worker=None):
        return 4.0 if worker is None else 4.0 * worker

    def draw_worker(self, rng, body=None):
        return float(rng.uniform(0.5, 1.5))

    def sample(self, n, rng, *, worker=None, condition=None):
        own = rng.uniform(0.5, 1.5, n) if worker is None else worker
        drawn = Hand()
        drawn.duration_s = 4.0 * own * rng.uniform(0.9, 1.1, n)
        drawn.mark_s, drawn.scores = drawn.duration_s[:, None] / 2, np.empty((n, 0))
        return drawn


@pytest.mark.parametrize(("switch", "expected"), [("none", 4.0), ("between_only", 5.0), ("within_only", None)])
def test_any_model_that_satisfies_the_seam_can_be_switched(switch, expected):
    changed, plain = switched(Hand(), switch), Hand().sample(6, np.random.default_rng(0), worker=1.25)
    times = changed.sample(6, np.random.default_rng(0), worker=1.25)
    assert np.allclose(times.duration_s, plain.duration_s / 1.25 if expected is None else expected, rtol=1e-12)
    assert np.allclose(times.mark_s[:, 0], times.duration_s / 2, rtol=1e-12)
    shuffled = switched(Hand(), "shuffled").sample(6, np.random.default_rng(0), worker=1.25)
    assert np.array_equal(shuffled.duration_s, plain.duration_s) and np.array_equal(shuffled.mark_s, plain.mark_s)


@pytest.mark.parametrize("switch", SWITCHES)
def test_a_worker_of_one_s_own_simpy_model_can_have_switched_tasks(switch):
    changed = switched(LIFT, switch)
    worker = Worker(simpy.Environment(), "ana", {"lift": changed}, seed=3)
    lifted = worker.env.run(worker.perform("lift"))
    effect = worker_effect(changed, "lift", "ana", 3, 0)
    block = changed.sample(64, stream(3, 0, "duration", "lift", "ana", 0), worker=effect)
    assert lifted.drawn.duration_s == block.duration_s[0]
    times_s = np.linspace(0, lifted.drawn.duration_s, 9)
    assert np.allclose(lifted.positions_m(n_times=9), block.positions_m(times_s=times_s)[0], rtol=0, atol=1e-8)


@pytest.mark.parametrize("switch", SWITCHES)
def test_what_the_recorded_people_lean_to_reaches_the_model_through_the_switch(switch):
    changed = switched(LIFT, switch)
    own, through = (worker_effect(model, "lift", "ana", 3, 0) for model in (LIFT, changed))
    assert np.array_equal(own.z, getattr(through, "effect", through).z)
