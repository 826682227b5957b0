"""Gaussian process classification of two classes: Laplace's approximation, its evidence and the evidence's gradient.

Source: Rasmussen & Williams (2006), sec. 3.4, alg. 3.1 (mode), 3.2 (prediction), 5.1 (evidence and gradient), with the
logistic likelihood.

Which contact state belongs to a point of the latent space: Gaussian process classification.

Laplace's approximation (``laplace.py``); lengths and signal by the approximate marginal likelihood. Two states need one
process, more need one each against the rest, whose probabilities are made to sum to 1, as scikit-learn does it. To stay
affordable it takes at most ``at_most`` points: half of them those nearest to a point of another state, since only near
a border does a point tell anything, half evenly through the recording.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from emulator.cyclic.gaussian_process import Factorisations, Hyper, greatest, kernel, start_of

NEWTON_STEPS = 100
SETTLED = 1e-9


@dataclass(frozen=True, eq=False)
class Mode:
    """Where the posterior over the latent values is greatest, and what prediction and evidence need of it."""

    latent: np.ndarray
    """(n,) f at the points."""
    weight: np.ndarray
    """(n,) gradient of log p(class | f): the mean of the latent at x is k(x, points) @ weight."""
    root: np.ndarray
    """(n,) square root of the curvature W."""
    factor: np.ndarray
    """(n, n) lower Cholesky factor of I + W^1/2 K W^1/2."""
    log_evidence: float


def mode_of(
    covariance: np.ndarray, positive: np.ndarray, start: np.ndarray | None = None, count: Factorisations | None = None
) -> Mode:
    """Newton's way to the mode, for covariances (n, n) and classes (n,) bool, from ``start`` (n,) or from 0."""
    from scipy.linalg import cho_solve

    latent = np.zeros(len(positive)) if start is None else start
    best = -np.inf
    for _ in range(NEWTON_STEPS):
        share, root, factor = _curved(covariance, latent, count)
        target = root**2 * latent + positive - share
        pull = target - root * cho_solve((factor, True), root * (covariance @ target))
        latent = covariance @ pull
        value = float(-0.5 * pull @ latent + _log_share(latent, positive))
        if value - best < SETTLED:
            break
        best = value
    share, root, factor = _curved(covariance, latent, count)
    return Mode(latent, positive - share, root, factor, float(value - np.log(factor.diagonal()).sum()))


def log_evidence(
    hyper: Hyper, x: np.ndarray, positive: np.ndarray, start: np.ndarray, count: Factorisations | None = None
) -> tuple[float, np.ndarray, np.ndarray]:
    """log q(class | x), its gradient (p + 2,) by the logarithms of lengths, signal, noise (0: there is none), and f."""
    from scipy.linalg import solve_triangular

    covariance = kernel(x, x, hyper)
    mode = mode_of(covariance, positive, start, count)
    half = solve_triangular(mode.factor, np.diag(mode.root), lower=True)
    precision = half.T @ half
    across = half @ covariance
    share = _logistic(mode.latent)
    third = share * (1 - share) * (1 - 2 * share)
    bend = -0.5 * (covariance.diagonal() - np.sum(across * across, axis=0)) * third
    bend -= precision @ (covariance @ bend)
    scaled = x / hyper.length
    square = [covariance * (column[:, None] - column[None, :]) ** 2 for column in scaled.T]
    slopes = []
    for change in (*square, 2 * covariance):
        moved = change @ mode.weight
        slopes.append(0.5 * mode.weight @ moved - 0.5 * np.sum(precision * change) + bend @ moved)
    return mode.log_evidence, np.array([*slopes, 0.0]), mode.latent


