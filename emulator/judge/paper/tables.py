"""Tables 1 to 5 of Chen, Park & Srivastava, sec. 5, as rows: what they printed of their five classes, of any class."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator import sphere
from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.energy import pooled
from emulator.judge.paper.prepared import IS_TVF, OURS, PWI, SIEM, VAR, PaperClass
from emulator.judge.quantization import Quantization, sampled_postures
from emulator.judge.reconstruction import reconstruction_error
from emulator.judge.streams import stream
from emulator.judge.transitions import transition_distance, transition_matrices, uniform_transitions
from emulator.judge.two_level import TwoLevelRow, two_level
from emulator.judge.variability import variability
from emulator.schemes import Scheme

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
