"""What holds for every time model, whatever its family."""

from math import expm1, log, log1p, sqrt

import numpy as np
import pytest

from opsim.tasks import Fixed, Gamma, Lognormal, Recorded
from tests.opsim.tasks.models import CV_OF, MODELS, SHARED


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_mean_and_cv_are_those_asked_for(model):
    n, cv = 200_000, CV_OF[model]
    times = model.sample(n, np.random.default_rng(1)).duration_s
    assert model.mean_duration_s() == pytest.approx(20.0, rel=1e-15)
    assert times.mean() == pytest.approx(20.0, abs=4 * 20 * cv / n**0.5 + 1e-9)
    assert times.std() / times.mean() == pytest.approx(cv, rel=0.03, abs=1e-9)


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_the_same_generator_gives_the_same_performances(model):
    one, two = (model.sample(64, np.random.default_rng(7)) for _ in range(2))
    assert np.array_equal(one.duration_s, two.duration_s)
    assert one.duration_s.shape == (64,) and np.all(one.duration_s > 0)
    assert one.mark_s.shape == one.scores.shape == (64, 0)
    assert one.skeleton is None


@pytest.mark.parametrize("model", SHARED, ids=repr)
def test_between_workers_lies_the_share_asked_for(model):
    """Means of workers are lognormal with log variance share ln(1 + cv^2); within, the rest of the variance."""
    rng = np.random.default_rng(3)
    workers = np.array([model.draw_worker(rng) for _ in range(20_000)])
    means = np.array([model.mean_duration_s(worker) for worker in workers])
    between = model.between_share * log1p(model.cv**2)
    assert np.log(means).var() == pytest.approx(between, rel=4 * sqrt(2 / 20_000))
    assert means.mean() == pytest.approx(20.0, rel=4 * sqrt(expm1(between) / 20_000))


@pytest.mark.parametrize("model", SHARED, ids=repr)
def test_a_worker_s_times_have_his_mean_and_the_cv_within(model):
    rng = np.random.default_rng(5)
    for _ in range(3):
        worker = model.draw_worker(rng)
        times = model.sample(100_000, rng, worker=worker).duration_s
        assert times.mean() == pytest.approx(
            model.mean_duration_s(worker), rel=4 * model.within_cv / 100_000**0.5 + 1e-9
        )
        assert times.std() / times.mean() == pytest.approx(model.within_cv, rel=0.03, abs=1e-9)


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


def test_all_between_workers_means_that_each_has_one_time():
    model = Gamma(20.0, 0.3, 1.0)
    worker = model.draw_worker(np.random.default_rng(2))
    times = model.sample(10, np.random.default_rng(0), worker=worker).duration_s
    assert np.allclose(times, model.mean_duration_s(worker), rtol=1e-14)


def test_without_a_between_share_workers_do_not_differ():
    for model in (Lognormal(20.0, 0.4), Fixed(1.0), Gamma(20.0, 0.4)):
        assert model.draw_worker(np.random.default_rng(0)) is None


def test_no_time_is_zero_however_skewed():
    assert np.all(Gamma(1.0, 10.0).sample(10_000, np.random.default_rng(0)).duration_s > 0)


def test_a_time_without_a_body_says_so():
    with pytest.raises(ValueError, match="no postures"):
        Fixed(1.0).sample(1, np.random.default_rng(0)).directions()
    with pytest.raises(ValueError, match="knows no condition"):
        Fixed(1.0).sample(1, np.random.default_rng(0), condition={"pace": 1})


def test_a_trace_gives_performance_k_its_time_and_begins_again():
    trace = Recorded((1.0, 2.0, 3.0), by_index=True)
    assert trace.at(np.arange(7)).tolist() == [1, 2, 3, 1, 2, 3, 1]
    assert trace.sample(4, np.random.default_rng(0)).duration_s.tolist() == [1, 2, 3, 1]


def test_log_time_of_a_lognormal_worker_is_normal_about_his_own_mean():
    model = Lognormal(20.0, 0.4, 0.5)
    logs = np.log(model.sample(50_000, np.random.default_rng(8), worker=0.3).duration_s)
    assert logs.mean() == pytest.approx(log(20.0) - log1p(0.16) / 2 + 0.3, abs=4 * 0.28 / 50_000**0.5)
