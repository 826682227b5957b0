"""Motions one after another: what adds up, what is continuous, which feet stay, what it costs; recorded and drawn."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from emulator.composite.joining import JoinError, joined, posture_gap_rad
from emulator.composite.task import CompositeEmulator, Part
from emulator.model.library import MotionLibrary
from emulator.motion import Motion, motion_from_positions
from emulator.recordings import read_motions
from opsim.report.sections.motions import draw_strips
from opsim.shipped import shipped_folder
from tests.take_evidence.composite_picture import draw_joins

RECORDED = ("uiprmd_deep_squat", "uiprmd_sit_to_stand", "uiprmd_side_lunge")
WALK_M = 3.0
MOST_SHUFFLE_CM = 4.0
MOST_COST = 1.2
Line = tuple[str, str, bool]


def evidence(motion: Path, out: Path) -> Iterator[Line]:
    """(claim, found, holds); the picture of the kit goes into ``out``."""
    yield from _recorded(motion)
    kit = _kit()
    worker = kit.draw_worker(np.random.default_rng(1), {"height_m": 1.72, "walk_m_per_s": 1.2})
    drawn = kit.sample(24, np.random.default_rng(2), worker=worker)
    yield from _sums(kit, worker, drawn)
    yield from _speeds(kit, drawn)
    yield from _feet(kit, drawn)
    yield from _cost(kit, worker)
    out.mkdir(parents=True, exist_ok=True)
    title = "reach, pick, walk 3 m, place, fasten x 4"
    draw_strips(kit, out / "kit.svg", n_samples=2, n_figures=20, title=title)
    draw_joins(drawn[0], kit.body_part, kit.body_part, out / "joins.svg")


def _recorded(motion: Path) -> Iterator[Line]:
    """Halves of recorded repetitions, and repetitions of one person one after the other."""
    sets = [read_motions(motion / f"{name}.npz", where="cov_correct==1") for name in RECORDED]
    motions = [one for some in sets for one in some.motions]
    lost = [_halves_lost_m(one) for one in motions]
    yield (
        f"the halves of {len(motions)} recorded repetitions, joined, are the repetition",
        f"median {np.median(lost) * 1e3:.1e} mm, worst {max(lost) * 1e3:.2g} mm",
        max(lost) < 2e-3,
    )
    jumps, gaps, refused = [], [], 0
    for before, after in (p for some in sets for p in pairwise(some.motions) if p[0].worker == p[1].worker):
        try:
            whole = joined([before, after])
        except JoinError:
            refused += 1
            continue
        gaps.append(np.degrees(posture_gap_rad(before, after)))
        jumps.append(_jump(whole, len(before.time_s) - 1) / max(_usual_jump(before), _usual_jump(after)))
    claim = f"{len(jumps)} pairs of repetitions of one person, up to {max(gaps):.0f} degrees apart, are joined"
    found = f"median {np.median(jumps):.2f}, worst {max(jumps):.2f}; {refused} pairs refused"
    yield f"{claim}; the speed's jump at the seam over the largest within them", found, max(jumps) < 1.01


def _halves_lost_m(one: Motion) -> float:
    positions, half = one.positions_m(), len(one.time_s) // 2
    rate_hz = 1.0 / float(one.time_s[1])
    parts = [
        motion_from_positions(one.skeleton, some, rate_hz, worker=one.worker, trial=one.trial)
        for some in (positions[: half + 1], positions[half:])
    ]
    again = joined(parts, bone_length_m=one.bone_length_m)
    return float(np.abs(again.positions_m(world=True) - positions).max())


def _speed(one: Motion) -> np.ndarray:
    return np.diff(one.directions, axis=0) / np.diff(one.time_s)[:, None, None]


def _jump(one: Motion, frame: int) -> float:
    speed = _speed(one)
    return float(np.linalg.norm(speed[frame] - speed[frame - 1], axis=-1).max())


def _usual_jump(one: Motion) -> float:
    return float(np.linalg.norm(np.diff(_speed(one), axis=0), axis=-1).max())


def _kit() -> CompositeEmulator:
    bench = MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")
    walk = Part("walk", _walk(), {"distance_m": WALK_M})
    before, after = ([Part(name, bench[name]) for name in names] for names in (("reach", "pick"), ("place",)))
    return CompositeEmulator("kit", (*before, walk, *after, *[Part("fasten", bench["fasten"])] * 4))


def _walk() -> Any:
    file = shipped_folder() / "libraries" / "walking.npz"
    if file.exists():
        return MotionLibrary.load(file)["walk"]
    from emulator.cyclic.model import CyclicEmulator
    from emulator.synthetic.walking import make_walks

    return CyclicEmulator.fit(make_walks(4, 3, seed=1)[0])


def _sums(kit: CompositeEmulator, worker: Any, drawn: Any) -> Iterator[Line]:
    lost_s = np.abs(drawn.duration_s - sum(part.duration_s for part in drawn.parts)).max()
    yield "the duration of a kit is the sum of its parts'", f"to {lost_s:.1e} s", lost_s < 1e-9
    many = kit.sample(2000, np.random.default_rng(3), worker=worker).duration_s
    mean_s, error_s = kit.mean_duration_s(worker), many.std() / np.sqrt(many.size)
    found = f"{many.mean():.2f} s drawn (standard error {error_s:.2f} s), {mean_s:.2f} s by the parts' means"
    yield "its mean is the sum of their means", found, abs(many.mean() - mean_s) < 4 * error_s + 0.005 * mean_s
    gone_m = np.linalg.norm(np.diff(drawn.root_m(times_s=drawn.stop_s[:, 1:3])[..., :2], axis=1)[:, 0], axis=-1)
    claim = f"a walk of {WALK_M:g} m inside a kit goes {WALK_M:g} m"
    yield claim, f"{gone_m.min():.3f} to {gone_m.max():.3f} m", np.abs(gone_m - WALK_M).max() < 0.05
    alone = drawn[5].positions_m(n_times=50) - drawn.positions_m(n_times=50)[5:6]
    yield "a row alone is the row of the block", f"to {np.abs(alone).max():.1e} m", np.abs(alone).max() < 1e-10


def _speeds(kit: CompositeEmulator, drawn: Any) -> Iterator[Line]:
    step_s = 1e-3
    times_s = drawn.stop_s[:, :-1, None] + step_s * np.array([-1.0, 0.0, 1.0])
    near = drawn.directions(times_s=times_s.reshape(len(drawn), -1)).reshape(len(drawn), -1, 3, kit.skeleton.n_bones, 3)
    jump = np.linalg.norm(np.diff(near, n=2, axis=2), axis=-1).max() / step_s
    widest = np.degrees(drawn.gaps_rad().max())
    claim = f"directions turn through joins up to {widest:.0f} degrees wide without a jump of speed"
    yield claim, f"at most {jump:.3f} rad/s in a millisecond", jump < 0.1


def _feet(kit: CompositeEmulator, drawn: Any) -> Iterator[Line]:
    """How far the foot that stands best moves on the floor through each join."""
    moved_cm = []
    feet = [kit.skeleton.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("ankle", "toe")]
    for k, (before_s, after_s) in enumerate(drawn.windows_s):
        share = np.linspace(0, 1, 41)
        times_s = drawn.stop_s[:, k, None] - before_s[:, None] + (before_s + after_s)[:, None] * share
        level = drawn.positions_m(times_s=times_s)[:, :, feet, :2]
        moved_cm.append(100 * np.linalg.norm(np.diff(level, axis=1), axis=-1).sum(axis=1).min(axis=1))
    standing = np.max(
        [
            m
            for m, a in zip(moved_cm, kit.labels[:-1])
            if a != "walk" and "walk" not in kit.labels[kit.labels.index(a) + 1]
        ]
    )
    yield "between motions of one stance the standing foot stays", f"moves at most {standing:.2f} cm", standing < 0.5
    worst = np.max(moved_cm)
    claim = "where stances differ (into and out of walking) the standing foot shuffles a little"
    yield claim, f"{np.mean(moved_cm[1:3]):.1f} cm on average, {worst:.1f} cm at most", worst < MOST_SHUFFLE_CM


def _cost(kit: CompositeEmulator, worker: Any) -> Iterator[Line]:
    def whole() -> None:
        kit.sample(64, np.random.default_rng(0), worker=worker).duration_s.tolist()

    def parts() -> None:
        rng = np.random.default_rng(0)
        for part in kit.parts:
            wanted = part.asked(None, worker.walk_m_per_s)
            part.model.sample(64, rng, worker=worker.effects[part.task], condition=wanted).duration_s.tolist()

    ratio = min(_best_s(whole) / _best_s(parts) for _ in range(3))
    yield "drawing a kit's times over drawing its parts'", f"{ratio:.2f} times", ratio < MOST_COST


def _best_s(draw: Callable[[], None]) -> float:
    times = []
    for _ in range(20):
        start = time.perf_counter()
        draw()
        times.append(time.perf_counter() - start)
    return min(times)
