"""A scheme of the paper by its name, Representation/DimensionReduction/StatisticalModel: fitted, it draws sequences.

How many components of space and of time: by reconstruction error and a two-sample test, as in sec. 5.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, NamedTuple, Protocol

import numpy as np

from emulator.judge.posture_tests import disco, reconstruction_error
from emulator.judge.sequence_distances import distances
from emulator.model.reduction import JointPCA, SequentialPCA
from emulator.schemes.densities import DENSITIES, VAR, VectorModel
from emulator.schemes.flattening import ISTVF, MTVF, SIEM, STVF, Pointwise
from emulator.schemes.reductions import Reduction, fitted, spanned

SPACES, TIMES = (1, 2, 3, 5, 8, 10, 12, 16, 20, 30), (1, 2, 4, 7, 10, 15, 20, 30, 40)
GAIN, LEVEL, WITHIN, N_PERMUTATIONS = 0.04, 0.05, 1.1, 199


class Representation(Protocol):
    """Directions (n, T, B, 3) to flat (n, T', C) and start (n, S), and back."""

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]: ...
    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class DimensionSearch:
    """What was tried and found (the paper's figure 13).

    d1, d2 : numbers tried; error : (len(d1), len(d2)) mean reconstruction error, radians (eq. 5)
    p      : (len(d2),) of the two-sample test of originals against reconstructions at the chosen d1
    chosen : (d1, d2)
    """

    d1: tuple[int, ...]
    d2: tuple[int, ...]
    error: np.ndarray
    p: np.ndarray
    chosen: tuple[int, int]


def search_dimensions(
    representation: Representation, directions: np.ndarray, rng: np.random.Generator
) -> DimensionSearch:
    """Numbers of components for directions (N, T, B, 3), as the paper looks for them, by a rule it does not print.

    d1 is the first from which on a further component lowers the error (with all functions of time) by less than a
    twenty-fifth of what one component leaves; d2 the first whose reconstructions the test does not tell from the
    originals at 0.05, with an error within a tenth of that of all functions. The test alone would take one function:
    it forgives what each reconstruction has in common with its original.
    """
    flat, start = representation.forward(directions)
    most = spanned(flat, SPACES[-1], TIMES[-1])
    d1, d2 = _upto(SPACES, most[0]), _upto(TIMES, most[1])
    whole = SequentialPCA.fit(flat, d1[-1], d2[-1])

    def rebuilt(i: int, j: int) -> np.ndarray:
        part = SequentialPCA(whole.mean, whole.spatial[:i], whole.temporal_mean[:i], whole.temporal[:i, :j])
        return representation.inverse(part.inverse(part.forward(flat)), start)

    error = np.array([[reconstruction_error(directions, rebuilt(i, j)) for j in d2] for i in d1])
    gain = -np.diff(error[:, -1]) / np.diff(d1)
    at = int(np.argmax(np.append(gain < GAIN * error[0, -1], True)))
    p = np.array([_p(directions, rebuilt(d1[at], j), rng) for j in d2])
    good = (p > LEVEL) & (error[at] <= WITHIN * error[at, -1])
    return DimensionSearch(d1, d2, error, p, (d1[at], d2[int(np.argmax(good))] if good.any() else d2[-1]))


def _p(directions: np.ndarray, rebuilt: np.ndarray, rng: np.random.Generator) -> float:
    both = distances(np.concatenate([directions, rebuilt]))
    return disco(both, len(directions), rng, N_PERMUTATIONS).p


def _upto(tried: tuple[int, ...], largest: int) -> tuple[int, ...]:
    return (*(d for d in tried if d < largest), largest) if largest <= tried[-1] else tried


REPRESENTATIONS = ("SIEM", "SIEM-first", "SIEM-moving", "IS-TVF", "S-TVF", "M-TVF")
VECTOR_REDUCTIONS, VECTOR_MODELS = ("SequentialPCA", "MPCA", "JointPCA"), tuple(DENSITIES)
SERIES_REDUCTION, SERIES_MODELS = "SpatialPCA", ("VAR", "VAR-pooled")
POINTWISE = ("PWI", "PWI/shared")

SCHEMES: tuple[str, ...] = (
    *(f"{r}/{d}/{m}" for r in REPRESENTATIONS for d in VECTOR_REDUCTIONS for m in VECTOR_MODELS),
    *(f"{r}/{SERIES_REDUCTION}/{m}" for r in REPRESENTATIONS for m in SERIES_MODELS),
    *POINTWISE,
)
"""All schemes there are."""


class SchemeName(NamedTuple):
    representation: str
    reduction: str
    model: str


def parsed(name: str) -> SchemeName:
    """The parts of a scheme's name; PWI is the moving mean without reduction.

    Raises ValueError that names every part that is not known, with the nearest word, or parts that do not go together.
    """
    if name in POINTWISE:
        return SchemeName("SIEM-moving", "", name)
    parts = name.split("/")
    if len(parts) != 3:
        raise ValueError(f"scheme: {_unknown(name, SCHEMES)}; expected Representation/DimensionReduction/Model")
    known = (REPRESENTATIONS, (*VECTOR_REDUCTIONS, SERIES_REDUCTION), (*VECTOR_MODELS, *SERIES_MODELS))
    wrong = [_unknown(part, words) for part, words in zip(parts, known) if part not in words]
    if wrong:
        raise ValueError(f"scheme {name!r}: " + "; ".join(wrong))
    if name not in SCHEMES:
        goes = VECTOR_MODELS if parts[1] in VECTOR_REDUCTIONS else SERIES_MODELS
        raise ValueError(f"scheme {name!r}: {parts[2]} does not go with {parts[1]}, which goes with {', '.join(goes)}")
    return SchemeName(*parts)


def _unknown(word: str, known: tuple[str, ...]) -> str:
    folded = {k.lower(): k for k in known}
    near = get_close_matches(word.lower(), folded, n=1)
    return f"no {word!r}" + (f", did you mean {folded[near[0]]!r}?" if near else f", known: {', '.join(known)}")


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
