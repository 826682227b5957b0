"""Prints what it helps to be told where a hand was at a mark, of recordings left out: ``python -m motion_evidence.reach``.

Each class with a mark and at least ``FEWEST`` recordings is fitted without one of them; the most likely movement is then
compared with that recording, once with nothing known of it, once given where its wrist was at the mark.
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
from recordings import data_folder

from emulator import MotionEmulator, MotionSet, Target, read_motions
from emulator.model.mean_performance import mean_performance
from emulator.model.targets import HandPlaces

FEWEST = 12
N_TIMES = 51
ERRORS = ("joint at the mark, m", "posture at the mark, m", "whole movement, m", "log duration")
QUARTILES = (0.25, 0.5, 0.75)


def classes() -> dict[str, Path]:
    """By name, the recordings that have a mark and are at least ``FEWEST``."""
    found = {}
    for path in sorted((data_folder() / "motion").glob("*.npz")):
        with np.load(path, allow_pickle=False) as data:
            if len(data["offsets"]) > FEWEST and any(name.startswith("ann_") for name in data):
                found[path.stem] = path
    return found


def left_out(path: Path, joint: str, most: int) -> np.ndarray:
    """(n, 2, 4) ``ERRORS`` of at most ``most`` recordings, evenly taken, with nothing known and with the joint."""
    motions = read_motions(path)
    chosen = np.unique(np.linspace(0, len(motions) - 1, min(most, len(motions))).astype(int))
    return np.array([_errors(motions, int(i), joint) for i in chosen])


def _errors(motions: MotionSet, i: int, joint: str) -> list[np.ndarray]:
    rest = motions.subset([k for k in range(len(motions)) if k != i])
    model = MotionEmulator.fit(rest)
    at = HandPlaces.of(model, [Target(joint, 0, height_m=0.0)])
    true = motions.motions[i]
    frames = true.positions_m()
    clock = np.linspace(0.0, true.duration_s, len(frames))
    moments = np.concatenate([[0.0], true.mark_s[:1], np.linspace(0.0, true.duration_s, N_TIMES)])
    own = _between(frames, clock, moments)
    place = at.seen(own[None, :2], np.zeros(1))[0, 0]
    told = model.given(Target(joint, 0, height_m=place[2], ahead_m=place[0], aside_m=place[1]))
    return [
        _compared(one, at, own, place, true.duration_s) for one in (mean_performance(model), mean_performance(told))
    ]


def _compared(one: object, at: HandPlaces, own: np.ndarray, place: np.ndarray, duration_s: float) -> np.ndarray:
    length_s, mark_s = float(one.duration_s[0]), float(one.mark_s[0, 0])
    moments = np.concatenate([[0.0, mark_s], np.linspace(0.0, length_s, N_TIMES)])
    drawn = one.positions_m(moments)[0]
    far = np.linalg.norm(_from_feet(drawn, at) - _from_feet(own, at), axis=-1).mean(axis=-1)
    hand = at.seen(drawn[None, :2], np.zeros(1))[0, 0]
    return np.array([np.linalg.norm(hand - place), far[1], far[2:].mean(), abs(np.log(length_s / duration_s))])


def _from_feet(positions_m: np.ndarray, at: HandPlaces) -> np.ndarray:
    """Joints (T, J, 3) from where somebody stands in the first frame; recordings and draws begin facing along x."""
    origin = positions_m[0, at.stand].mean(axis=0)
    return positions_m - np.append(origin[:2], 0.0)


def _between(frames: np.ndarray, clock: np.ndarray, moments: np.ndarray) -> np.ndarray:
    low = np.clip(np.searchsorted(clock, moments, side="right") - 1, 0, len(clock) - 2)
    share = ((moments - clock[low]) / (clock[low + 1] - clock[low]))[:, None, None]
    return frames[low] + share * (frames[low + 1] - frames[low])


def _told(joint: str, most: int, name: str) -> tuple[str, int, np.ndarray]:
    path = classes()[name]
    errors = left_out(path, joint, most)
    return name, len(errors), errors


def lines(name: str, n: int, errors: np.ndarray) -> list[str]:
    """Medians and quartiles, with nothing known and with the joint, and how often it helped."""
    out = [f"{name}: {n} recordings left out, one at a time"]
    for e, what in enumerate(ERRORS):
        without, told = (np.quantile(errors[:, k, e], QUARTILES) for k in (0, 1))
        better = np.mean(errors[:, 1, e] < errors[:, 0, e])
        numbers = "  ->  ".join(f"{m:.3f} ({low:.3f}-{high:.3f})" for low, m, high in (without, told))
        out.append(f"  {what:24} {numbers}   better in {better:.0%}")
    return out


def main(arguments: Sequence[str] | None = None) -> int:
    """0 where postures at the mark are better in nine classes of ten and no class is worse in time, else 1."""
    parser = argparse.ArgumentParser(prog="python -m motion_evidence.reach", description=__doc__)
    parser.add_argument("classes", nargs="*", metavar="CLASS")
    parser.add_argument("--joint", default="right_wrist")
    parser.add_argument("--most", type=int, default=12, help="recordings of a class that are left out")
    parser.add_argument("--processes", type=int, default=min(2, os.cpu_count() or 1))
    options = parser.parse_args(arguments)
    known = classes()
    unknown = [name for name in options.classes if name not in known]
    if unknown or not known:
        parser.error(f"no class {unknown[0]!r}; known: {', '.join(known)}" if known else "needs ../shared/data")
    medians, start_s = [], time.monotonic()
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        jobs = [pool.submit(_told, options.joint, options.most, name) for name in options.classes or known]
        for job in jobs:
            name, n, errors = job.result()
            print("\n".join(lines(name, n, errors)), flush=True)
            medians.append(np.median(errors, axis=0))
            print(f"  {time.monotonic() - start_s:.0f} s", file=sys.stderr)
    without, told = np.array(medians)[:, 0], np.array(medians)[:, 1]
    posture, in_time = np.mean(told[:, 1] < without[:, 1]), np.sum(told[:, 3] > without[:, 3])
    print(f"posture at the mark better in {posture:.0%} of the classes; in time worse in {in_time} of {len(medians)}")
    return int(posture < 0.9 or in_time > 0)


if __name__ == "__main__":
    sys.exit(main())
