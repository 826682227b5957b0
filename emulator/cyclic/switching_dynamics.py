"""The training manifold as draws see it: the training latents, and how far from them a pose may lie.

Beyond the paper: a first-order process with noise is lost sooner or later, since far from its data nothing calls it
back. The bound is what the recordings say themselves: how far one take lies from the others.

What switching dynamics are trained on: steps of sequences, thinned, and what of a step is foretold.

What the compiled step reads: projected processes of all states and the borders between them, padded to one size.

Switching Gaussian process dynamics: z_{t+1} given z_t by one process a contact state, the state by a classifier.

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

from emulator.cyclic.gaussian_process import THINNED, GaussianProcess, Hyper, Projected, pivoted
from emulator.cyclic.gp_classifier import StateClassifier

GAP_FRAMES = 10
"""With one take only, frames at least so far apart in time are what is held out."""
QUANTILE = 0.9
MOST_STEPS = 5000
TAIL = 0.125
NARROWEST = 0.25
"""Share of the bound that the radius keeps where single steps are longer than the bound."""


@dataclass(frozen=True, eq=False)
class Support:
    """A tube about the recorded steps: ``points`` (n, d), ``ways`` (n, d) to the frame after, and its ``radius``.

    Whole steps and not only frames, since where a contact begins a frame may be far from the next.
    ``leading`` : the first so many steps lie before the last TAIL of their stretch, so that who follows them gets on.
    ``bound``   : the greatest distance of a held-out frame from the nearest of the others.
    """

    points: np.ndarray
    ways: np.ndarray
    leading: int
    radius: float
    bound: float

    @classmethod
    def of(cls, sequences: Sequence[np.ndarray]) -> Support:
        """Radius: the QUANTILE of held-out distances, or less, so that nothing inside is beyond ``bound`` from a frame.

        Frames further away than the QUANTILE from all others belong to no cycle (a start from standing, a stumble):
        they are no support, or a draw would be caught there.
        """
        away, sequences = held_out_distances(sequences), list(sequences)
        radius = float(np.quantile(np.concatenate(away), QUANTILE))
        few = _few([len(z) for z in sequences])
        sequences, away, every = [sequences[i] for i in few], [away[i] for i in few], np.concatenate(away)
        usual = [(one[:-1] <= radius) & (one[1:] <= radius) for one in away]
        points = np.concatenate([z[:-1][own] for z, own in zip(sequences, usual)])
        ways = np.concatenate([np.diff(z, axis=0)[own] for z, own in zip(sequences, usual)])
        leads = np.concatenate([_leads(own)[own] for own in usual])
        kept = np.argsort(~leads, kind="stable")
        bound = float(every.max())
        half_step = 0.5 * np.linalg.norm(ways[kept], axis=1).max()
        safe = np.sqrt(max(bound**2 - half_step**2, (NARROWEST * bound) ** 2))
        return cls(points[kept], ways[kept], int(leads[kept].sum()), float(min(radius, safe)), bound)


def distance(z: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """(...) from each z (..., d) to the nearest of the frames (n, d)."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(frames).query(z)[0])


def _few(lengths: Sequence[int]) -> list[int]:
    """Numbers of sequences, evenly, that have MOST_STEPS frames together; whole ones, since steps lead on."""
    share = min(1.0, MOST_STEPS / sum(lengths))
    return np.unique((np.arange(max(1, int(share * len(lengths)))) / share).astype(int)).tolist()