def _curved(
    covariance: np.ndarray, latent: np.ndarray, count: Factorisations | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    from scipy.linalg import cholesky

    share = _logistic(latent)
    root = np.sqrt(share * (1 - share))
    inner = root[:, None] * covariance * root
    inner.flat[:: len(root) + 1] += 1.0
    if count is not None:
        count.add(len(root))
    return share, root, cholesky(inner, lower=True, overwrite_a=True)


def _logistic(latent: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 + 0.5 * np.tanh(0.5 * latent))


def _log_share(latent: np.ndarray, positive: np.ndarray) -> float:
    return float(-np.logaddexp(0.0, np.where(positive, -latent, latent)).sum())


AT_MOST = 160
SEARCH = 30
"""Evaluations of the evidence in a search."""


@dataclass(frozen=True, eq=False)
class TwoStates:
    """One process: whether a point belongs to a state."""

    x: np.ndarray
    positive: np.ndarray
    hyper: Hyper
    mode: Mode

    @classmethod
    def fit(cls, x: np.ndarray, positive: np.ndarray, *, hyper: Hyper | None, count: Factorisations) -> TwoStates:
        """Hyper-parameters by the evidence, or those given. x : (n, p), positive : (n,) bool."""
        if hyper is None:
            hyper = _sought(x, positive, count)
        return cls(x, positive, hyper, mode_of(kernel(x, x, hyper), positive, count=count))

    def latent(self, x: np.ndarray) -> np.ndarray:
        """(m,) mean of the latent at x (m, p): above 0 where the state is the likelier."""
        return np.asarray(kernel(x, self.x, self.hyper) @ self.mode.weight)

    def probability(self, x: np.ndarray) -> np.ndarray:
        """(m,) of the state, the logistic averaged over the latent's Gaussian (MacKay 1992)."""
        from scipy.linalg import solve_triangular

        across = kernel(self.x, x, self.hyper)
        half = solve_triangular(self.mode.factor, self.mode.root[:, None] * across, lower=True)
        variance = np.maximum(self.hyper.signal**2 - np.sum(half * half, axis=0), 0.0)
        return np.asarray(0.5 + 0.5 * np.tanh(0.5 * self.latent(x) / np.sqrt(1 + np.pi * variance / 8)))


@dataclass(frozen=True, eq=False)
class StateClassifier:
    """``states`` (S,) in rising order; one process for two of them, one each for more, none for a single one."""

    states: np.ndarray
    processes: tuple[TwoStates, ...]
    count: Factorisations = field(default_factory=lambda: Factorisations({}))

    @classmethod
    def fit(
        cls, x: np.ndarray, state: np.ndarray, *, at_most: int = AT_MOST, hyper: Hyper | None = None
    ) -> StateClassifier:
        """x : (n, p), state : (n,) of any whole numbers. Raises ValueError for shapes that disagree."""
        x, state = np.atleast_2d(np.asarray(x, float)), np.asarray(state).astype(int)
        if len(x) != len(state) or len(x) == 0:
            raise ValueError(f"one state a point, found {len(state)} states and {len(x)} points")
        states, count = np.unique(state), Factorisations({})
        chosen = telling_points(x, state, at_most)
        positives = states[1:] if len(states) <= 2 else states
        return cls(
            states,
            tuple(TwoStates.fit(x[chosen], state[chosen] == one, hyper=hyper, count=count) for one in positives),
            count,
        )

    def latents(self, x: np.ndarray) -> np.ndarray:
        """(m, S): the state is where this is greatest (for two states minus and plus one latent, for one zeros)."""
        own = np.stack([process.latent(x) for process in self.processes], axis=-1) if self.processes else None
        if own is None:
            return np.zeros((len(x), 1))
        return np.hstack([-own, own]) if len(self.states) == 2 else own

    def probability(self, x: np.ndarray) -> np.ndarray:
        """(m, S) of each state at x (m, p); rows sum to 1."""
        if not self.processes:
            return np.ones((len(x), 1))
        own = np.stack([process.probability(x) for process in self.processes], axis=-1)
        return np.hstack([1 - own, own]) if len(self.states) == 2 else own / own.sum(axis=1, keepdims=True)

    def state(self, x: np.ndarray) -> np.ndarray:
        """(m,) the likeliest state, as the numbers given to ``fit``."""
        return self.states[self.latents(np.atleast_2d(x)).argmax(axis=1)]


def telling_points(x: np.ndarray, state: np.ndarray, at_most: int) -> np.ndarray:
    """Numbers of at most ``at_most`` points: half the nearest to another state, half evenly; every state has one."""
    from scipy.spatial import cKDTree

    if len(x) <= at_most:
        return np.arange(len(x))
    away = np.full(len(x), np.inf)
    for one in np.unique(state):
        own = state == one
        if not own.all():
            away[own] = cKDTree(x[~own]).query(x[own])[0]
    first = np.array([np.flatnonzero(state == one)[0] for one in np.unique(state)])
    near = np.argsort(away, kind="stable")[: at_most // 2]
    rest = np.setdiff1d(np.arange(len(x)), near)
    even = rest[np.linspace(0, len(rest) - 1, max(at_most - len(near) - len(first), 1)).round().astype(int)]
    return np.unique(np.concatenate([first, near, even]))


def _sought(x: np.ndarray, positive: np.ndarray, count: Factorisations) -> Hyper:
    """By L-BFGS-B; each search for a mode begins where the last one ended."""
    last = [np.zeros(len(x))]

    def value(logs: np.ndarray) -> tuple[float, np.ndarray]:
        found, gradient, last[0] = log_evidence(Hyper.from_logs(logs), x, positive, last[0], count)
        return found, gradient

    start = start_of(x)
    return Hyper.from_logs(greatest(value, Hyper(start.length, 3.0, start.noise), SEARCH))
