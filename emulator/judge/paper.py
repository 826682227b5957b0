"""One class of recordings, ready to be judged as the paper does: on one clock, with everything that draws from it.

Tables 1 to 5 of Chen, Park & Srivastava, sec. 5, as rows: what they printed of their five classes, of any class.

What figures 14, 15 and 16 of the paper show: sub-sequences that the schemes draw, beside the recordings.

What figures 4, 5, 7, 8, 9, 10 and 13 of the paper show: flattening and reduction of the recordings of a class.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.fitting.registration import registered
from emulator.fitting.settings import FitSettings
from emulator.geometry import sphere
from emulator.judge.canonical_postures import (
    Quantization,
    sampled_postures,
    transition_distance,
    transition_matrices,
    uniform_transitions,
    variability,
)
from emulator.judge.held_out import draw_alike
from emulator.judge.likelihood import TwoLevelRow, two_level
from emulator.judge.posture_tests import disco, reconstruction_error
from emulator.judge.sequence_distances import distances, mds_of_two, pooled, stream
from emulator.model.emulator import SCHEME, MotionEmulator
from emulator.motion import MotionSet
from emulator.schemes import Scheme
from emulator.schemes.flattening import ISTVF, MTVF, STVF
from emulator.schemes.flattening import SIEM as SIEM_flattening

N_TIMES, N_KNOTS = 301, 20
OURS = f"ours ({SCHEME})"
IS_TVF, SIEM, PWI, VAR = "IS-TVF/SequentialPCA/MVG", "SIEM/SequentialPCA/MVG", "PWI", "IS-TVF/SpatialPCA/VAR"


@dataclass(frozen=True, eq=False)
class PaperClass:
    """A class of N repetitions, their postures on the common clock (N, 301, B, 3), and our emulator of them."""

    motions: MotionSet
    aligned: np.ndarray
    emulator: MotionEmulator
    seed: int

    @property
    def task(self) -> str:
        return self.motions.task

    def draw(
        self, name: str, n: int, span: slice = slice(None), dims: tuple[int, int] | None = None, again: int = 0
    ) -> np.ndarray:
        """n sequences of a scheme fitted to the part ``span`` of the clock, or of ours, of which the part is taken.

        Our emulator draws the people of the recordings, each as often as there. An exploding VAR is drawn all the
        same; functions of time are cut to what the recordings span. ``again`` : other draws of the same law.
        """
        rng = stream(self.seed, self.task, name, str(span.start), str(n), *([str(again)] if again else []))
        if name == OURS:
            scores = draw_alike(self.emulator, self.motions, n, rng).scores
            return self.emulator.aligned_directions(scores)[:, span]
        least = None if dims is None else (dims[0], min(dims[1], len(self.aligned) - 1))
        return Scheme.fit(self.aligned[:, span], name, least, seed=self.seed).sample(n, rng, allow_unstable=True)


def prepared(motions: MotionSet, seed: int = 0, progress: Callable[[int, int, str], None] | None = None) -> PaperClass:
    """The class on 301 points, aligned without a penalty as in the paper, and fitted so."""
    settings = FitSettings(SCHEME, None, N_TIMES, N_KNOTS, landmarks=0.0, seed=seed, command="", penalty=0.0)
    emulator = MotionEmulator.fit(motions, n_times=N_TIMES, n_knots=N_KNOTS, penalty=0.0, seed=seed, progress=progress)
    return PaperClass(motions, registered(motions, settings, None).directions, emulator, seed)


SPANS = (slice(180, 211), slice(180, 241), slice(180, 301))
SPAN_DIMS = ((8, 4), (10, 5), (12, 10))
WHOLE_DIMS = (10, 30)
DRAWERS = (IS_TVF, SIEM, PWI, VAR, OURS)
N_QUANTIZED, N_DRAWN, N_SETS, N_PERMUTATIONS = 5000, 500, 4, 999
LEVEL_ONE = ("IS-TVF/SequentialPCA/IG", "SIEM/SequentialPCA/IG")
LEVEL_DIMS = {"one": (5, 4), "two": (4, 4)}


Row = tuple[str | float, ...]


@dataclass(frozen=True)
class Table:
    """A table: its number in the paper, what it shows, names of the columns, and rows of words and numbers."""

    number: int
    title: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]


def table_1(c: PaperClass) -> Table:
    """Reconstruction errors (eq. 5, radians summed over bones, mean over time) of sub-sequences by sequential PCA."""
    rows: list[Row] = []
    for span, dims in zip(SPANS, SPAN_DIMS):
        part = c.aligned[:, span]
        errors = [reconstruction_error(part, Scheme.fit(part, n, dims).reconstruct(part)) for n in (IS_TVF, SIEM)]
        rows.append((_words(span), f"{dims[0]} x {dims[1]}", *errors))
    return Table(1, "reconstruction error of sub-sequences", ("part", "size", "IS-TVF", "SIEM"), tuple(rows))


def table_2(c: PaperClass) -> Table:
    """p of DISCO, as many drawn as recorded, on the sub-sequences; the recordings are those that were fitted."""
    rows: list[Row] = []
    for span, dims in zip(SPANS, SPAN_DIMS):
        part = c.aligned[:, span]
        among = distances(part)
        drawn = [c.draw(name, len(part), span, None if name == PWI else dims) for name in DRAWERS]
        rows.append((_words(span), *(_p(d, part, among, stream(c.seed, c.task, "p", _words(span))) for d in drawn)))
    return Table(2, "p of the two-sample test on sub-sequences", ("part", *DRAWERS), tuple(rows))


def level_two(c: PaperClass, n_train: int = 800, n_test: int = 200) -> dict[str, list[TwoLevelRow]]:
    """Rows of the two-level simulation for two simple laws of level one, by the name of that law."""

    def fit(name: str, sequences: np.ndarray) -> Scheme:
        level = "one" if len(sequences) == len(c.aligned) else "two"
        return Scheme.fit(sequences, name, None if name == PWI else LEVEL_DIMS[level], seed=c.seed)

    sizes = {"seed": c.seed, "n_train": n_train, "n_test": n_test, "n_drawn": n_test}
    return {one: two_level(c.aligned, one, (one, one.replace("/IG", "/MVG"), PWI), fit, **sizes) for one in LEVEL_ONE}


def table_3(found: dict[str, list[TwoLevelRow]]) -> Table:
    """p of DISCO at level two, from ``level_two``."""
    rows: list[Row] = [(one, *(row.p for row in two)) for one, two in found.items()]
    return Table(3, "p of the two-sample test at level two", ("level one", "its own law", "MVG", "PWI"), tuple(rows))


def quantized(classes: Sequence[PaperClass], seed: int = 0) -> Quantization:
    """Canonical postures of a sample of 5,000 from all classes, each giving as many as it has."""
    bodies = {c.motions.skeleton for c in classes}
    if len(bodies) > 1:
        raise ValueError(f"quantization: found {len(bodies)} skeletons, expected one: judge these classes apart")
    every = np.concatenate([c.aligned for c in classes])
    return Quantization.fit(sampled_postures(every, N_QUANTIZED, stream(seed, "quantized")))


def tables_4_and_5(c: PaperClass, postures: Quantization, drawers: Sequence[str] = DRAWERS) -> tuple[Table, Table]:
    """Variability E (Var E) and transition matrices of quantized sequences, recorded ones and 500 drawn.

    Means over ``N_SETS`` sets of draws, with the standard deviation of one set's transition matrices: it is as large as
    the differences between good schemes.
    """
    reference = postures.labels(sphere.mean(c.aligned)[None])[0]
    recorded = postures.labels(c.aligned)
    truth = transition_matrices(recorded, postures.n_postures)
    own = variability(recorded, reference)
    four: list[Row] = [("recordings", own.mean, own.variance, 0.0)]
    uniform = uniform_transitions(len(truth), postures.n_postures)
    five: list[Row] = [("uniform baseline", transition_distance(truth, uniform), 0.0)]
    for name in drawers:
        dims = None if name == PWI else WHOLE_DIMS
        sets = [postures.labels(c.draw(name, N_DRAWN, dims=dims, again=i)) for i in range(N_SETS)]
        e = [variability(labels, reference) for labels in sets]
        apart = [transition_distance(truth, transition_matrices(labels, postures.n_postures)) for labels in sets]
        mean = float(np.mean([one.mean for one in e]))
        four.append((name, mean, float(np.mean([one.variance for one in e])), abs(mean - own.mean)))
        five.append((name, float(np.mean(apart)), float(np.std(apart, ddof=1))))
    return (
        Table(
            4, "variability of quantized sequences", ("sequences", "E", "Var E", "|E - E of recordings|"), tuple(four)
        ),
        Table(5, "difference of the transition matrices", ("sequences", "L1 norm", "SD of one set"), tuple(five)),
    )


def _p(drawn: np.ndarray, recorded: np.ndarray, among: np.ndarray, rng: np.random.Generator) -> float:
    both = pooled(distances(drawn, recorded), distances(drawn), among)
    return disco(both, len(drawn), rng, N_PERMUTATIONS).p


def _words(span: slice) -> str:
    return f"{span.start} to {span.stop - 1}"


RECORDED = "recordings"
SPAN, DIMS, N_PEOPLE = SPANS[1], SPAN_DIMS[1], 7
Draws = dict[str, np.ndarray]


def draws_of(c: PaperClass) -> Draws:
    """The sub-sequences 180 to 240 (N, 61, B, 3): the recordings, and as many of each scheme."""
    drawn = {name: c.draw(name, len(c.aligned), SPAN, None if name == PWI else DIMS) for name in DRAWERS}
    return {RECORDED: c.aligned[:, SPAN]} | drawn


def people(c: PaperClass, draws: Draws) -> dict[str, np.ndarray]:
    """Figure 14: joints (7, J, 3), metres, root at 0, of the first sub-sequence of each, in a mean body."""
    bones = np.mean([motion.bone_length_m for motion in c.motions.motions], axis=0)
    at = np.linspace(0, len(range(*SPAN.indices(len(c.aligned[0])))) - 1, N_PEOPLE).astype(int)
    root = np.zeros((N_PEOPLE, 3))
    return {name: c.motions.skeleton.positions(made[0][at], bones, root) for name, made in draws.items()}


def scaled(draws: Draws) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Figure 15: recorded (N, 2) and drawn (N, 2) sub-sequences of each scheme in the plane."""
    real = draws[RECORDED]
    among, points = distances(real), {}
    for name, made in draws.items():
        if name != RECORDED:
            drawn, recorded, _ = mds_of_two(distances(made, real), distances(made), among)
            points[name] = recorded, drawn
    return points


