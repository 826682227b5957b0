"""Prints what it helps to know where a hand was at a mark, of recordings left out: ``python -m motion_evidence.reach``.

Each class with a mark and at least ``FEWEST`` recordings is fitted without one of them. What is foretold of it is the
mean of ``N_DRAWS`` draws (of times: of ``N_TIMED``), once with nothing known of it, once given where its joint was at
the mark. ``--family CLASS CLASS`` fits the classes together instead and asks for heights that none of them has.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from motion_evidence.family import show
from recordings import data_folder

from emulator import Motion, MotionEmulator, MotionSet, Target, read_motions
from emulator.model.targets import HandPlaces
from emulator.motion import turn

FEWEST, N_DRAWS, N_TIMES = 12, 24, 51
N_TIMED = 2000
"""Times are cheap: of 24 draws alone a mean of them is off by as much as a place tells."""
ERRORS = ("posture at the mark, m", "whole movement, m", "log duration")
QUARTILES = (0.25, 0.5, 0.75)
MISSED_M = 0.005
ROUNDING = 1e-9
"""Where a place tells nothing of a time, draws keep theirs but for the last bits."""


def classes() -> dict[str, Path]:
    """By name, the recordings that have a mark and are at least ``FEWEST``."""
    found = {}
    for path in sorted((data_folder() / "motion").glob("*.npz")):
        with np.load(path, allow_pickle=False) as data:
            if len(data["offsets"]) > FEWEST and any(name.startswith("ann_") for name in data):
                found[path.stem] = path
    return found


def left_out(path: Path, joint: str, most: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2, 3) ``ERRORS`` of at most ``most`` recordings, evenly taken, with nothing known and with the joint's place.

    And (n,) the share of draws that are farther than ``MISSED_M`` from that place.
    """
    motions = read_motions(path)
    chosen = np.unique(np.linspace(0, len(motions) - 1, min(most, len(motions))).astype(int))
    rows = [_errors(motions, int(i), joint) for i in chosen]
    return np.array([errors for errors, _ in rows]), np.array([missed for _, missed in rows])


def _errors(motions: MotionSet, i: int, joint: str) -> tuple[list[np.ndarray], float]:
    model = MotionEmulator.fit(motions.subset([k for k in range(len(motions)) if k != i]))
    at = HandPlaces.of(model, [Target(joint, 0, height_m=0.0)])
    true = motions.motions[i]
    own, log_s = _recorded(true, at), np.log(true.duration_s)
    place = own[0, at.joints[0][0]]
    asked = Target(joint, 0, height_m=max(place[2], 0.0), ahead_m=place[0], aside_m=place[1])
    rows, missed = [], 0.0
    for one in (model, model.given(asked)):
        drawn = one.sample(N_DRAWS, np.random.default_rng(0))
        moments = np.linspace(0.0, 1.0, N_TIMES) * drawn.duration_s[:, None]
        times_s = np.concatenate([np.zeros((N_DRAWS, 1)), drawn.mark_s[:, :1], moments], axis=1)
        bodies = drawn.positions_m(times_s)
        yaw_rad = drawn.path(np.zeros((N_DRAWS, 1)))[:, 0, 3]
        bodies = turn(bodies - _origin(bodies[:, :1], at), -yaw_rad[:, None, None])
        far = np.linalg.norm(bodies[:, 1:].mean(axis=0) - own, axis=-1).mean(axis=-1)
        missed = float(np.mean(np.linalg.norm(bodies[:, 1, at.joints[0][0]] - place, axis=-1) > MISSED_M))
        timed = one.sample(N_TIMED, np.random.default_rng(1)).duration_s
        rows.append(np.array([far[0], far[1:].mean(), abs(np.log(timed).mean() - log_s)]))
    return rows, missed


def _recorded(true: Motion, at: HandPlaces) -> np.ndarray:
    """Joints (1 + N_TIMES, J, 3) at the first mark and at even times, from where somebody stands in the first frame."""
    frames = true.positions_m()
    moments = np.concatenate([true.mark_s[:1], np.linspace(0.0, true.duration_s, N_TIMES)])
    place = moments / true.duration_s * (len(frames) - 1)
    low = np.minimum(place.astype(int), len(frames) - 2)
    share = (place - low)[:, None, None]
    bodies = frames[low] + share * (frames[low + 1] - frames[low])
    return bodies - _origin(frames[None, :1], at)[0]


def _origin(first: np.ndarray, at: HandPlaces) -> np.ndarray:
    """(n, 1, 1, 3) where bodies (n, 1, J, 3) stand, seen from above; recorded ones begin facing along x."""
    middle = first[:, :, at.stand].mean(axis=2, keepdims=True)
    middle[..., 2] = 0.0
    return middle


def _judged(joint: str, most: int, name: str) -> tuple[str, np.ndarray, np.ndarray]:
    return name, *left_out(classes()[name], joint, most)


def lines(name: str, errors: np.ndarray, missed: np.ndarray) -> list[str]:
    """Medians and quartiles, with nothing known and with the place, and in how many recordings it helped."""
    out = [f"{name}: {len(errors)} recordings left out, one at a time; {missed.mean():.0%} of the draws miss by 5 mm"]
    for e, what in enumerate(ERRORS):
        pairs = (np.quantile(errors[:, k, e], QUARTILES) for k in (0, 1))
        numbers = "  ->  ".join(f"{middle:.3f} ({low:.3f}-{high:.3f})" for low, middle, high in pairs)
        out.append(f"  {what:22} {numbers}   better in {np.mean(errors[:, 1, e] < errors[:, 0, e]):.0%}")
    return out


def main(arguments: Sequence[str] | None = None) -> int:
    """0 where postures at the mark are better in nine classes of ten and no class is worse in time, else 1."""
    parser = argparse.ArgumentParser(prog="python -m motion_evidence.reach", description=__doc__)
    parser.add_argument("classes", nargs="*", metavar="CLASS")
    parser.add_argument("--joint", default="right_wrist")
    parser.add_argument("--most", type=int, default=41, help="recordings of a class that are left out")
    parser.add_argument("--processes", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--family", action="store_true", help="the classes as one family, at heights from 0.3 to 1.7 m")
    options = parser.parse_args(arguments)
    known = classes()
    unknown = [name for name in options.classes if name not in known]
    if unknown or not known:
        parser.error(f"no class {unknown[0]!r}; known: {', '.join(known)}" if known else "needs ../shared/data")
    if options.family:
        if len(options.classes) < 2:
            parser.error(f"--family: found {len(options.classes)} classes, expected two or more")
        return show([known[name] for name in options.classes], options.joint)
    medians, start_s = [], time.monotonic()
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        jobs = [pool.submit(_judged, options.joint, options.most, name) for name in options.classes or known]
        for job in jobs:
            name, errors, missed = job.result()
            print("\n".join(lines(name, errors, missed)), flush=True)
            print(f"  {time.monotonic() - start_s:.0f} s", file=sys.stderr)
            medians.append(np.median(errors, axis=0))
    without, told = np.array(medians)[:, 0], np.array(medians)[:, 1]
    posture, slower = np.mean(told[:, 0] < without[:, 0]), np.sum(told[:, 2] > without[:, 2] + ROUNDING)
    print(f"posture at the mark better in {posture:.0%} of the classes; duration worse in {slower} of {len(medians)}")
    return int(posture < 0.9 or slower > 0)


if __name__ == "__main__":
    sys.exit(main())
