import numpy as np
import pytest
from scipy.stats import binom

from emulator.covariates.regression import Folds, best_r2, common_share, kept, noise_p, noise_r2, p_of_noise
from tests.emulator.covariates.cases import people


@pytest.mark.parametrize("n, n_components", [(4, 1), (6, 1), (18, 4)])
def test_noise_passes_the_bar_as_often_as_it_says(n, n_components):
    """20 draws of people, 200 noise scores each: 5 % of 4,000, within a third (the bar itself is drawn)."""
    rng, below = np.random.default_rng(0), []
    for _ in range(20):
        folds = Folds.of(people(n, rng), np.arange(n))
        r2 = best_r2(folds, rng.standard_normal((n, 200)), n_components)
        below.append(p_of_noise(r2, noise_r2(folds, n_components)) < 0.05)
    assert 0.035 < np.mean(below) < 0.065


def test_the_tail_beyond_the_draws_is_that_of_noise():
    """The p of an R^2 that one noise score in 2,000 reaches, from 1,000 draws: right within a factor of 3."""
    rng = np.random.default_rng(7)
    folds = Folds.of(people(18, rng), np.arange(18))
    many = np.concatenate([best_r2(folds, rng.standard_normal((18, 1000)), 4) for _ in range(40)])
    p = p_of_noise(np.quantile(many, [1 - 1 / 2000]), noise_r2(folds, 4))[0]
    assert 1 / 6000 < p < 3 / 2000


def test_positive_r2_alone_would_keep_noise_several_times_as_often():
    rng = np.random.default_rng(1)
    folds = Folds.of(people(8, rng), np.arange(8))
    assert np.mean(best_r2(folds, rng.standard_normal((8, 500)), 2) > 0) > 0.15


@pytest.mark.parametrize("common", [1.0, 0.6, 0.0])
def test_scores_of_several_rows_a_person_are_not_taken_for_more_people(common):
    """Height, mass, age and pace of 6 people with 8 rows each: of noise with this much in common at most 8 % pass."""
    rng, passed = np.random.default_rng(2), []
    groups = np.repeat(np.arange(6), 8)
    for _ in range(20):
        folds = Folds.of(people(6, rng)[groups], groups)
        own = rng.standard_normal((6, 100))[groups]
        y = np.sqrt(common) * own + np.sqrt(1 - common) * rng.standard_normal(own.shape)
        passed.append(noise_p(folds, y, best_r2(folds, y, 1), 1) < 0.05)
    assert np.mean(passed) < 0.08


def test_the_common_share_is_the_one_put_in():
    rng, groups = np.random.default_rng(6), np.repeat(np.arange(200), [4, 6] * 100)
    own = rng.standard_normal((200, 3))[groups] * np.sqrt([0.0, 0.5, 1.0])
    y = own + rng.standard_normal(own.shape) * np.sqrt([1.0, 0.5, 0.0])
    assert np.allclose(common_share(y, groups), [0.0, 0.5, 1.0], atol=0.06)


def test_the_noise_is_always_the_same():
    folds = Folds.of(people(7, np.random.default_rng(3)), np.arange(7))
    assert noise_r2(folds, 1).tobytes() == noise_r2(folds, 1).tobytes()


def test_each_asks_the_level_score_by_score_and_fdr_counts_how_many_were_asked():
    p = np.array([0.001, 0.04, 0.012, 0.6, np.nan])
    assert kept(p, 0.95, "each").tolist() == [True, True, True, False, False]
    assert kept(p, 0.95, "fdr").tolist() == [True, False, True, False, False]


def test_families_are_corrected_each_for_itself():
    p = np.array([0.04, 0.5, 0.6, 0.7])
    assert not kept(p, 0.95, "fdr").any()
    assert kept(p, 0.95, "fdr", np.array([0, 1, 1, 1])).tolist() == [True, False, False, False]


def test_with_nothing_to_find_fdr_keeps_nothing_in_19_of_20_fits():
    rng = np.random.default_rng(4)
    any_kept = sum(kept(rng.random(60), 0.95, "fdr").any() for _ in range(400))
    assert any_kept <= binom.ppf(0.999, 400, 0.05)
