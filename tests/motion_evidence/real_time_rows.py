"""What is measured of one class of recordings in real time: fitted on all, on one half, and without each person."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from motion_evidence.drawers import OURS, PAPER, drawers
from motion_evidence.judged import PAPER_SCHEME
from recordings import data_folder
from threadpoolctl import threadpool_limits

from emulator import MotionEmulator, read_motions
from emulator.judge import compare
from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.coverage import LEVELS, QUANTITIES, covered
from emulator.judge.held_out import in_halves, split_within_workers
from emulator.judge.joint_speeds import energies, peak_ratio, share_too_fast_left_out
from emulator.judge.kinematic_test import FEWEST, kinematic_test
from emulator.judge.real_time import real_time
from emulator.judge.sequence_distances import stream
from emulator.model.performances import MotionPerformances
from emulator.motion import MotionSet
from emulator.schemes import Scheme

Row = dict[str, float]
CLASSES = (
    "hdm05_deposit_floor",
    "hdm05_grab_high",
    "hdm05_jog_circle",
    "hdm05_sneak_2steps",
    "hdm05_squat_once",
    "hdm05_throw_ball",
    "uiprmd_deep_squat",
    "uiprmd_inline_lunge",
    "uiprmd_leg_raise",
    "uiprmd_shoulder_abduction",
    "uiprmd_shoulder_scaption",
    "uiprmd_side_lunge",
    "uiprmd_sit_to_stand",
    "bandai2_walk",
    "bandai2_walk_turn_left",
)


FEET = ("wander_cm", "slide_cm", "sunk_mm", "unsupported", "planted")
EACH_TESTED = 3
"""Draws for each left-out recording that the classifier sees."""


def path_of(task: str) -> Path:
    return data_folder() / "motion" / f"{task}.npz"


def people_of(task: str) -> list[str]:
    """Who can be left out: nobody where there is one person only."""
    workers = read_motions(path_of(task)).workers
    return list(workers) if len(workers) > 1 else []


def in_sample(task: str, n_draws: int) -> Row:
    """Fitted on all recordings: speeds, jerk and feet of draws beside them, and what encode -> decode loses."""
    with threadpool_limits(1, user_api="blas"):
        motions = read_motions(path_of(task)).in_order()
        emulator = MotionEmulator.fit(motions)
        recorded, rate_hz = Clips.recorded(motions, emulator.skeleton), frame_rate_hz(motions)
        found: Row = {
            "n": len(motions),
            "people": len(motions.workers),
            "fast_left_out": share_too_fast_left_out(recorded, np.arange(len(motions))),
            "fast_people": share_too_fast_left_out(recorded, motions.worker_index),
        }
        known = Clips.drawn(drawn_alike(emulator, motions, n_draws, stream(4, task, "known")), rate_hz)
        new = Clips.drawn(emulator.sample(n_draws, stream(4, task, "new")), rate_hz)
        for name, clips in (("recorded", recorded), ("known", known), ("new", new)):
            figures = real_time(clips, recorded).figures
            found |= {f"{figure}_{name}": value for figure, value in figures.items() if np.isfinite(value)}
        seen = Clips.recorded(motions, emulator.skeleton, rigid=False)
        feet = real_time(seen, seen).figures
        found |= {f"{part}_seen": feet[part] for part in FEET if np.isfinite(feet[part])}
        return found | _decoded(emulator, recorded, seen)


def held_out(task: str, split: int, n_each: int) -> Row:
    """Fitted on half of everybody's repetitions: ``n_each`` draws for each of the other half, held against it."""
    with threadpool_limits(1, user_api="blas"):
        motions = read_motions(path_of(task)).in_order()
        fitted, held = split_within_workers(motions, split)
        emulator = MotionEmulator.fit(fitted)
        first, second = (Clips.recorded(half, emulator.skeleton) for half in (fitted, held))
        drawn = Clips.drawn(
            drawn_alike(emulator, held, n_each * len(held), stream(split, task, "held out")), frame_rate_hz(motions)
        )
        found: Row = {}
        for name, clips in (("drawn", drawn), ("halves", first)):
            found[f"places_{name}"], found[f"speeds_{name}"] = energies(clips, second)
        if len(second) < FEWEST:
            return found
        some = drawn[np.arange(len(drawn)) % n_each < EACH_TESTED]
        for name, clips in (("drawn", some), ("halves", first)):
            test = kinematic_test(second, clips, stream(split, task, "test"), n_permutations=0)
            found[f"auc_{name}"] = test.auc
        return found


