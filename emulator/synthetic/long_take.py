"""Long takes of known truth: repetitions joined, with holds of random length between them, and sensor noise.

``python -m emulator.synthetic.long_take -o take.bvh`` writes one, to try the steps from a raw take to a library with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from emulator.composite.joining import joined
from emulator.geometry import sphere
from emulator.motion import Motion
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.take import Take
from emulator.segmenting.synthesis import take_of
from emulator.synthetic.tasks import TASKS, make

HOLD_S = (1.0, 4.0)
NOISE_M = 0.001


def long_take(
    motions: Sequence[Motion],
    rng: np.random.Generator,
    *,
    hold_s: tuple[float, float] | None = HOLD_S,
    noise_m: float = NOISE_M,
    rate_hz: float | None = None,
    ends: bool = True,
) -> tuple[Take, np.ndarray]:
    """The motions with holds before, between and after them: (Take, (N, 2) first and last frame of each).

    In a hold the body drifts from the posture in which one repetition ends to that in which the next begins.
    noise_m : standard deviation of each coordinate of each joint in each frame
    """
    rate_hz = rate_hz or round((len(motions[0].time_s) - 1) / motions[0].duration_s)
    bones_m = motions[0].bone_length_m
    parts, truth, frame = [], [], 0
    for i in range(len(motions) + 1):
        before = motions[i - 1] if i else motions[0]
        after = motions[i] if i < len(motions) else motions[-1]
        start = before.directions[-1] if i else after.directions[0]
        end = after.directions[0] if i < len(motions) else start
        if (ends or 0 < i < len(motions)) and hold_s is not None:
            n = round(rng.uniform(*hold_s) * rate_hz)
            parts.append(_hold(before, start, end, n, rate_hz, 0 if i == 0 else -1))
            frame += n
        if i < len(motions):
            n = round(motions[i].duration_s * rate_hz)
            truth.append((frame, frame + n))
            frame += n
            parts.append(motions[i])
    take = take_of(joined(parts, bone_length_m=bones_m, blend_s=0.2), rate_hz)
    noise = noise_m * rng.standard_normal(take.positions_m.shape)
    take = replace(take, positions_m=take.positions_m + noise, worker=motions[0].worker, trial="long")
    return take, np.array(truth)


def _hold(like: Motion, start: np.ndarray, end: np.ndarray, n: int, rate_hz: float, at: int) -> Motion:
    """A motion of n steps that drifts from one posture (B, 3) to another, as a minimum jerk."""
    s = np.linspace(0, 1, n + 1)
    share = s**3 * (10 - 15 * s + 6 * s**2)
    directions = np.stack([sphere.between(start, end, np.full(len(start), x)) for x in share])
    root = np.zeros((n + 1, 3))
    root[:, 2] = like.root_m[at, 2]
    return Motion(
        skeleton=like.skeleton,
        directions=directions,
        time_s=np.arange(n + 1) / rate_hz,
        root_m=root,
        yaw_rad=np.zeros(n + 1),
        bone_length_m=like.bone_length_m,
        mark_s=np.zeros(0),
        worker=like.worker,
        trial="hold",
        covariates={},
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Write a long take of one made person as BVH."""
    import argparse

    parser = argparse.ArgumentParser("python -m emulator.synthetic.long_take", description=main.__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--task", choices=sorted(TASKS), default="reach")
    parser.add_argument("-n", type=int, default=6, help="repetitions")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args(arguments)
    made = make(asked.task, 1, asked.n, seed=asked.seed)[0].motions
    take, _ = long_take([replace(motion, mark_s=np.zeros(0)) for motion in made], np.random.default_rng(asked.seed))
    write_bvh(take, asked.output)
    print(f"{asked.output}: {asked.n} times {asked.task} by one made person, {take.duration_s:.0f} s")


if __name__ == "__main__":
    main()
