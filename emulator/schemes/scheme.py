"""A scheme of the paper by its name: fitted to aligned sequences, it draws new ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from emulator.reduce import JointPCA
from emulator.schemes.autoregression import VAR
from emulator.schemes.dimensions import Representation, search_dimensions
from emulator.schemes.names import SchemeName, parsed
from emulator.schemes.pointwise import Pointwise
from emulator.schemes.reductions import Reduction, fitted
from emulator.schemes.siem import SIEM
from emulator.schemes.vectors import VectorModel
from emulator.schemes.velocity import ISTVF, MTVF, STVF

START_SHARE = 0.99
"""Share of the start posture's variance that is modelled."""

FITTERS: dict[str, Callable[[np.ndarray], Representation]] = {
    "SIEM": SIEM.fit,
    "SIEM-first": SIEM.fit_first,
    "SIEM-moving": SIEM.fit_moving,
    "IS-TVF": ISTVF.fit,
    "S-TVF": STVF.fit,
    "M-TVF": MTVF.fit,
}


class Model(Protocol):
    """A law of scores and of the start posture's scores."""

    def sample(self, n: int, rng: np.random.Generator, *, allow_unstable: bool) -> tuple[np.ndarray, np.ndarray]: ...
    def log_likelihood(self, scores: np.ndarray, start: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True, eq=False)
class Scheme:
    """Representation, reduction and model of sequences (N, T, B, 3) on one clock.

    start        : PCA of the start posture alpha(0), without components where the representation needs none
    coefficients : (N, K) of the training sequences, those of the start posture last
    Source: Chen, Park & Srivastava sec. 4.
    """

    name: str
    representation: Representation
    reduction: Reduction
    start: JointPCA
    model: Model
    coefficients: np.ndarray

    @classmethod
    def fit(
        cls,
        directions: np.ndarray,
        name: str = "SIEM/SequentialPCA/MVG",
        dims: Any = None,
        *,
        rho: float = 0.0,
        order: int | None = None,
        seed: int = 0,
    ) -> Scheme:
        """The scheme ``name`` (one of SCHEMES) of aligned directions (N, T, B, 3), N >= 2.

        dims  : as in ``reductions.fitted``; for SequentialPCA also "test", by error and two-sample test (sec. 5.1)
        rho   : share of the MVG's correlations given up, 0 as in the paper; order : of a VAR, None for the paper's 12
        seed  : of what fitting draws: the VAR's one sequence, permutations, parallel analysis
        Raises ValueError for a name, dims or an option that do not fit, and for opposite postures.
        """
        parts = parsed(name)
        _refuse_misfits(directions, parts, rho, order)
        rng = np.random.default_rng([seed, 5])
        representation = FITTERS[parts.representation](directions)
        flat, start = representation.forward(directions)
        if isinstance(dims, str) and dims == "test" and parts.reduction == "SequentialPCA":
            dims = search_dimensions(representation, directions, rng).chosen
        reduction = fitted(parts.reduction, flat, dims, rng)
        start_pca = JointPCA.fit(start, START_SHARE)
        scores, of_start = reduction.forward(flat), start_pca.forward(start)
        model = _model(parts.model, scores, of_start, rho, order, rng)
        rows = np.concatenate([scores.reshape(len(scores), -1), of_start], axis=1)
        return cls(name, representation, reduction, start_pca, model, rows)

    @property
    def dims(self) -> tuple[int, ...]:
        """Components: of space and of time, or of both in one."""
        return self.reduction.dims

    @property
    def n_coefficients(self) -> int:
        """Numbers that say one sequence."""
        return self.coefficients.shape[1]

    def scores(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Scores (n, ...) of directions (n, T, B, 3), and scores (n, S) of their start postures."""
        flat, start = self.representation.forward(directions)
        return self.reduction.forward(flat), self.start.forward(start)

    def sample(self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False) -> np.ndarray:
        """n new sequences (n, T, B, 3). Raises ValueError for a VAR that explodes, unless ``allow_unstable``."""
        scores, of_start = self.model.sample(n, rng, allow_unstable=allow_unstable)
        return self.representation.inverse(self.reduction.inverse(scores), self.start.inverse(of_start))

    def reconstruct(self, directions: np.ndarray) -> np.ndarray:
        """Directions (n, T, B, 3) as their scores give them back; alpha(0) is kept whole, as in the paper."""
        flat, start = self.representation.forward(directions)
        return self.representation.inverse(self.reduction.inverse(self.reduction.forward(flat)), start)

    def log_likelihood(self, directions: np.ndarray) -> np.ndarray:
        """Log density (n,) of the scores of directions (n, T, B, 3), in the subspace that the training spans.

        What the reduction leaves out does not count. Source: eq. 7, its sign mended.
        """
        return self.model.log_likelihood(*self.scores(directions))


def _refuse_misfits(directions: np.ndarray, parts: SchemeName, rho: float, order: int | None) -> None:
    wrong = []
    if directions.ndim != 4 or directions.shape[-1] != 3 or len(directions) < 2 or directions.shape[1] < 2:
        wrong.append(f"directions: found {directions.shape}, expected (N, T, B, 3) with N and T from 2")
    elif not np.isfinite(directions).all():
        wrong.append("directions: a posture is not finite")
    if rho != 0 and parts.model != "MVG":
        wrong.append(f"rho: found {rho}, but only MVG has it, not {parts.model}")
    if order is not None and not parts.model.startswith("VAR"):
        wrong.append(f"order: found {order}, but only VAR has it, not {parts.model}")
    if wrong:
        raise ValueError("; ".join(wrong))


def _model(
    name: str, scores: np.ndarray, start: np.ndarray, rho: float, order: int | None, rng: np.random.Generator
) -> Model:
    if name.startswith("PWI"):
        return Pointwise.fit(scores, shared=name == "PWI/shared")
    if name.startswith("VAR"):
        return VAR.fit(scores, start, rng, pooled=name == "VAR-pooled", order=order)
    return VectorModel.fit(name, scores, start, rho)
