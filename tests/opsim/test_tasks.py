import numpy as np
import pytest

from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, Recorded, Uniform

MODELS = [
    Fixed(20.0),
    Exponential(20.0),
    Lognormal(20.0, 0.3),
    Lognormal(20.0, 0.3, 0.5),
    Lognormal(20.0, 0.3, 1.0),
    Gamma(20.0, 0.3),
    Gamma(20.0, 2.0),
    Uniform(15.0, 25.0),
    Recorded((10.0, 20.0, 30.0)),
]
CV = [0.0, 1.0, 0.3, 0.3, 0.3, 0.3, 2.0, 10 / 12**0.5 / 20, 200**0.5 / 3**0.5 / 20]


@pytest.mark.parametrize(("model", "cv"), list(zip(MODELS, CV)))
def test_mean_and_cv_are_those_asked_for(model, cv):
    n = 200_000
    times = model.sample(n, np.random.default_rng(1)).duration_s
    assert model.mean_duration_s() == 20.0
    assert times.mean() == pytest.approx(20.0, abs=4 * 20 * cv / n**0.5 + 1e-9)
    assert times.std() / times.mean() == pytest.approx(cv, rel=0.03, abs=1e-9)


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_the_same_generator_gives_the_same_performances(model):
    one, two = (model.sample(64, np.random.default_rng(7)) for _ in range(2))
    assert np.array_equal(one.duration_s, two.duration_s)
    assert one.duration_s.shape == (64,) and np.all(one.duration_s > 0)
    assert one.mark_s.shape == one.scores.shape == (64, 0)
    assert one.skeleton is None


def test_no_time_is_zero_however_skewed():
    assert np.all(Gamma(1.0, 10.0).sample(10_000, np.random.default_rng(0)).duration_s > 0)


@pytest.mark.parametrize("share", [0.25, 0.5, 1.0])
def test_variance_of_log_time_splits_into_between_and_within_workers(share):
    model, rng = Lognormal(20.0, 0.4, share), np.random.default_rng(3)
    workers = [model.draw_worker(rng) for _ in range(4000)]
    logs = np.log([model.sample(16, rng, worker=worker).duration_s for worker in workers])
    total = np.log1p(0.4**2)
    within = logs.var(axis=1, ddof=1).mean()
    between = logs.mean(axis=1).var(ddof=1) - within / 16
    assert between == pytest.approx(share * total, rel=0.1)
    assert within == pytest.approx((1 - share) * total, rel=0.03, abs=1e-12)
    assert np.exp(logs).mean() == pytest.approx(20.0, rel=4 * 0.4 * share**0.5 / 4000**0.5 + 0.01)


def test_a_worker_s_mean_is_the_mean_of_his_times():
    model, rng = Lognormal(20.0, 0.4, 0.5), np.random.default_rng(5)
    for _ in range(5):
        worker = model.draw_worker(rng)
        times = model.sample(100_000, rng, worker=worker).duration_s
        assert times.mean() == pytest.approx(model.mean_duration_s(worker), rel=0.005)


def test_without_a_between_share_workers_do_not_differ():
    for model in (Lognormal(20.0, 0.4), Fixed(1.0), Gamma(20.0, 0.4)):
        assert model.draw_worker(np.random.default_rng(0)) is None


def test_a_trace_gives_performance_k_its_time_and_begins_again():
    trace = Recorded((1.0, 2.0, 3.0), by_index=True)
    assert trace.at(np.arange(7)).tolist() == [1, 2, 3, 1, 2, 3, 1]
    assert trace.sample(4, np.random.default_rng(0)).duration_s.tolist() == [1, 2, 3, 1]


def test_a_time_without_a_body_says_so():
    with pytest.raises(ValueError, match="no postures"):
        Fixed(1.0).sample(1, np.random.default_rng(0)).directions()
    with pytest.raises(ValueError, match="knows no condition"):
        Fixed(1.0).sample(1, np.random.default_rng(0), condition={"pace": 1})
