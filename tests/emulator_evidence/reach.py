"""Prints how made people at shelves of any height are met by an emulator that was fitted to others of them.

``python -m emulator_evidence.reach``: 20 heights for people of 5 statures, against fresh made movements of known truth
by people whose bones are as long; then how many of 10,000 draws are off their shelf, too fast, or slide.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, replace

import numpy as np

from emulator import MotionEmulator, MotionSet, Target
from emulator.judge.clips import Clips
from emulator.judge.feet import footing, standing_m
from emulator.judge.joint_speeds import peak_ratio, share_too_fast
from emulator.motion import Motion
from emulator.people.workers import WorkerEffect
from emulator.synthetic import RATE_HZ
from emulator.synthetic.choreography import Body
from emulator.synthetic.shelf import LOWEST_M, MARK, Reacher, crew, highest_m, make_shelf, median_duration_s

SHORTEST_M, TALLEST_M = 1.5, 2.0
N_PEOPLE, N_EACH, N_TIMES = 24, 10, 21
DRAWN_PEOPLE, DRAWN_EACH, N_TIMED = 96, 3, 100
WORST_BIAS, WORST_ENERGY = 0.03, 0.1
N_CLIPS = 50
HIT_M, SHARE_M, SHARE_LOG_S = 0.005, 0.1, 0.1
"""A joint's 10 cm count as much as a tenth of the time."""


@dataclass(frozen=True, eq=False)
class Seen:
    """n movements: bodies (n, 1 + N_TIMES, J, 3) at the mark and at even times, seconds (n,)."""

    bodies: np.ndarray
    duration_s: np.ndarray

    @property
    def rows(self) -> np.ndarray:
        """(n, D) in which distances are those of movements: posture at the mark, whole movement, log duration."""
        n, n_joints = len(self.bodies), self.bodies.shape[2]
        at_mark, whole = self.bodies[:, 0].reshape(n, -1), self.bodies[:, 1:].reshape(n, -1)
        scaled = at_mark / np.sqrt(n_joints) / SHARE_M, whole / np.sqrt(n_joints * N_TIMES) / SHARE_M
        return np.concatenate([*scaled, np.log(self.duration_s)[:, None] / SHARE_LOG_S], axis=1)

    def angles_deg(self, names: tuple[str, ...]) -> np.ndarray:
        """(n, 2) flexion of the trunk and elevation of the right upper arm against it, at the mark."""
        joint = {name: self.bodies[:, 0, i] for i, name in enumerate(names)}
        trunk, arm = joint["neck"] - joint["pelvis"], joint["right_elbow"] - joint["right_shoulder"]
        size = np.linalg.norm(trunk, axis=1)
        lifted = -np.sum(arm * trunk, axis=1) / size / np.linalg.norm(arm, axis=1)
        return np.degrees(np.arccos(np.stack([trunk[:, 2] / size, lifted], axis=1)))


def seen_of(motions: MotionSet) -> Seen:
    """Of made movements."""
    return Seen(np.stack([_bodies(one) for one in motions.motions]), motions.duration_s)


def _bodies(one: Motion) -> np.ndarray:
    frames = one.positions_m()
    moments = np.concatenate([one.mark_s / one.duration_s, np.linspace(0.0, 1.0, N_TIMES)]) * (len(frames) - 1)
    low = np.minimum(moments.astype(int), len(frames) - 2)
    share = (moments - low)[:, None, None]
    return frames[low] + share * (frames[low + 1] - frames[low])


def drawn_of(emulator: MotionEmulator, effects: list[object], n: int) -> Seen:
    """Of n draws of each worker, each worker with random numbers of his own."""
    parts = []
    for i, effect in enumerate(effects):
        drawn = emulator.sample(n, np.random.default_rng([9, i]), worker=effect)
        even = np.linspace(0.0, 1.0, N_TIMES) * drawn.duration_s[:, None]
        parts.append((drawn.positions_m(np.concatenate([drawn.mark_s, even], axis=1)), drawn.duration_s))
    bodies, duration_s = zip(*parts)
    return Seen(np.concatenate(bodies), np.concatenate(duration_s))


def energy(a: np.ndarray, b: np.ndarray) -> float:
    """Energy distance of rows (n, D) and (m, D), without bias (Szekely & Rizzo 2013)."""
    from scipy.spatial.distance import cdist

    n, m = len(a), len(b)
    within = cdist(a, a).sum() / (n * (n - 1)) + cdist(b, b).sum() / (m * (m - 1))
    return float(2.0 * cdist(a, b).mean() - within)


def balanced(people: list[Reacher]) -> list[Reacher]:
    """The same people with habits that average out: else a dozen people are 2 % slower than anybody, by luck."""
    middle = np.mean([person.habit for person in people], axis=0)
    return [replace(person, habit=person.habit - middle) for person in people]


