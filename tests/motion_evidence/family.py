"""Recorded classes as one family, asked for heights that none of them has; and its shortest and its tallest person."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from emulator import MotionEmulator, Target, family, read_motions
from emulator.model.recorded_reach import REFUSED
from emulator.model.targets import HandPlaces

HEIGHTS_M = np.arange(0.3, 1.8, 0.2)
N_DRAWS, MISSED_M = 100, 0.005
LEG = ("right_knee", "right_ankle")


class Drawn:
    """n draws at a height: what they look like at the first mark."""

    def __init__(self, model: MotionEmulator, target: Target, worker: str | None = None) -> None:
        self.drawn = model.given(target).sample(N_DRAWS, np.random.default_rng(0), worker=worker)
        self.joint = dict(
            zip(model.skeleton.names, np.moveaxis(self.drawn.positions_m(self.drawn.mark_s[:, :1]), 2, 0))
        )
        self.duration_s = self.drawn.duration_s
        self.missed_m = np.abs(HandPlaces.of(model, [target]).decoded(self.drawn)[:, 0, 2] - target.height_m)
        self.too_fast = self.drawn._ground.fastest_m_per_s > model.most_m_per_s + 1e-9

    def angles_deg(self) -> tuple[np.ndarray, np.ndarray]:
        """(n,) the trunk from upright, and the right upper arm from hanging down along it."""
        trunk = (self.joint["neck"] - self.joint["pelvis"])[:, 0]
        arm = (self.joint["right_elbow"] - self.joint["right_shoulder"])[:, 0]
        size = np.linalg.norm(trunk, axis=1)
        lifted = -np.sum(arm * trunk, axis=1) / size / np.linalg.norm(arm, axis=1)
        return np.degrees(np.arccos(trunk[:, 2] / size)), np.degrees(np.arccos(lifted))


def show(paths: Sequence[Path], joint: str) -> int:
    """Prints both tables. 0 where trunks rise steadily, no draw of a height that is not refused is far off or too fast
    (more than one in twenty), and people of different stature differ as statures ask, else 1.
    """
    members = [read_motions(path) for path in paths]
    pooled = MotionEmulator.fit(family("family", members))
    alone = [MotionEmulator.fit(one) for one in members]
    print("\n".join(pooled.reach(joint, 0).gap_sentences()) or "no gap between recorded heights")
    failed, trunks = 0, []
    for height_m in HEIGHTS_M:
        target = Target(joint, 0, height_m=float(height_m))
        one, verdict = Drawn(pooled, target), pooled.reach(joint, 0).verdict(target)
        bent = one.angles_deg()[0]
        missed, fast = np.mean(one.missed_m > MISSED_M), np.mean(one.too_fast)
        others = [model.reach(joint, 0).verdict(target) for model in alone]
        each = ", ".join(f"{m.task} {v.word} {v.mahalanobis2:.0f}" for m, v in zip(alone, others))
        print(
            f"{height_m:.1f} m: trunk {bent.mean():3.0f} ({bent.std():.0f}) deg, {one.duration_s.mean():.2f} "
            f"({one.duration_s.std():.2f}) s, too fast {fast:.0%}, missed by 5 mm {missed:.0%}, "
            f"{verdict.word} {verdict.mahalanobis2:.2f}; alone: {each}"
        )
        trunks.append(bent.mean())
        failed += int(verdict.word != REFUSED and max(missed, fast) > 0.05)
    failed += int(np.max(np.diff(trunks)) > 10.0)
    return int(failed > 0) | _statures(pooled, joint)


def _statures(model: MotionEmulator, joint: str) -> int:
    """The shortest and the tallest recorded person at each height."""
    bones = [model.skeleton.bone_names.index(name) for name in LEG]
    leg_m = {name: model.bone_length_m(model.known_worker(name).z[None])[0, bones].sum() for name in model.workers}
    short, tall = min(leg_m, key=lambda name: leg_m[name]), max(leg_m, key=lambda name: leg_m[name])
    print(f"short: {short}, legs of {leg_m[short]:.2f} m; tall: {tall}, legs of {leg_m[tall]:.2f} m")
    rows = []
    for height_m in HEIGHTS_M:
        angles = [Drawn(model, Target(joint, 0, height_m=float(height_m)), name).angles_deg() for name in (short, tall)]
        (trunk, arm), (trunk_tall, arm_tall) = ((float(t.mean()), float(a.mean())) for t, a in angles)
        rows.append((trunk_tall - trunk, arm_tall - arm))
        print(
            f"{height_m:.1f} m: trunk {trunk:.0f} and {trunk_tall:.0f} deg ({rows[-1][0]:+.0f}), "
            f"upper arm {arm:.0f} and {arm_tall:.0f} deg ({rows[-1][1]:+.0f})"
        )
    more_bent, less_lifted = np.mean([r[0] for r in rows[:3]]), np.mean([r[1] for r in rows[-3:]])
    print(
        f"the tall one bends by {more_bent:+.0f} deg more at low heights, lifts the arm {less_lifted:+.0f} at high ones"
    )
    return int(more_bent <= 0 or less_lifted >= 0)
