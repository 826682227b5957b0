"""What holds for every time model, whatever its family.

From the words of the language to the model: every kind, with the mean it says itself.

A movement that takes another time is the same movement, at the same shares of it.
"""

from math import expm1, log, log1p, sqrt
from pathlib import Path

import numpy as np
import pytest

from opsim.external_worker import library_model
from opsim.performance import Drawn
from opsim.scenario.read import scenarios_in
from opsim.subjects.tasks.variability import retimed
from opsim.tasks import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Fixed,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Recorded,
    Triangular,
    Uniform,
    Weibull,
    task_model,
)
from tests.opsim.subjects.tasks.models import CV_OF, MODELS, SHARED


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


GOOD = (Path(__file__).parents[2] / "scenario/good.yaml").read_text(encoding="utf-8")
KINDS = [
    ("fixed: 3 s", Fixed(3.0), "fixed, 3 s"),
    ("dist: exponential, mean: 3 s", Exponential(3.0), "exponential, mean 3 s"),
    ("dist: erlang, mean: 3 s, k: 2", Erlang(3.0, 2), "erlang of 2, mean 3 s"),
    ("dist: geometric, mean: 3 s, step: 1 s", Geometric(3.0, 1.0), "geometric, mean 3 s in steps of 1 s"),
    ("dist: lognormal, mean: 3 s, cv: 0.2", Lognormal(3.0, 0.2), "lognormal, mean 3 s, cv 0.2"),
    ("dist: gamma, mean: 3 s, cv: 0", Fixed(3.0), "gamma, mean 3 s, cv 0"),
    (
        "dist: gamma, mean: 3 s, cv: 0.2, between_share: 0.4",
        Gamma(3.0, 0.2, 0.4),
        "gamma, mean 3 s, cv 0.2, 40% of it between workers",
    ),
    ("dist: weibull, mean: 3 s, cv: 0.2", Weibull(3.0, 0.2), "weibull, mean 3 s, cv 0.2"),
    ("dist: hyperexponential, mean: 3 s, cv: 2", Hyperexponential(3.0, 2.0), "hyperexponential, mean 3 s, cv 2"),
    ("dist: normal, mean: 3 s, sd: 0.6 s", Normal(3.0, 0.6 / 3), "normal, mean 3 s, cv 0.2, none below 0 s"),
    (
        "dist: normal, mean: 3 s, cv: 0.2, low: 1 s",
        Normal(3.0, 0.2, 0.0, 1.0),
        "normal, mean 3 s, cv 0.2, none below 1 s",
    ),
    ("dist: normal, mean: 3 s, sd: 0 s", Fixed(3.0), "normal, mean 3 s, cv 0, none below 0 s"),
    (
        "dist: beta, low: 1 s, high: 5 s, mean: 3 s, cv: 0.2",
        Beta(3.0, 0.2, 0.0, 1.0, 5.0),
        "beta, 1 to 5 s, mean 3 s, cv 0.2",
    ),
    ("dist: uniform, low: 1 s, high: 5 s", Uniform(1.0, 5.0), "uniform, 1 to 5 s"),
    (
        "dist: triangular, low: 1 s, mode: 2 s, high: 5 s",
        Triangular(1.0, 2.0, 5.0),
        "triangular, 1 to 5 s, most likely 2 s",
    ),
    ("dist: empirical, values: [2 s, 4 s]", Empirical((2.0, 4.0)), "empirical, 2 values, mean 3 s"),
    ("recorded: times.csv", Recorded((2.0, 4.0)), "recorded, times.csv (resample)"),
    ("recorded: times.csv, by: trace", Recorded((2.0, 4.0), by_index=True), "recorded, times.csv (trace)"),
    ("recorded: times.csv, by: smooth", Empirical((2.0, 4.0)), "recorded, times.csv (smooth)"),
]