def alike(emulator: MotionEmulator, stature_m: float) -> list[WorkerEffect]:
    """Drawn people of this stature who are on average what anybody of it is."""
    drawn = [emulator.draw_worker(np.random.default_rng([7, i]), {"height_m": stature_m}) for i in range(DRAWN_PEOPLE)]
    apart = emulator.new_worker(height_m=stature_m).z - np.mean([person.z for person in drawn], axis=0)
    return [replace(person, z=person.z + apart) for person in drawn]


def in_bodies(emulator: MotionEmulator, people: list[WorkerEffect], stature_m: float) -> list[WorkerEffect]:
    """The same people with bones as long as those of made people of this stature.

    What a stature tells of bones is another law than that of reach, and half a per cent of them, as it is off at most
    here, turns an arm overhead by two degrees.
    """
    made = make_shelf([Reacher(Body(stature_m), np.zeros(4))], 1, rng=np.random.default_rng(0)).motions[0]
    own_m = emulator.bone_length_m(np.array([person.z for person in people])).sum(axis=1)
    return [replace(one, scale=float(made.bone_length_m.sum() / m)) for one, m in zip(people, own_m)]


def rows(
    emulator: MotionEmulator,
    statures_m: np.ndarray,
    n_heights: int,
    rng: np.random.Generator,
    *,
    as_asked: bool = False,
) -> np.ndarray:
    """A row a height and stature: both, log seconds made and drawn, angles made (2) and drawn (2), the same of their
    standard deviations, energy distances given the height and not.

    as_asked : with the bones that the emulator gives people of a stature, not those of made people
    """
    names, out = emulator.skeleton.names, []
    for stature_m in statures_m.tolist():
        people = balanced([Reacher.of(stature_m, rng) for _ in range(N_PEOPLE)])
        asked = alike(emulator, stature_m)
        alike_long = in_bodies(emulator, asked, stature_m)
        off = np.mean([one.scale for one in asked]) / np.mean([one.scale for one in alike_long]) - 1.0
        print(f"{stature_m:5.3f} m tall: bones {off:+.2%} off{'' if as_asked else ' before they are made alike'}")
        effects = asked if as_asked else alike_long
        anywhere = drawn_of(emulator, effects, DRAWN_EACH).rows
        for height_m in np.linspace(LOWEST_M, highest_m(stature_m), n_heights):
            made = seen_of(make_shelf(people, N_EACH, rng=rng, heights_m=[height_m]))
            given = emulator.given(Target("hands", MARK, height_m=float(height_m)))
            drawn = drawn_of(given, effects, DRAWN_EACH)
            timed = [given.sample(N_TIMED, np.random.default_rng([8, i]), worker=e) for i, e in enumerate(effects)]
            log_s = np.log(made.duration_s), np.concatenate([np.log(one.duration_s) for one in timed])
            angles = made.angles_deg(names), drawn.angles_deg(names)
            moments = [
                np.append(f(time), f(angle, axis=0)) for f in (np.mean, np.std) for time, angle in zip(log_s, angles)
            ]
            moments[0][0] = np.log(median_duration_s(np.array(height_m / people[0].body.scale)))
            far = energy(drawn.rows, made.rows), energy(anywhere, made.rows)
            out.append(np.concatenate([[stature_m, height_m], *moments, far]))
            print(_line(out[-1]), flush=True)
    return np.array(out)


def _line(row: np.ndarray) -> str:
    made, drawn, made_sd, drawn_sd = row[2:14].reshape(4, 3)
    words = [f"{row[0]:5.3f} m tall, shelf {row[1]:4.2f} m: {np.exp(made[0]):4.2f} -> {np.exp(drawn[0]):4.2f} s"]
    for i, name in ((1, "trunk"), (2, "upper arm")):
        words.append(f"{name} {made[i]:5.1f} ({made_sd[i]:.1f}) -> {drawn[i]:5.1f} ({drawn_sd[i]:.1f}) deg")
    return ", ".join(words) + f", energy {row[14]:.3f} of {row[15]:.3f}: {row[14] / row[15]:.3f}"


