"""Made work in which some repetitions pause, with the truth about the pauses."""

from dataclasses import dataclass, replace

import numpy as np

from emulator.geometry import sphere
from emulator.motion import MotionSet
from emulator.synthetic.tasks import make

CLOCK = np.linspace(0, 1, 201)


def pause(motion, share, n_frames, noise_rad=0.0, rng=None):
    """The motion standing still for ``n_frames`` frames after the one at ``share``, and that frame's number."""
    n_times = len(motion.time_s)
    at = round(share * (n_times - 1))
    frames = np.concatenate([np.arange(at + 1), np.full(n_frames, at), np.arange(at + 1, n_times)])
    step_s = motion.duration_s / (n_times - 1)
    later = motion.mark_s > motion.time_s[at] + 1e-9
    paused = replace(
        motion,
        directions=motion.directions[frames],
        time_s=np.arange(len(frames)) * step_s,
        root_m=motion.root_m[frames],
        yaw_rad=motion.yaw_rad[frames],
        mark_s=motion.mark_s + later * n_frames * step_s,
        stretch=None,
    )
    return shaken(paused, noise_rad, rng), at


def shaken(motion, noise_rad, rng):
    """The motion with white tracking noise on every direction."""
    if noise_rad == 0:
        return motion
    directions = sphere.normalise(motion.directions + noise_rad * rng.normal(size=motion.directions.shape))
    return replace(motion, directions=directions)


@dataclass(frozen=True)
class Paused:
    """motions; original ones without pauses; their truth; dwell_s (N,), 0 where a repetition does not pause."""

    motions: MotionSet
    original: MotionSet
    truth: object
    dwell_s: np.ndarray


def paused_work(task, clock, n_workers=5, n_repetitions=6, share=0.4, seed=1, spread=0.0, noise_rad=0.0):
    """Made work of which a share pauses for 60 frames (lognormal ``spread``) at ``clock`` of the common clock."""
    original, truth = make(task, n_workers, n_repetitions, seed=seed)
    rng = np.random.default_rng([seed, 1])
    motions, dwell_s = [], np.zeros(len(original))
    for i, motion in enumerate(original.motions):
        if rng.uniform() < share:
            n_frames = round(60 * np.exp(spread * rng.normal()))
            dwell_s[i] = n_frames * motion.duration_s / (len(motion.time_s) - 1)
            motion, _ = pause(motion, np.interp(clock, CLOCK, truth.warps[i]), n_frames, noise_rad, rng)
        else:
            motion = shaken(motion, noise_rad, rng)
        motions.append(motion)
    return Paused(replace(original, motions=tuple(motions)), original, truth, dwell_s)
