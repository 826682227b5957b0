"""Rows that the tests of covariates share, and the naive twins of partial least squares."""

import numpy as np


def formula_case(n=9):
    """(x (n, 4), y (n, 2)) by a formula, so that a peer's answers can be frozen."""
    i = np.arange(1, n + 1)[:, None]
    x = np.hstack([np.sin(1.3 * i) + 0.2 * i, 3 * np.cos(0.7 * i) + 0.5 * i, ((7 * i) % 11) / 4.0, (i * i) % 5 * 1.0])
    return x, np.hstack([0.5 * x[:, :1] - 0.3 * x[:, 1:2] + 0.2 * np.sin(5 * i), np.cos(2.1 * i) + 0.1 * x[:, 3:]])


def people(n, rng):
    """(n, 4) height, mass, age and pace; height and mass correlated, all standard normal but the pace."""
    height, mass, age, pace = rng.standard_normal((4, n))
    return np.column_stack([height, 0.6 * height + 0.8 * mass, age, np.exp(0.1 * pace)])


NAMES = ("height_m", "mass_kg", "age_years", "pace")


def naive_pls1(x, y, n_components):
    """NIPALS for one response: (intercept, slope), X standardised and deflated component by component."""
    centre, spread, middle = x.mean(0), x.std(0), y.mean()
    left, rest = (x - centre) / spread, y - middle
    weights, loadings, shares = [], [], []
    for _ in range(n_components):
        weight = left.T @ rest
        weight /= np.linalg.norm(weight)
        score = left @ weight
        load = left.T @ score / (score @ score)
        share = rest @ score / (score @ score)
        left, rest = left - np.outer(score, load), rest - share * score
        weights.append(weight)
        loadings.append(load)
        shares.append(share)
    w, p = np.array(weights).T, np.array(loadings).T
    slope = (w @ np.linalg.solve(p.T @ w, np.array(shares)) if n_components else np.zeros(x.shape[1])) / spread
    return middle - centre @ slope, slope


def naive_left_out_r2(x, y, groups, n_components):
    """1 - squared errors of the rows left out person by person over those of the others' mean."""
    left, plain = 0.0, 0.0
    for g in np.unique(groups):
        own = groups == g
        intercept, slope = naive_pls1(x[~own], y[~own], n_components)
        left += np.sum((y[own] - intercept - x[own] @ slope) ** 2)
        plain += np.sum((y[own] - y[~own].mean()) ** 2)
    return 1 - left / plain
