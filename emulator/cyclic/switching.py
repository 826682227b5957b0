"""Switching Gaussian process dynamics: z_{t+1} given z_t by one process a contact state, the state by a classifier.

Source: Remillard & Kry (2010), sec. 2.1. As there: first order, one kernel for all outputs, hyper-parameters by the
marginal likelihood, the state of z_t chooses the process. Beyond the paper: draws have the predictive variance; a draw
that leaves the training manifold is drawn again (the predictive density truncated to a tube about the recorded steps,
``support.py``; where draws and mean all leave it, the nearest recorded step is repeated: 0.4-5 % of walking steps); the
increment or the next value is foretold, whichever is the likelier; known controls (a speed, a leg's length) may enter
the kernel; steps see the data through a few of its points (``projected.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from emulator.cyclic.classifier import StateClassifier
from emulator.cyclic.gp import GaussianProcess
from emulator.cyclic.projected import Projected
from emulator.cyclic.step_tables import kernel_tables, tables_of
from emulator.cyclic.support import Support
from emulator.cyclic.training import check, keeps_of, target, thinned

SEARCH = 8
"""Factorisations of all points of a state; 12 or 40 gain less than 0.5 of a log likelihood of 3,000."""
TRIES = 4
"""Draws of a step before the mean is taken."""


class Normals(Protocol):
    """A source of standard normal numbers, such as a ``numpy.random.Generator``."""

    def standard_normal(self, size: Any, /) -> Any:
        """Numbers of this shape."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """What a fit was made of; it is not kept in files."""

    processes: tuple[GaussianProcess, ...]
    tried: tuple[GaussianProcess, ...]
    """Small ones, asked whether increments or next values are foretold."""
    classifier: StateClassifier

    @property
    def n_factorisations(self) -> float:
        """Cost of the whole fit in Cholesky factorisations of the largest state."""
        largest = max(len(one.x) for one in self.processes)
        counts = [one.count for one in (*self.processes, *self.tried)] + [self.classifier.count]
        return sum(count.as_of(largest) for count in counts)

    @property
    def log_likelihood(self) -> float:
        """log p of all steps given the latents before them and the states."""
        return sum(one.log_likelihood for one in self.processes)


@dataclass(frozen=True, eq=False)
class SwitchingDynamics:
    """``states`` (S,) the numbers given to ``fit``; ``tables`` what a step reads; ``starts`` (n, d) first frames."""

    states: np.ndarray
    tables: dict[str, np.ndarray]
    starts: np.ndarray
    bound: float
    """Greatest distance of a held-out training frame from the rest: the width of the manifold."""
    fitted: Fitted | None = None

    @classmethod
    def fit(
        cls,
        sequences: Sequence[np.ndarray],
        states: Sequence[np.ndarray],
        *,
        controls: Sequence[np.ndarray] | None = None,
        at_most: int = 500,
        switching: bool = True,
        on_support: bool = True,
    ) -> SwitchingDynamics:
        """From latents (T, d) and states (T,) a sequence, and perhaps controls (T, c); steps never cross sequences.

        at_most    : points a state (evenly thinned beyond)
        switching  : False fits one process to everything, to compare with
        on_support : False lets draws go anywhere
        Raises ValueError for sequences and states that disagree, and for a state with fewer than FEWEST steps.
        """
        sequences = [np.asarray(z, float) for z in sequences]
        states = [np.asarray(state, int) for state in states]
        controls = [np.empty((len(z), 0)) for z in sequences] if controls is None else [*controls]
        check(sequences, states, controls)
        x = np.concatenate([np.hstack([z, c])[:-1] for z, c in zip(sequences, controls)])
        after = np.concatenate([z[1:] for z in sequences])
        state = np.concatenate([one[:-1] for one in states]) * int(switching)
        classifier = StateClassifier.fit(x, state)
        chosen = [thinned(np.flatnonzero(state == one), at_most) for one in classifier.states]
        keeps, tried = keeps_of(x, after, chosen)
        processes = tuple(
            GaussianProcess.fit(x[at], target(x[at], after[at], keeps), start=small.hyper, at_most=SEARCH)
            for at, small in zip(chosen, tried)
        )
        support = Support.of(sequences)
        tables = tables_of([Projected.of(one) for one in processes], keeps, classifier, support)
        if not on_support:
            tables |= {"reach": np.array(np.inf), "radius2": np.array(np.inf)}
        fitted = Fitted(processes, tried, classifier)
        return cls(classifier.states, tables, np.array([z[0] for z in sequences]), support.bound, fitted)

    def sample(
        self,
        z0: np.ndarray,
        n_steps: int,
        rng: Normals,
        noise: bool = True,
        *,
        controls: np.ndarray | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Paths z (n, n_steps, d) from z0 (n, d), and their states (n, n_steps); z[:, 0] is z0.

        noise    : False follows the mean, as the paper does
        controls : (n, c) for the whole path or (n, n_steps, c) frame by frame, where the fit had controls
        Raises ValueError for another number of latents or controls than in the fit.
        """
        from emulator.kernels.switching import steps

        z0 = np.atleast_2d(np.asarray(z0, float))
        control = self._controls(controls, (len(z0), n_steps))
        if z0.shape[1] != self.n_latents or n_steps < 1:
            raise ValueError(f"z0 must be (n, {self.n_latents}) and n_steps at least 1; found {z0.shape} and {n_steps}")
        z, state = np.empty((len(z0), n_steps, self.n_latents)), np.empty((len(z0), n_steps), dtype=np.int64)
        z[:, 0] = z0
        shape = (len(z0), n_steps - 1, TRIES if noise else 1, self.n_latents)
        steps(self.kernel_tables, control, rng.standard_normal(shape) if noise else np.zeros(shape), z, state)
        return z, self.states[state]

    def state(self, z: np.ndarray, controls: np.ndarray | None = None) -> np.ndarray:
        """(...) likeliest state at z (..., d), as a step sees it."""
        from emulator.kernels.switching import states_of

        z = np.asarray(z, float)
        flat = z.reshape(-1, self.n_latents)
        known = np.empty((*z.shape[:-1], 0)) if controls is None else np.asarray(controls, float)
        x = np.hstack([flat, np.broadcast_to(known, (*z.shape[:-1], known.shape[-1])).reshape(len(flat), -1)])
        out = np.empty(len(flat), dtype=np.int64)
        states_of(np.ascontiguousarray(x), self.kernel_tables, out)
        return self.states[out].reshape(z.shape[:-1])

    @cached_property
    def kernel_tables(self) -> Any:
        """``tables`` as the kernels take them."""
        return kernel_tables(self.tables)

    @property
    def n_latents(self) -> int:
        return int(self.tables["support"].shape[1])

    @property
    def n_controls(self) -> int:
        return int(self.tables["per_length"].shape[1]) - self.n_latents

    def arrays(self) -> dict[str, np.ndarray]:
        """What a file keeps of it, by flat names; ``from_arrays`` draws the same to the bit."""
        own = {"states": self.states, "starts": self.starts, "bound": np.array(self.bound)}
        return own | {f"tables_{name}": array for name, array in self.tables.items()}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> SwitchingDynamics:
        tables = {name.removeprefix("tables_"): arrays[name] for name in arrays if name.startswith("tables_")}
        return cls(arrays["states"], tables, arrays["starts"], float(arrays["bound"]))

    def _controls(self, controls: np.ndarray | None, shape: tuple[int, int]) -> np.ndarray:
        given = np.empty((shape[0], 0)) if controls is None else np.asarray(controls, float)
        if given.shape[-1] != self.n_controls or given.ndim not in (2, 3):
            raise ValueError(f"the fit had {self.n_controls} controls a frame, found an array {given.shape}")
        given = given[:, None, :] if given.ndim == 2 else given
        return np.ascontiguousarray(np.broadcast_to(given, (*shape, self.n_controls)))
