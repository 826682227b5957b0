import numpy as np
import pytest

from emulator.covariates.validation import icc_2_1, icc_of_the_paper, rms, sem

CURVE = 30 * np.sin(np.linspace(0, 6, 80))


def naive_icc_2_1(pair):
    """Shrout & Fleiss (1979), table 1 and the formula of ICC(2,1), from a table (n targets, k judges)."""
    n, k = pair.shape
    grand = pair.mean()
    rows = k * sum((row.mean() - grand) ** 2 for row in pair) / (n - 1)
    columns = n * sum((column.mean() - grand) ** 2 for column in pair.T) / (k - 1)
    total = sum((value - grand) ** 2 for value in pair.ravel())
    rest = (total - rows * (n - 1) - columns * (k - 1)) / ((n - 1) * (k - 1))
    return (rows - rest) / (rows + (k - 1) * rest + k * (columns - rest) / n)


def test_the_naive_twin_gives_the_published_example():
    """Shrout & Fleiss, table 2: six targets, four judges, ICC(2,1) = 0.29."""
    judged = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], float)
    assert naive_icc_2_1(judged) == pytest.approx(0.29, abs=0.005)


def test_it_is_the_naive_twin_curve_by_curve():
    rng = np.random.default_rng(0)
    true = rng.standard_normal((4, 3, 25))
    foretold = 0.7 * true + 0.5 * rng.standard_normal(true.shape) + 0.4
    found = icc_2_1(true, foretold)
    for at in np.ndindex(4, 3):
        assert found[at] == pytest.approx(naive_icc_2_1(np.stack([true[at], foretold[at]], 1)), abs=1e-12)


def test_a_perfect_forecast_is_one_where_the_paper_s_formula_says_a_half():
    assert icc_2_1(CURVE, CURVE) == pytest.approx(1.0)
    assert icc_of_the_paper(CURVE, CURVE) == pytest.approx(0.5)
    assert icc_of_the_paper(CURVE, CURVE[::-1]) == pytest.approx(0.5)
    assert sem(CURVE, CURVE, icc_2_1(CURVE, CURVE)) == pytest.approx(0.0, abs=1e-6)


def test_a_constant_shift_counts_against_it():
    shift, spread = 10.0, CURVE.var(ddof=1)
    assert icc_2_1(CURVE, CURVE + shift) == pytest.approx(2 * spread / (2 * spread + shift**2))


def test_two_constants_that_differ_agree_in_nothing_and_sem_says_by_how_much():
    still = np.zeros(50)
    icc = icc_2_1(still, still + 4.0)
    assert icc == pytest.approx(0.0)
    assert sem(still, still + 4.0, icc) == pytest.approx(2.0, rel=0.02)
    assert np.isnan(icc_2_1(still, still))
    assert sem(still, still, icc_2_1(still, still)) == 0.0


def test_moments_without_an_angle_are_left_out():
    other = CURVE + np.cos(np.linspace(0, 9, 80))
    gapped = CURVE.copy()
    gapped[10:30] = np.nan
    there = np.isfinite(gapped)
    assert icc_2_1(gapped, other) == pytest.approx(icc_2_1(CURVE[there], other[there]))
    assert rms(gapped, other) == pytest.approx(np.sqrt(np.mean((CURVE - other)[there] ** 2)))
    assert icc_of_the_paper(gapped, other) == pytest.approx(icc_of_the_paper(CURVE[there], other[there]))
    nothing = np.full(80, np.nan)
    assert np.isnan(icc_2_1(nothing, other)) and np.isnan(rms(nothing, other))