def roughness_over_time(draws: Draws) -> Draws:
    """Figure 16: mean distance (60,) of successive postures, radians summed over bones."""
    return {name: sphere.distance(made[:, 1:], made[:, :-1]).mean(axis=0) for name, made in draws.items()}


N_SHOWN = 3
SIZES = ((2, 4), (4, 4), (5, 4), (5, 10), (8, 10), (10, 10), (10, 20), (10, 30))
JOINT_SIZES = (4, 8, 12, 16, 20, 24, 28, 32, 36)
WIDTHS = (2, 4, 7, 10, 15, 20, 25, 30, 40)


def fields(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 4: the three liveliest channels (2, T', 3) of S-TVF and IS-TVF of two repetitions."""
    shown = {}
    kinds: dict[str, Any] = {"S-TVF": STVF, "IS-TVF": ISTVF}
    for name, kind in kinds.items():
        flat, _ = kind.fit(c.aligned).forward(c.aligned[:2])
        shown[name] = flat[..., np.argsort(flat.std(axis=(0, 1)))[::-1][:N_SHOWN]]
    return shown


def round_trip_errors(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 5: mean error (T,), radians summed over bones, of flattening and its way back.

    M-TVF comes back exactly if it goes back by the hops it came; by the one hop of definition 1 it drifts.
    """
    errors = {}
    kinds: dict[str, Any] = {"IS-TVF": ISTVF, "SIEM": SIEM_flattening, "M-TVF": MTVF}
    for name, kind in kinds.items():
        representation = kind.fit(c.aligned)
        again = representation.inverse(*representation.forward(c.aligned))
        errors[name] = sphere.distance(again, c.aligned).mean(axis=0)
    hops = MTVF.fit(c.aligned)
    again = hops.inverse_by_one_hop(*hops.forward(c.aligned))
    return errors | {"M-TVF, back in one hop": sphere.distance(again, c.aligned).mean(axis=0)}


def spatial_shares(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 7: share of the variance of each component in space."""
    found = {}
    kinds: dict[str, Any] = {"IS-TVF": ISTVF, "SIEM": SIEM_flattening}
    for name, kind in kinds.items():
        postures = kind.fit(c.aligned).forward(c.aligned)[0]
        values = np.linalg.eigvalsh(np.cov(postures.reshape(-1, postures.shape[-1]).T))[::-1]
        found[name] = values / values.sum()
    return found


def first_score(c: PaperClass) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Figure 8: the first spatial score of SIEM (N, T), its first functions of time (3, T), and all their shares."""
    flat = SIEM_flattening.fit(c.aligned).forward(c.aligned)[0]
    centred = (flat - flat.reshape(-1, flat.shape[-1]).mean(axis=0)).reshape(-1, flat.shape[-1])
    first = np.linalg.eigh(centred.T @ centred)[1][:, -1]
    scores = (centred @ first).reshape(flat.shape[:2])
    _, values, functions = np.linalg.svd(scores - scores.mean(axis=0), full_matrices=False)
    return scores, functions[:N_SHOWN], values**2 / np.sum(values**2)


def errors_by_size(c: PaperClass) -> dict[str, tuple[list[int], list[float]]]:
    """Figure 9: numbers a sequence, and the error (eq. 5) of the fitted sequences, for each reduction."""
    most = len(c.aligned) - 1
    pairs = list(dict.fromkeys((d1, min(d2, most)) for d1, d2 in SIZES))
    joint = [size for size in JOINT_SIZES if size <= most]
    tried: dict[str, Any] = {"SequentialPCA": pairs, "MPCA": pairs, "JointPCA": joint}
    found = {}
    for reduction, sizes in tried.items():
        errors = [_error(c, f"SIEM/{reduction}/MVG", size) for size in sizes]
        found[reduction] = [s if isinstance(s, int) else s[0] * s[1] for s in sizes], errors
    return found


def first_coefficients(c: PaperClass) -> np.ndarray:
    """Figure 10: coefficients (N, 2, 4) of SIEM/SequentialPCA: two spatial scores, four functions each."""
    scores = Scheme.fit(c.aligned, "SIEM/SequentialPCA/MVG", (5, 4)).coefficients
    return scores[:, :8].reshape(-1, 2, 4)


def dimensions(c: PaperClass) -> tuple[list[int], dict[int, list[float]], list[float]]:
    """Figure 13: d2, errors for d1 = 5 and 10, and p of reconstructed against original sequences for d1 = 10."""
    widths = [width for width in WIDTHS if width < len(c.aligned)]
    again = {
        d1: [Scheme.fit(c.aligned, "SIEM/SequentialPCA/MVG", (d1, d2)).reconstruct(c.aligned) for d2 in widths]
        for d1 in (5, 10)
    }
    errors = {d1: [reconstruction_error(c.aligned, sequences) for sequences in made] for d1, made in again.items()}
    among, rng = distances(c.aligned), stream(c.seed, c.task, "figure 13")
    tested = [pooled(distances(sequences, c.aligned), distances(sequences), among) for sequences in again[10]]
    return widths, errors, [disco(both, len(c.aligned), rng).p for both in tested]


def _error(c: PaperClass, name: str, size: Any) -> float:
    return reconstruction_error(c.aligned, Scheme.fit(c.aligned, name, size).reconstruct(c.aligned))