def summary(found: np.ndarray) -> list[str]:
    """What holds of rows (F, cases, 16) of F fits: errors in shares of the mean time and of the range of each angle.

    Of each fit; and, where there are several, their mean over fits, which is bias, beside its standard error: the rest
    is the luck of the recordings that were fitted.
    """
    made, drawn = found[..., 2:5], found[..., 5:8]
    off = (drawn - made) / np.append(1.0, np.ptp(made[..., 1:], axis=(0, 1)))
    off[..., 0] = np.expm1(off[..., 0])
    out = []
    for k, name in enumerate(("time", "trunk flexion", "upper arm elevation")):
        out.append(f"{name}: error of a fit {_shares(np.abs(off[..., k]))}")
        if len(off) > 1:
            luck = off[..., k].std(axis=0, ddof=1)
            error = f"standard error {luck.mean() / np.sqrt(len(off)):.1%}, between fits {luck.mean():.1%}"
            out.append(f"  bias over {len(off)} fits {_shares(np.abs(off[..., k].mean(axis=0)))}; {error}")
    ratio = found[..., 14] / found[..., 15]
    held = np.mean(ratio <= WORST_ENERGY)
    return [*out, f"energy distance: median {np.median(ratio):.3f}, largest {ratio.max():.3f}; {held:.0%} within 0.1"]


def _shares(error: np.ndarray) -> str:
    held = np.mean(error <= WORST_BIAS)
    nine = np.quantile(error, 0.9)
    words = f"mean {error.mean():.1%}, 90 % of them within {nine:.1%}, largest {error.max():.1%}"
    return f"{words}; {held:.0%} within {WORST_BIAS:.0%}"


def bodies_of(emulator: MotionEmulator, motions: MotionSet, n: int) -> list[str]:
    """How many of n draws at 20 heights are off the shelf, too fast, or slide, beside the recordings and free draws."""
    wrists = [emulator.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
    heights = np.linspace(LOWEST_M, highest_m(1.6), 20)
    off, given_clips, free_clips = [], [], []
    for i, height_m in enumerate(heights):
        worker = emulator.draw_worker(np.random.default_rng([11, i]))
        for one, clips in (
            (emulator.given(Target("hands", MARK, height_m=float(height_m))), given_clips),
            (emulator, free_clips),
        ):
            drawn = one.sample(n // len(heights), np.random.default_rng([12, i]), worker=worker)
            clips.append(Clips.drawn(drawn[:N_CLIPS], RATE_HZ))
            if one is not emulator:
                blocks = [drawn[start : start + 100] for start in range(0, len(drawn), 100)]
                places = [some.positions_m(some.mark_s)[:, 0, wrists, 2].mean(axis=1) for some in blocks]
                off.append(np.abs(np.concatenate(places) - height_m))
    off_m, recorded = np.concatenate(off), Clips.recorded(motions)
    out = [
        f"{len(off_m)} draws: farthest from the shelf {off_m.max() * 1e3:.2f} mm, {np.sum(off_m > HIT_M)} beyond 5 mm"
    ]
    for name, parts in (("given", given_clips), ("free", free_clips)):
        clips = Clips(
            emulator.skeleton,
            tuple(place for part in parts for place in part.positions_m),
            np.concatenate([part.duration_s for part in parts]),
        )
        feet, jerk = footing(clips, standing_m(recorded)), peak_ratio(clips, recorded, 3)
        out.append(
            f"{name}: too fast {share_too_fast(clips, recorded):.1%}, peak jerk {jerk:.2f} of the recorded, "
            f"feet slide {np.nanmean(feet.slide_cm):.2f} cm, stray {np.nanmean(feet.wander_cm):.2f} cm"
        )
    own = footing(recorded, standing_m(recorded))
    return [*out, f"recorded: slide {np.nanmean(own.slide_cm):.2f} cm, stray {np.nanmean(own.wander_cm):.2f} cm"]


def main() -> int:
    """0 where every draw is within 5 mm of its shelf, else 1."""
    parser = argparse.ArgumentParser(prog="python -m emulator_evidence.reach", description=__doc__)
    parser.add_argument("--heights", type=int, default=20)
    parser.add_argument("--statures", type=int, default=5, help=f"from {SHORTEST_M} to {TALLEST_M} m")
    parser.add_argument("--as-asked", action="store_true", help="bones as the emulator gives them to a stature")
    parser.add_argument("--fits", type=int, default=1, help="sets of recordings that are made and fitted")
    parser.add_argument("--draws", type=int, default=10000)
    options = parser.parse_args()
    statures_m, found = np.linspace(SHORTEST_M, TALLEST_M, options.statures), []
    for seed in range(options.fits):
        rng = np.random.default_rng(seed)
        motions = make_shelf(balanced(crew(12, rng)), 20, rng=rng)
        emulator = MotionEmulator.fit(motions)
        found.append(rows(emulator, statures_m, options.heights, rng, as_asked=options.as_asked))
    print("\n".join(summary(np.array(found))), flush=True)
    said = bodies_of(emulator, motions, options.draws)
    print("\n".join(said))
    return int(" 0 beyond 5 mm" not in said[0])


if __name__ == "__main__":
    sys.exit(main())
