"""Recordings in two halves of the same people; everything is learned from the first, the second is seen by nobody.

Who draws, fitted to the first half: our emulator, a scheme of the paper, and two controls. Durations and mark times
beside those of the second half. The table of all figures: ``held_out_table``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from emulator import schemes
from emulator.fitting.preprocessing import repaired
from emulator.fitting.registration import N_ALIGNED, moving_of, pace_components, penalised, postures_at, said_by
from emulator.fitting.settings import FitSettings
from emulator.geometry.alignment import align, align_to
from emulator.geometry.warps import clr, from_clr
from emulator.judge.comparison import jittered_resampler, resampler
from emulator.judge.posture_tests import joint_reconstruction
from emulator.model.emulator import SCHEME, SCHEMES, MotionEmulator
from emulator.model.performances import MotionPerformances
from emulator.model.reduction import JointPCA
from emulator.motion import MotionSet
from emulator.schemes import Scheme
from emulator.schemes.scheme import parsed

QUANTILES = (0.1, 0.25, 0.5, 0.75, 0.9)


@dataclass(frozen=True)
class HeldOutRow:
    """One quantity of one task: Kolmogorov-Smirnov distance and p, and emulated less held-out quantiles in per cent.

    Correct p by ``holm`` over a whole table; the quantiles are those of ``QUANTILES``.
    """

    task: str
    quantity: str
    n_fit: int
    n_held: int
    distance: float
    p: float
    quantile_error_percent: tuple[float, ...]


def split_within_workers(motions: MotionSet, seed: int) -> tuple[MotionSet, MotionSet]:
    """Each worker's repetitions dealt at random into two halves; an odd one out goes to the first."""
    rng = np.random.default_rng(seed)
    first: list[int] = []
    for worker in range(len(motions.workers)):
        mine = rng.permutation(np.flatnonzero(motions.worker_index == worker))
        first += mine[: (len(mine) + 1) // 2].tolist()
    rest = sorted(set(range(len(motions))) - set(first))
    return motions.subset(sorted(first)), motions.subset(rest)


def held_out_rows(motions: MotionSet, seed: int = 0, n_each: int = 400) -> list[HeldOutRow]:
    """Fit one half, draw ``n_each`` for each held-out one of the same worker; compare duration and marks."""
    fitted, held = split_within_workers(motions, seed)
    return emulated_rows(MotionEmulator.fit(fitted, seed=seed), len(fitted), held, np.random.default_rng(seed), n_each)


def emulated_rows(
    emulator: MotionEmulator, n_fit: int, held: MotionSet, rng: np.random.Generator, n_each: int = 400
) -> list[HeldOutRow]:
    """Duration and marks that the emulator draws for the same workers, beside those of the held-out motions."""
    drawn = [emulator.sample(n_each, rng, worker=m.worker) for m in held.motions]
    mark_s = np.concatenate([p.mark_s for p in drawn])
    return _rows(held, n_fit, np.concatenate([p.duration_s for p in drawn]), mark_s)


def resampled_rows(fitted: MotionSet, held: MotionSet, rng: np.random.Generator, n_each: int = 400) -> list[HeldOutRow]:
    """The control: duration and marks of the same workers' fitted repetitions, drawn again with replacement."""
    names = np.array([m.worker for m in fitted.motions])
    again = np.concatenate([rng.choice(np.flatnonzero(names == m.worker), n_each) for m in held.motions])
    return _rows(held, len(fitted), fitted.duration_s[again], fitted.mark_s[again])


def _rows(held: MotionSet, n_fit: int, duration_s: np.ndarray, mark_s: np.ndarray) -> list[HeldOutRow]:
    marks = [(name, mark_s[:, e], held.mark_s[:, e]) for e, name in enumerate(held.mark_names)]
    pairs = [("duration", duration_s, held.duration_s), *marks]
    return [_row(held.task, name, n_fit, emulated, seen) for name, emulated, seen in pairs]


def _row(task: str, quantity: str, n_fit: int, emulated: np.ndarray, seen: np.ndarray) -> HeldOutRow:
    from scipy.stats import ks_2samp

    test = ks_2samp(emulated, seen)
    error = 100 * (np.quantile(emulated, QUANTILES) / np.quantile(seen, QUANTILES) - 1)
    return HeldOutRow(
        task, quantity, n_fit, len(seen), float(test.statistic), float(test.pvalue), tuple(float(e) for e in error)
    )


def holm(p: Sequence[float]) -> np.ndarray:
    """p values corrected for all being looked at (Holm 1979): (M,) in, (M,) out, at most 1."""
    given = np.asarray(p, float)
    order = np.argsort(given)
    stepped = np.maximum.accumulate((len(given) - np.arange(len(given))) * given[order])
    corrected = np.empty(len(given))
    corrected[order] = np.minimum(stepped, 1.0)
    return corrected


def table_text(rows: Sequence[HeldOutRow]) -> str:
    """The table as lines of text, Holm's correction over all its rows."""
    head = "  ".join(f"q{int(100 * q):02d} %" for q in QUANTILES)
    lines = [f"{'task':20s} {'quantity':9s} {'fit':>3s} {'held':>4s}    KS      p  p Holm  {head}"]
    for row, corrected in zip(rows, holm([row.p for row in rows])):
        errors = "  ".join(f"{e:+5.1f}" for e in row.quantile_error_percent)
        counts = f"{row.n_fit:3d} {row.n_held:4d}"
        lines.append(
            f"{row.task:20s} {row.quantity:9s} {counts}  {row.distance:.3f}  {row.p:.3f}   {corrected:.3f}  {errors}"
        )
    return "\n".join(lines)


N_TIMES, N_KNOTS = 301, 20
FEWEST_HELD = 5
"""Held-out repetitions with which anything can be judged."""


@dataclass(frozen=True, eq=False)
class Halves:
    """fitted, held : the recordings; a (N, T, B, 3), b (M, T, B, 3) : postures on the common clock of the first.

    split : the number that decided who lies in which half
    """

    split: int
    fitted: MotionSet
    held: MotionSet
    a: np.ndarray
    b: np.ndarray

    @property
    def task(self) -> str:
        return self.fitted.task


def in_halves(motions: MotionSet, split: int, n_times: int = N_TIMES) -> Halves:
    """Dealt out person by person; template and reference posture are those of the first half."""
    fitted, held = split_within_workers(motions, split)
    first, second = (moving_of(repaired(half))[0] for half in (fitted, held))
    settings = FitSettings(SCHEME, None, n_times, N_KNOTS, 0.0, 0, "")
    penalty, _ = penalised(first, settings)
    grid = min(n_times, N_ALIGNED)
    found = align([m.directions for m in first.motions], n_times=grid, penalty=penalty, n_threads=1)
    theirs = [m.directions for m in second.motions]
    warps, _ = align_to(theirs, found.template, found.reference, penalty=penalty, n_threads=1)
    pace = pace_components(clr(found.warps, N_KNOTS))
    a, b = (_aligned(half, gamma, pace, n_times) for half, gamma in ((first, found.warps), (second, warps)))
    return Halves(split, fitted, held, a, b)


def too_few(motions: MotionSet) -> list[str]:
    """What speaks against halves of these recordings, in words; empty where nothing does."""
    each = np.bincount(motions.worker_index)
    n_held = int(np.sum(each // 2))
    if n_held >= FEWEST_HELD:
        return []
    found = f"{len(motions)} repetitions of {len(each)} people leave {n_held} to judge by (of each person every second)"
    return [f"{motions.task}: {found}; expected {FEWEST_HELD} or more: record people more than once"]


def _aligned(motions: MotionSet, warps: np.ndarray, pace: JointPCA, n_times: int) -> np.ndarray:
    """Postures along the warps that the model's pace coordinates can say."""
    smooth = from_clr(said_by(pace, clr(warps, N_KNOTS)), n_times)
    return np.stack([postures_at(m.directions, gamma) for m, gamma in zip(motions.motions, smooth)])


def draw_alike(emulator: MotionEmulator, motions: MotionSet, n: int, rng: np.random.Generator) -> MotionPerformances:
    """n performances by the known workers of ``motions``, in their proportions there, worker by worker.

    Raises ValueError for a worker that the emulator has not seen.
    """
    counts = apportioned(np.bincount(motions.worker_index), n)
    drawn = [emulator.sample(int(k), rng, worker=name).scores for name, k in zip(motions.workers, counts) if k]
    return emulator.performances(np.concatenate(drawn))


def apportioned(counts: np.ndarray, n: int) -> np.ndarray:
    """n shared out in the proportions of ``counts`` (W,), whole numbers, by largest remainder (first of equals)."""
    exact = n * counts / counts.sum()
    whole = np.floor(exact).astype(int)
    whole[np.argsort(whole - exact, kind="stable")[: n - whole.sum()]] += 1
    return whole


RECORDED = "recordings: fitted half"
COPIER, SHAKER = "control: resampled", "control: jittered"
USUAL = (SCHEME, "SIEM/SequentialPCA/MVG")
KNOWN = tuple(dict.fromkeys((*SCHEMES, *schemes.SCHEMES)))
"""All names there are. Those of ``emulator.model.emulator`` are whole emulators, with durations and bodies; the others
draw postures on the common clock only."""

Sequences = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Drawer:
    """draw : (n, rng) -> sequences (n, T, B, 3) on the common clock; what it cannot do is None

    reconstruct    : sequences (n, T, B, 3) as its ``n_numbers`` components give them back
    log_likelihood : (n, T, B, 3) -> (n,) nats
    emulator       : where durations, marks and bodies come from
    """

    name: str
    draw: Callable[[int, np.random.Generator], np.ndarray]
    n_numbers: int | None = None
    reconstruct: Sequences | None = None
    log_likelihood: Sequences | None = None
    emulator: MotionEmulator | None = None


def kind(name: str) -> str:
    """recordings, control, emulator or scheme."""
    if name == RECORDED:
        return "recordings"
    if name in (COPIER, SHAKER):
        return "control"
    return "emulator" if name in SCHEMES else "scheme"


def unknown_names(names: Sequence[str]) -> list[str]:
    """What is wrong with each name that is not ``KNOWN``, with the nearest right word."""
    return [_unknown(name) for name in dict.fromkeys(names) if name not in KNOWN]


def drawer(name: str, halves: Halves) -> Drawer:
    """The drawer of this name, or the control, fitted to the first half. Raises ValueError where it cannot be."""
    if name == COPIER:
        return Drawer(name, lambda n, rng: resampler(halves.a, n, rng))
    if name == SHAKER:
        return Drawer(name, lambda n, rng: jittered_resampler(halves.a, n, rng))
    return _emulated(name, halves) if name in SCHEMES else _scheme(name, halves)


def _emulated(name: str, halves: Halves) -> Drawer:
    """Draws of the people of the fitted half, each as often as there."""
    ours = MotionEmulator.fit(halves.fitted, scheme=name, n_times=halves.a.shape[1], seed=halves.split)
    return Drawer(
        name,
        lambda n, rng: ours.aligned_directions(draw_alike(ours, halves.fitted, n, rng).scores),
        ours.posture.n_components,
        lambda sequences: joint_reconstruction(ours.flatten, ours.posture, sequences),
        emulator=ours,
    )


def _scheme(name: str, halves: Halves) -> Drawer:
    fitted = Scheme.fit(halves.a, name, seed=halves.split)
    return Drawer(name, fitted.sample, fitted.n_coefficients, fitted.reconstruct, fitted.log_likelihood)


def _unknown(name: str) -> str:
    """The nearest whole name where it is one of ours that the paper's parts do not know, else what parts are wrong."""
    folded = {known.lower(): known for known in SCHEMES}
    near = get_close_matches(name.lower(), folded, n=1, cutoff=0.9)
    if near:
        return f"scheme: no {name!r}; did you mean {folded[near[0]]!r}?"
    try:
        parsed(name)
    except ValueError as wrong:
        return str(wrong)
    return f"scheme: no {name!r}"
