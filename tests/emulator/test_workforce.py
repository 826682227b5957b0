import numpy as np
import pytest

from emulator.people.variance_components import anova, intraclass_correlation
from emulator.people.workers import Workforce, shrinkages

# Shrout & Fleiss (1979), table 2: six targets, four judges. Their table 4: ICC(1,1) = .17.
RATINGS = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7.0]])
TARGETS = np.repeat(np.arange(6), 4)


def two_level(n_workers, n_each, between, within, seed=0, k=1):
    rng = np.random.default_rng(seed)
    index = np.repeat(np.arange(n_workers), n_each)
    return np.sqrt(between) * rng.normal(size=(n_workers, k))[index] + np.sqrt(within) * rng.normal(
        size=(len(index), k)
    ), index


def test_icc_of_shrout_and_fleiss_is_found():
    icc, low, high = intraclass_correlation(RATINGS.ravel(), TARGETS)
    assert round(icc, 2) == 0.17
    assert low < 0 < icc < high < 1


def test_mean_squares_are_those_of_shrout_and_fleiss():
    parts = anova(RATINGS.reshape(-1, 1), TARGETS)
    assert np.round([parts.between_square[0], parts.within_square[0]], 2).tolist() == [11.24, 6.26]


def test_the_effective_size_of_unequal_workers():
    assert np.isclose(anova(np.arange(6.0)[:, None], np.array([0, 0, 0, 1, 1, 2])).size, (6 - (9 + 4 + 1) / 6) / 2)


def test_icc_interval_covers_as_often_as_it_says():
    hits = [
        low < 0.5 < high
        for seed in range(300)
        for _, low, high in [intraclass_correlation(v[:, 0], i) for v, i in [two_level(6, 7, 1, 1, seed)]]
    ]
    assert 0.91 < np.mean(hits) < 0.985


@pytest.mark.parametrize("counts", [(2, 2, 2, 2, 20, 20), (3, 4, 5, 6, 7, 9)])
@pytest.mark.parametrize("icc", [0.2, 0.8, 0.95])
def test_icc_interval_covers_as_often_as_it_says_with_unequal_repetitions(counts, icc):
    """1,000 sets: 0.95 within three standard errors (0.0207). With n0 the first counts had 0.92, 0.89 and 0.875."""
    rng, index = np.random.default_rng(8), np.repeat(np.arange(len(counts)), counts)
    between, within = rng.normal(size=(1000, len(counts))), rng.normal(size=(1000, len(index)))
    sets = np.sqrt(icc) * between[:, index] + np.sqrt(1 - icc) * within
    low, high = np.array([intraclass_correlation(one, index)[1:] for one in sets]).T
    assert np.mean((low < icc) & (icc < high)) == pytest.approx(0.95, abs=0.0207)


def test_icc_interval_of_equal_repetitions_is_that_of_shrout_and_fleiss():
    """Their F(5, 18) = 11.24 / 6.26 over the upper 2.5 % points F(5, 18) = 3.382 and F(18, 5) = 6.362 of the tables."""
    _, low, high = intraclass_correlation(RATINGS.ravel(), TARGETS)
    parts = anova(RATINGS.reshape(-1, 1), TARGETS)
    ratio = parts.between_square[0] / parts.within_square[0]
    expected = [(f - 1) / (f + 3) for f in (ratio / 3.382, ratio * 6.362)]
    assert np.allclose([low, high], expected, atol=2e-4)


def test_numbers_that_no_worker_has_do_not_change_the_icc():
    z, index = two_level(5, 4, 1, 1)
    assert intraclass_correlation(z[:, 0], 2 * index + 1) == intraclass_correlation(z[:, 0], index)


def test_one_worker_has_no_icc():
    assert np.isnan(intraclass_correlation(np.arange(5.0), np.zeros(5, int))).all()


def test_variances_between_and_within_are_recovered():
    z, index = two_level(400, 6, 0.7, 0.3, k=3)
    crew = Workforce.fit(z, index, tuple(f"w{i}" for i in range(400)), 0.2, 0.1)
    assert np.allclose(crew.between.spread**2, 0.7, rtol=0.2)
    assert np.allclose(crew.within.spread**2, 0.3, rtol=0.1)


def test_without_differences_between_workers_their_variance_is_near_zero():
    z, index = two_level(300, 5, 0.0, 1.0, seed=3)
    assert Workforce.fit(z, index, tuple(map(str, range(300))), 0.2, 0.1).between.spread[0] ** 2 < 0.05


def test_shrinkage_goes_as_people_come():
    assert np.allclose(shrinkages(41, 6), (0.2, 0.1))
    between, within = shrinkages(4000, 500)
    assert between < 0.003
    assert within < 0.002


def test_a_known_worker_is_his_mean_drawn_to_that_of_all_by_its_reliability():
    z, index = two_level(50, 4, 1.0, 1.0, seed=1)
    crew = Workforce.fit(z, index, tuple(map(str, range(50))), 0.2, 0.1)
    means = z.reshape(50, 4).mean(1)
    between, within = crew.between.spread[0] ** 2, crew.within.spread[0] ** 2
    expected = means.mean() + between / (between + within / 4) * (means - means.mean())
    assert np.allclose(crew.effects[:, 0], expected)


def test_one_worker_gives_no_worker_effect():
    crew = Workforce.fit(np.random.default_rng(0).normal(size=(9, 2)), np.zeros(9, int), ("w1",), 0.2, 0.1)
    assert not crew.has_worker_effect
    assert np.allclose(crew.between.sample(3, np.random.default_rng(0)), crew.effects[0])


@pytest.mark.parametrize("n_workers", [2, 6])
def test_few_workers_give_a_covariance_of_low_rank_that_can_be_drawn(n_workers):
    z, index = two_level(n_workers, 7, 1.0, 0.2, k=40)
    crew = Workforce.fit(z, index, tuple(map(str, range(n_workers))), 0.2, 0.1)
    assert len(crew.between.factor) == n_workers - 1
    assert np.all(np.isfinite(crew.between.sample(5, np.random.default_rng(0))))