def _leads(usual: np.ndarray) -> np.ndarray:
    """(T,) True for steps before the last TAIL of their run of usual ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], usual.astype(int), [0]])))
    out = np.zeros(len(usual), dtype=bool)
    for start, stop in zip(edges[::2], edges[1::2]):
        out[start : stop - int(np.ceil(TAIL * (stop - start)))] = True
    return out


def held_out_distances(sequences: Sequence[np.ndarray]) -> list[np.ndarray]:
    """(T,) of each: from a frame to the nearest frame of another sequence; of one sequence, to one far in time."""
    if len(sequences) == 1:
        return [_far_in_time(sequences[0])]
    return [distance(own, np.concatenate([*sequences[:i], *sequences[i + 1 :]])) for i, own in enumerate(sequences)]


def _far_in_time(z: np.ndarray) -> np.ndarray:
    away = np.empty(len(z))
    for t in range(len(z)):
        others = np.concatenate([z[: max(t - GAP_FRAMES, 0)], z[t + GAP_FRAMES :]])
        away[t] = np.sqrt(((others - z[t]) ** 2).sum(axis=1).min()) if len(others) else 0.0
    return away


FEWEST = 8
"""A state needs so many steps to be modelled."""


def target(x: np.ndarray, after: np.ndarray, keeps: bool) -> np.ndarray:
    """What a process foretells: the increment of z or the next z; x (n, p) begins with z (n, d)."""
    return after - x[:, : after.shape[1]] if keeps else after


def keeps_of(
    x: np.ndarray, after: np.ndarray, chosen: Sequence[np.ndarray]
) -> tuple[bool, tuple[GaussianProcess, ...]]:
    """Whether increments are likelier than next values, asked of THINNED points a state; all processes, best first."""
    few = [thinned(at, THINNED) for at in chosen]
    tried = [[GaussianProcess.fit(x[at], target(x[at], after[at], keeps)) for at in few] for keeps in (True, False)]
    by_increment, by_next = (sum(one.log_likelihood for one in processes) for processes in tried)
    keeps = by_increment >= by_next
    return keeps, (*tried[not keeps], *tried[keeps])


def thinned(numbers: np.ndarray, at_most: int) -> np.ndarray:
    """At most ``at_most`` of the numbers, evenly."""
    return numbers[np.unique(np.linspace(0, len(numbers) - 1, at_most).round().astype(int))]


def check(sequences: Sequence[np.ndarray], states: Sequence[np.ndarray], controls: Sequence[np.ndarray]) -> None:
    """Raises ValueError with all that is wrong."""
    lengths = [(len(z), len(state), len(c)) for z, state, c in zip(sequences, states, controls)]
    wrong = [
        f"sequence {i}: {a} latents, {b} states, {c} controls" for i, (a, b, c) in enumerate(lengths) if not a == b == c
    ]
    if not len(sequences) == len(states) == len(controls) or not sequences:
        wrong.append(f"found {len(sequences)} sequences, {len(states)} rows of states, {len(controls)} of controls")
    if not wrong:
        every = np.concatenate([one[:-1] for one in states])
        few = {int(one): int(np.sum(every == one)) for one in np.unique(every) if np.sum(every == one) < FEWEST}
        wrong = [f"state {one} has {n} steps, {FEWEST} are needed; merge it with a neighbour" for one, n in few.items()]
    if wrong:
        raise ValueError("; ".join(wrong))


BORDER_LEFT_OUT = 1e-4
"""Share of the signal's variance that a border seen through a few of its points may leave out."""


def tables_of(
    processes: Sequence[Projected], keeps: bool, classifier: StateClassifier, support: Support
) -> dict[str, np.ndarray]:
    """The fields of ``emulator.kernels.switching.Tables`` by name."""
    borders = [_border(process.x, process.hyper, process.mode.weight) for process in classifier.processes]
    n_inputs = processes[0].points.shape[1]
    return {
        "points": _padded([one.points / one.hyper.length for one in processes]),
        "per_length": np.array([1 / one.hyper.length for one in processes]),
        "used": np.array([len(one.points) for one in processes]),
        "variance": np.array([one.hyper.signal**2 for one in processes]),
        "noise": np.array([one.hyper.noise**2 for one in processes]),
        "weight": _padded([one.weight * one.hyper.signal**2 for one in processes]),
        "shrink": _padded([one.shrink * one.hyper.signal**4 for one in processes], square=True),
        "scale": np.array([one.scale**2 for one in processes]),
        "keep": np.full(len(processes), float(keeps)),
        "border_points": _padded([points for points, _, _ in borders]) if borders else np.empty((0, 0, n_inputs)),
        "border_per_length": np.array([per_length for _, per_length, _ in borders]).reshape(-1, n_inputs),
        "border_used": np.array([len(points) for points, _, _ in borders], dtype=np.int64),
        "border_weight": _padded([weight for _, _, weight in borders]) if borders else np.empty((0, 0)),
        "support": support.points,
        "ways": support.ways,
        "leading": np.array(support.leading),
        "reach": np.array(support.radius + np.linalg.norm(support.ways, axis=1).max()),
        "radius2": np.array(support.radius**2),
    }


def kernel_tables(arrays: dict[str, np.ndarray]) -> Any:
    """The named tuple that the kernel takes."""
    from emulator.kernels.switching import Tables

    numbers: dict[str, Any] = {name: arrays[name].item() for name in ("leading", "reach", "radius2")}
    rows: dict[str, Any] = {name: np.ascontiguousarray(arrays[name]) for name in Tables._fields if name not in numbers}
    rows |= {name: np.ascontiguousarray(rows[name].swapaxes(1, 2)) for name in ("points", "border_points")}
    return Tables(**rows, **numbers)


def _border(x: np.ndarray, hyper: Hyper, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scaled points (m, p), 1 / lengths and weights (m,) of a classifying process seen through its pivots."""
    from scipy.linalg import solve_triangular

    pivots, low = pivoted(x, hyper, BORDER_LEFT_OUT * hyper.signal**2)
    through = solve_triangular(low[:, pivots], low @ weight)
    return x[pivots] / hyper.length, 1 / hyper.length, through * hyper.signal**2


def _padded(arrays: Sequence[np.ndarray], square: bool = False) -> np.ndarray:
    """(S, M, ...) of arrays (m, ...) with zeros below, and, if ``square``, to the right."""
    most = max(len(array) for array in arrays)
    out = np.zeros((len(arrays), most, *([most] if square else arrays[0].shape[1:])))
    for place, array in zip(out, arrays):
        place[tuple(slice(0, n) for n in array.shape)] = array
    return out


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