@pytest.mark.parametrize(("said", "model", "words"), KINDS, ids=[kind[0] for kind in KINDS])
def test_a_task_gets_the_model_it_says(tmp_path, said, model, words):
    (tmp_path / "times.csv").write_text("2\n4\n")
    text = GOOD.replace("fixed: 3 s", said)
    loaded = scenarios_in(text.encode(), tmp_path / "line.yaml")["base"]
    task = loaded.scenario.tasks["lift"]
    assert task_model(task, loaded) == model
    assert task.words == words
    assert getattr(task, "mean_s", model.mean_duration_s()) == model.mean_duration_s()


LIFT = library_model("bench_work/lift")
BODY = LIFT.sample(4, np.random.default_rng(1))
LONGER = retimed(BODY, BODY.duration_s * np.array([1.0, 2.0, 0.5, 3.0]))
DECODED = ("directions", "positions_m", "root_m")


@pytest.mark.parametrize("what", DECODED)
def test_at_shares_of_its_time_a_stretched_movement_is_the_movement(what):
    share = np.linspace(0, 1, 7)
    stretched = getattr(LONGER, what)(times_s=LONGER.duration_s[:, None] * share)
    assert np.allclose(stretched, getattr(BODY, what)(times_s=BODY.duration_s[:, None] * share), rtol=0, atol=1e-10)
    assert np.array_equal(getattr(LONGER, what)(n_times=7), getattr(BODY, what)(n_times=7))


@pytest.mark.parametrize("what", DECODED)
def test_the_same_times_for_all_are_times_of_the_new_duration(what):
    at_s = np.array([0.0, 0.4, 1.0])
    together = getattr(LONGER, what)(times_s=at_s)
    for row, stretch in enumerate([1.0, 2.0, 0.5, 3.0]):
        alone = getattr(BODY[row], what)(times_s=at_s / stretch)[0]
        assert np.allclose(together[row], alone, rtol=0, atol=1e-10)


def test_marks_keep_their_share_and_what_is_not_time_stays():
    assert BODY.mark_s.shape[1] > 0
    assert np.allclose(LONGER.mark_s / LONGER.duration_s[:, None], BODY.mark_s / BODY.duration_s[:, None], rtol=1e-12)
    assert LONGER.skeleton is BODY.skeleton
    assert np.array_equal(LONGER[1:].bone_length_m, BODY[1:].bone_length_m)
    assert not hasattr(retimed(Whole(BODY), LONGER.duration_s), "bone_length_m")
    assert np.array_equal(LONGER.scores, BODY.scores)


@pytest.mark.parametrize("index", [2, -1, slice(1, 3), np.array([3, 0])], ids=str)
def test_rows_can_be_taken_where_the_body_has_rows(index):
    rows = np.atleast_1d(np.arange(4)[index])
    some = LONGER[index]
    assert len(some) == len(rows)
    assert np.array_equal(some.duration_s, LONGER.duration_s[rows])
    assert np.allclose(some.mark_s, LONGER.mark_s[rows], rtol=1e-12)
    assert np.allclose(some.positions_m(n_times=5), LONGER.positions_m(n_times=5)[rows], rtol=0, atol=1e-10)


class Whole:
    """Performances without rows: the seam does not ask for them."""

    def __init__(self, block):
        self.duration_s, self.mark_s, self.positions_m = block.duration_s, block.mark_s, block.positions_m


def test_a_body_without_rows_is_decoded_whole():
    whole = retimed(Whole(BODY), LONGER.duration_s)
    assert not hasattr(type(whole), "__getitem__")
    at_s = np.linspace(0, 2, 5)
    cut = Drawn(LONGER, 1).decoded("positions_m", times_s=at_s)
    assert np.allclose(Drawn(whole, 1).decoded("positions_m", times_s=at_s), cut, rtol=0, atol=1e-10)


def test_a_stretched_time_without_a_body_has_no_postures():
    longer = retimed(Fixed(2.0).sample(3, np.random.default_rng(0)), np.full(3, 5.0))
    assert longer.mark_s.shape == longer.scores.shape == (3, 0)
    with pytest.raises(ValueError, match="no postures"):
        longer.positions_m()
