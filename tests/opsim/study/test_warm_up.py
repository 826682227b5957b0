import numpy as np
import pytest
from plans import line, loaded, queue

from opsim.log import CREATE, FINISH, JOIN, SCRAP, event_log, row
from opsim.study import run_scenario
from opsim.study.long_run.warm_up import finished_per_h, jobs_inside, mser, suggested_warm_up


def naive_mser(series, batch=5):
    means = [np.mean(series[i : i + batch]) for i in range(0, len(series) // batch * batch, batch)]
    score = [np.sum((means[d:] - np.mean(means[d:])) ** 2) / (len(means) - d) ** 2 for d in range(len(means) - 4)]
    best = int(np.argmin(score))
    return None if best > len(means) / 2 else best * batch


def test_a_step_is_cut_off_where_it_ends():
    assert mser(np.r_[np.full(60, 9.0), np.tile([1.0, 2.0, 1.5, 1.0, 2.0], 60) + np.repeat(np.arange(60) % 2, 5)]) == 60


def test_a_steady_series_needs_no_warm_up():
    assert mser(np.full(200, 3.0)) == 0
    assert mser(np.tile(np.arange(10.0), 40)) == 0


def test_a_series_that_never_settles_is_refused():
    assert mser(np.r_[np.arange(300.0), np.full(100, 299.0) + np.arange(100) % 2]) is None


@pytest.mark.parametrize("seed", range(20))
def test_it_is_the_naive_statistic(seed):
    rng = np.random.default_rng(seed)
    series = 1e6 + np.exp(-np.arange(403) / rng.uniform(5, 80)) * rng.normal(0, 30) + rng.normal(size=403)
    assert mser(series) == naive_mser(series)


def test_cutting_brings_the_mean_of_an_autoregression_nearer_to_the_truth():
    """AR(1), 300 series of 1,000, begun 17 standard deviations off: squared error about 0.26 whole, 0.10 at best."""
    rng = np.random.default_rng(7)
    state, values = np.full(300, 40.0), []
    for _ in range(1000):
        state = 0.9 * state + rng.normal(size=300)
        values.append(state)
    series = np.array(values).T
    cut = np.array([one[mser(one) :].mean() for one in series])
    assert np.mean(cut**2) < 0.6 * np.mean(series.mean(axis=1) ** 2)


def test_too_few_or_unknown_values_are_refused():
    with pytest.raises(ValueError, match="too few"):
        mser(np.ones(99))
    with pytest.raises(ValueError, match="not finite"):
        mser(np.r_[np.ones(200), np.nan])


def test_series_of_a_log_are_those_counted_by_hand():
    rows = [row(CREATE, 0, 0, job=0), row(CREATE, 10, 10, job=1), row(FINISH, 25, 25, job=0)]
    names = dict.fromkeys(("worker", "station", "source", "product", "operation", "task"), ("a",))
    log = event_log(rows, 40.0, names)
    edges = np.array([0.0, 20.0, 40.0])
    assert jobs_inside(log, edges) == pytest.approx([1.5, 1.25])
    assert finished_per_h(log, edges) == pytest.approx([0, 180])


def test_parts_that_are_joined_and_jobs_that_are_scrapped_are_inside_no_longer():
    rows = [*(row(CREATE, 0, 0, job=job) for job in range(3)), row(JOIN, 10, 10, job=0), row(SCRAP, 20, 20, job=1)]
    names = dict.fromkeys(("worker", "station", "source", "product", "operation", "task"), ("a",))
    assert jobs_inside(event_log(rows, 40.0, names), np.array([0.0, 20.0, 40.0])) == pytest.approx([2.5, 1.0])


def test_the_series_of_a_queue_settles_and_its_steady_mean_is_that_of_theory(tmp_path):
    text = queue(horizon="4000 s", warm_up="0 s", every="2 s").replace("seed: 1", "seed: 3, replications: 5")
    inside, out = suggested_warm_up(run_scenario(loaded(text), folder=tmp_path, processes=1))
    assert inside.until_s is not None and inside.until_s <= 1000
    assert inside.series.mean() == pytest.approx(1.0, rel=0.1)  # load 1/2: L = 1
    assert inside.series.size == 500 and inside.slice_s == 8
    assert out.until_s is not None and out.series.mean() == pytest.approx(1800, rel=0.05)


def test_a_line_that_has_to_fill_first_is_cut_while_it_fills(tmp_path):
    """The bottleneck is last: 30 places before it fill at the difference of the rates, 1/1 - 1/1.5 a second: 90 s."""
    text = line(2, 30, horizon="3000 s", warm_up="0 s").replace("seed: 1", "seed: 1, replications: 5")
    text = text.replace("t2: {dist: exponential, mean: 1 s}", "t2: {dist: exponential, mean: 1.5 s}")
    inside, _ = suggested_warm_up(run_scenario(loaded(text), folder=tmp_path, processes=1))
    assert 60 <= inside.until_s <= 240