def postures(task: str, split: int, n_draws: int) -> Row:
    """On the common clock, as ``motion_evidence.judged``: energy beside the paper's scheme, DISCO and novelty.

    The scheme has 10 x 30 components, or as many as the sequences span.
    """
    with threadpool_limits(1, user_api="blas"):
        made = in_halves(read_motions(path_of(task)), split)
        emulator = MotionEmulator.fit(made.fitted, n_times=made.a.shape[1], seed=split)
        paper = Scheme.fit(made.a, PAPER_SCHEME, dims=(10, min(30, len(made.a) - 1)))
        draws = drawers(made, emulator, paper)
        found: Row = {}
        for name, drawer in (("drawn", OURS), ("paper", PAPER)):
            rng = np.random.default_rng([split, 0])
            few = draws[drawer](len(made.b), rng)
            judged = compare(draws[drawer](n_draws, rng), few, made.a, made.b, rng, made.held.worker_index)
            found |= {
                f"energy_{name}": judged.energy_stratified,
                f"p_{name}": judged.p,
                f"novelty_{name}": judged.novelty,
            }
        return found


def left_out(task: str, name: str) -> Row:
    """Fitted without one person: whether new people's intervals hold him. A refused fit raises."""
    row = covered(read_motions(path_of(task)).in_order(), name)
    if row.refused:
        raise ValueError(row.refused)
    shares = {quantity: getattr(row, quantity) for quantity in QUANTITIES}
    return {f"{q}_{100 * level:.0f}": share[k] for q, share in shares.items() for k, level in enumerate(LEVELS)}


def drawn_alike(emulator: MotionEmulator, motions: MotionSet, n: int, rng: np.random.Generator) -> MotionPerformances:
    """At least n performances by the people of ``motions``, the same number for each repetition, in their order."""
    each = -(-n // len(motions))
    drawn = [emulator.sample(each, rng, worker=motion.worker).scores for motion in motions.motions]
    return emulator.performances(np.concatenate(drawn))


def encoded(emulator: MotionEmulator, recorded: Clips) -> Clips | None:
    """The training movements as their coordinates give them back, at the recordings' frames; None without them."""
    smoothed = emulator.workforce.smoothed
    if smoothed is None:
        return None
    again = emulator.performances(smoothed.scores)
    places = tuple(again[i].positions_m(n_times=len(p))[0] for i, p in enumerate(recorded.positions_m))
    return Clips(emulator.skeleton, places, again.duration_s)


def _decoded(emulator: MotionEmulator, recorded: Clips, seen: Clips) -> Row:
    """Peak jerk over the recorded, and the mean error over joints and times: to rigid bones, and to what was seen."""
    again = encoded(emulator, recorded)
    if again is None:
        return {}
    errors = _errors_mm(again, recorded)
    return {
        "decoded_jerk": peak_ratio(again, recorded, 3),
        "decoded_mm": float(errors.mean()),
        "decoded_worst_mm": float(errors.max()),
        "decoded_seen_mm": float(_errors_mm(again, seen).mean()),
        "decoded_auc": kinematic_test(recorded, again, np.random.default_rng(0), pairs=True, n_permutations=0).auc,
    }


def _errors_mm(again: Clips, recorded: Clips) -> np.ndarray:
    pairs = zip(again.positions_m, recorded.positions_m, strict=True)
    return np.array([1000 * np.linalg.norm(a - b, axis=-1).mean() for a, b in pairs])
