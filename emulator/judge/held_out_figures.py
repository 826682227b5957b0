"""The figures of one drawer against the half that nobody has seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from emulator.held_out import HeldOutRow, emulated_rows, holm, resampled_rows
from emulator.judge.alike import draw_alike
from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.drawers import COPIER, RECORDED, Drawer
from emulator.judge.energy import energy_of_size, pooled
from emulator.judge.halves import Halves
from emulator.judge.held_out_meaning import NONE, Figures
from emulator.judge.novelty import novelty
from emulator.judge.plausibility import Plausibility, plausibility, recorded_positions_m, standing_deg
from emulator.judge.reconstruction import reconstruction_error
from emulator.judge.roughness import roughness, temporal_roughness
from emulator.judge.streams import stream

N_DRAWN, N_BODY_TIMES = 400, 101
Found = dict[str, float]


@dataclass(frozen=True, eq=False)
class Unseen:
    """The unseen half and what all drawers are held against: distances among it and to the fitted half.

    n_drawn : sequences that a drawer is judged by; energy : of the fitted half's recordings
    bodies  : what is found of those of the fitted half, limits from ``standing``; None where it cannot, and ``why``
    """

    halves: Halves
    n_drawn: int
    among: np.ndarray
    to_fitted: np.ndarray
    energy: float
    standing: dict[str, float]
    bodies: Plausibility | None
    why: str

    @classmethod
    def of(cls, halves: Halves, n_drawn: int = N_DRAWN) -> Unseen:
        among, between, among_a = distances(halves.b), distances(halves.a, halves.b), distances(halves.a)
        people = halves.held.worker_index, halves.fitted.worker_index
        energy = energy_of_size(between, among_a, among, len(halves.a), *people)
        fitted = halves.fitted
        positions = list(recorded_positions_m(fitted, N_BODY_TIMES))
        standing: dict[str, float] = {}
        bodies, why = None, ""
        try:
            standing = standing_deg(fitted.skeleton, positions)
            bodies = plausibility(fitted.skeleton, positions, fitted.duration_s, standing)
        except ValueError as wrong:
            why = str(wrong)
        return cls(halves, n_drawn, among, between.T, energy, standing, bodies, why)


def recorded_figures(unseen: Unseen) -> Figures:
    """Of the fitted half's own recordings: what a perfect drawer would have. Novelty leaves each one itself out."""
    halves = unseen.halves
    rng = stream(halves.split, RECORDED)
    found = _postures(unseen, halves.a, halves.a, rng, halves.fitted.worker_index)
    others = distances(halves.a) + np.diag(np.full(len(halves.a), np.inf))
    return Figures(**(found | {"novelty": novelty(others, unseen.to_fitted)} | _bodies(unseen.bodies)))


def figures(unseen: Unseen, drawer: Drawer) -> tuple[Figures, list[str]]:
    """The figures, and why some that it should have are missing, in words."""
    rng = stream(unseen.halves.split, drawer.name)
    wrong: list[str] = []
    found: Found = {} if drawer.n_numbers is None else {"n_numbers": float(drawer.n_numbers)}
    for part in (_drawn, _lost, _likely, _timed, _embodied):
        found |= _tried(part, unseen, drawer, rng, wrong)
    return Figures(**found), wrong


def _tried(part: Callable[..., Found], unseen: Unseen, drawer: Drawer, rng: np.random.Generator, wrong: list) -> Found:
    try:
        return part(unseen, drawer, rng)
    except ValueError as error:
        wrong.append(str(error))
        return {}


def _drawn(unseen: Unseen, drawer: Drawer, rng: np.random.Generator) -> Found:
    few = drawer.draw(len(unseen.halves.b), rng)
    found = _postures(unseen, drawer.draw(unseen.n_drawn, rng), few, rng)
    if drawer.log_likelihood is not None:
        found["log_likelihood_drawn"] = float(np.mean(drawer.log_likelihood(few)))
    return found


def _postures(
    unseen: Unseen, drawn: np.ndarray, few: np.ndarray, rng: np.random.Generator, strata: np.ndarray | None = None
) -> Found:
    """Judges of sequences (n, T, B, 3), and for DISCO of a few."""
    halves, among = unseen.halves, unseen.among
    size = len(halves.a), halves.held.worker_index, strata
    tested = pooled(distances(few, halves.b), distances(few), among)
    energy = energy_of_size(distances(drawn, halves.b), distances(drawn), among, *size)
    return {
        "energy": energy / unseen.energy if unseen.energy > 0 else NONE,
        "p": disco(tested, len(few), rng).p,
        "novelty": novelty(distances(drawn, halves.a), unseen.to_fitted),
        "temporal_roughness": temporal_roughness(drawn) / temporal_roughness(halves.b),
        "roughness": roughness(drawn) / roughness(halves.b),
    }


def _lost(unseen: Unseen, drawer: Drawer, rng: np.random.Generator) -> Found:
    if drawer.reconstruct is None:
        return {}
    return {"error": reconstruction_error(unseen.halves.b, drawer.reconstruct(unseen.halves.b))}


def _likely(unseen: Unseen, drawer: Drawer, rng: np.random.Generator) -> Found:
    if drawer.log_likelihood is None:
        return {}
    return {"log_likelihood": float(np.mean(drawer.log_likelihood(unseen.halves.b)))}


def _timed(unseen: Unseen, drawer: Drawer, rng: np.random.Generator) -> Found:
    """Durations and marks: of the emulator, and of repetitions drawn again."""
    fitted, held = unseen.halves.fitted, unseen.halves.held
    rows: list[HeldOutRow] = []
    if drawer.emulator is not None:
        rows = emulated_rows(drawer.emulator, len(fitted), held, rng)
    elif drawer.name == COPIER:
        rows = resampled_rows(fitted, held, rng)
    corrected = holm([row.p for row in rows])
    marks = {"marks_p": float(corrected[1:].min())} if len(rows) > 1 else {}
    return {"duration_p": float(corrected[0]), **marks} if rows else {}


def _embodied(unseen: Unseen, drawer: Drawer, rng: np.random.Generator) -> Found:
    if drawer.emulator is None or unseen.bodies is None:
        return {}
    fitted = unseen.halves.fitted
    drawn = draw_alike(drawer.emulator, fitted, len(fitted), rng)
    positions = list(drawn.positions_m(n_times=N_BODY_TIMES))
    return _bodies(plausibility(fitted.skeleton, positions, drawn.duration_s, unseen.standing))


def _bodies(found: Plausibility | None) -> Found:
    if found is None:
        return {}
    return {
        "outside_percent": 100 * found.frames_outside,
        "top_speed_m_per_s": float(found.speed_m_per_s.max()),
        "skate_cm": float(found.skate_cm.mean()),
    }
