"""One table for a class of recordings: schemes and two controls, judged on the half that they have not seen.

``Figures`` are what is told of each, ``MEANING`` says what they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.fitting.preprocessing import refuse_unsound
from emulator.judge.held_out import (
    COPIER,
    N_TIMES,
    RECORDED,
    SHAKER,
    USUAL,
    Drawer,
    Halves,
    HeldOutRow,
    draw_alike,
    drawer,
    emulated_rows,
    holm,
    in_halves,
    resampled_rows,
    too_few,
    unknown_names,
)
from emulator.judge.joint_limits import Plausibility, plausibility, recorded_positions_m, standing_deg
from emulator.judge.posture_tests import disco, novelty, reconstruction_error, roughness, temporal_roughness
from emulator.judge.sequence_distances import distances, energy_of_size, pooled, stream
from emulator.motion import MotionSet

NONE = float("nan")


@dataclass(frozen=True)
class Figures:
    """How a drawer stands beside the unseen half; NaN for what it does not have. ``MEANING`` says what each is."""

    energy: float = NONE
    p: float = NONE
    novelty: float = NONE
    temporal_roughness: float = NONE
    roughness: float = NONE
    error: float = NONE
    n_numbers: float = NONE
    log_likelihood: float = NONE
    log_likelihood_drawn: float = NONE
    duration_p: float = NONE
    marks_p: float = NONE
    outside_percent: float = NONE
    top_speed_m_per_s: float = NONE
    skate_cm: float = NONE


MEANING = {
    "energy": "energy distance of draws to the unseen half, over that of as many recordings; 1 is real",
    "p": "of DISCO, as many drawn as unseen (middle split); low where draws are told from the unseen half",
    "novelty": "distance to the nearest fitted recording over that of unseen ones; 1 is honest, near 0 a copy",
    "temporal_roughness": "way from posture to posture over that of the unseen half; 1 is as smooth",
    "roughness": "second differences over those of the unseen half, where trembling shows first",
    "error": "what the scheme's numbers lose of the unseen half: radians, summed over bones, mean over time",
    "n_numbers": "numbers that say one sequence of postures",
    "log_likelihood": "of the unseen half, nats a repetition; schemes compare only where numbers mean the same",
    "log_likelihood_drawn": "of the scheme's own draws; unseen ones far below it: the scheme is too narrow",
    "duration_p": "Kolmogorov-Smirnov p of durations, Holm over durations and marks (middle split)",
    "marks_p": "the same of the mark that fits least",
    "outside_percent": "share of frames with any joint beyond its limit; skin markers put recorded ones there, too",
    "top_speed_m_per_s": "highest joint speed among as many performances as the fitted half has",
    "skate_cm": "way of a planted foot over the floor in a performance",
}
MIDDLE = ("p", "duration_p", "marks_p")
"""Figures of which the middle of the splits is told, not the mean."""


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


CONTROLS = (COPIER, SHAKER)
HONEST = 0.8
"""Novelty from here on is that of unseen recordings; a control that reaches it would mean blind judges."""
SPLITS_OF_A_SEED = 1000

Progress = Callable[[int, int, str], None] | None
TaskFigures = tuple[dict[str, Figures], dict[str, list[str]]]


@dataclass(frozen=True, eq=False)
class Judged:
    """What was found: for each split, name of the drawer -> its figures; the recordings come first, controls last.

    notes : which figures are missing, and why, in words
    """

    task: str
    splits: tuple[dict[str, Figures], ...]
    notes: tuple[str, ...]

    @property
    def rows(self) -> dict[str, Figures]:
        """Name -> figures over the splits that have them: means, and of p values the middle."""
        return {name: _over([split[name] for split in self.splits]) for name in self.splits[0]}

    @property
    def passing_controls(self) -> list[str]:
        """Controls that novelty does not see through: it then says nothing of the others."""
        return [name for name in CONTROLS if not self.rows[name].novelty < HONEST]


def judge_held_out(
    motions: MotionSet,
    names: Sequence[str] = USUAL,
    n_splits: int = 5,
    seed: int = 0,
    progress: Progress = None,
    *,
    n_times: int = N_TIMES,
    n_drawn: int = N_DRAWN,
) -> Judged:
    """Judge schemes (of ``held_out.KNOWN``) on halves of each person's repetitions, dealt out ``n_splits`` times.

    Split k of seed s is dealt out by the number 1000 s + k; a scheme's figures do not depend on the other schemes.
    progress : called with (done, total, label)
    n_times  : points of the common clock, from 21; n_drawn : sequences of each drawer
    Raises ValueError for unknown names, repetitions with mistakes, or too few of them. A scheme that cannot be fitted
    or drawn from has a note in place of its figures.
    """
    refuse(motions, names)
    asked = (*dict.fromkeys(names), *CONTROLS)
    step = _Steps(n_splits * (1 + len(asked)), motions.task, progress)
    first = SPLITS_OF_A_SEED * seed
    with threadpool_limits(1, user_api="blas"):
        halves = (in_halves(motions, number, n_times) for number in range(first, first + n_splits))
        found = [_split(Unseen.of(one, n_drawn), asked, step) for one in halves]
    return Judged(motions.task, tuple(split for split, _ in found), _notes([wrong for _, wrong in found]))


def refuse(motions: MotionSet, names: Sequence[str] = USUAL) -> None:
    """Raises ValueError with all that speaks against judging, before anything is done."""
    wrong = unknown_names(names) + too_few(motions)
    try:
        refuse_unsound(motions)
    except ValueError as error:
        wrong.append(str(error))
    if wrong:
        raise ValueError("\n".join(wrong))


class _Steps:
    """Counts what is done, aloud."""

    def __init__(self, total: int, label: str, progress: Progress) -> None:
        self.done, self.total, self.label, self.progress = 0, total, label, progress

    def __call__(self) -> None:
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, self.total, self.label)


def _split(unseen: Unseen, asked: Sequence[str], step: _Steps) -> TaskFigures:
    """The figures of each drawer, and what went wrong with it."""
    found = {RECORDED: recorded_figures(unseen)}
    wrong = {RECORDED: [f"limits, speeds and feet: {unseen.why}"] if unseen.why else []}
    step()
    for name in asked:
        try:
            found[name], wrong[name] = figures(unseen, drawer(name, unseen.halves))
        except ValueError as error:
            found[name], wrong[name] = Figures(), [str(error)]
        step()
    return found, wrong


def _notes(wrong: Sequence[dict[str, list[str]]]) -> tuple[str, ...]:
    """For each drawer that lacks something, why in the first of its splits, and in how many."""
    notes = []
    for name in wrong[0]:
        lacking = [split[name] for split in wrong if split[name]]
        if lacking:
            splits = f"in {len(lacking)} of {len(wrong)} splits" if len(wrong) > 1 else "missing"
            notes.append(f"{name}: {splits}: {'; '.join(dict.fromkeys(lacking[0]))}")
    return tuple(notes)


def _over(splits: Sequence[Figures]) -> Figures:
    return Figures(**{field.name: _one(field.name, splits) for field in fields(Figures)})


def _one(name: str, splits: Sequence[Figures]) -> float:
    values = np.array([getattr(split, name) for split in splits])
    known = values[~np.isnan(values)]
    if not len(known):
        return float("nan")
    return float(np.median(known) if name in MIDDLE else np.mean(known))
