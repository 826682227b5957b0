"""Units of cyclic motion: how it starts from standing, and how it ends; kept as latents, joined at a beat.

What recorded beats are like: how many frames they take, and with which posture the next one begins.

The beats of motion that goes on and on: the strikes of the feet in walking, the turns of the cycle in other work.

Workers of a cyclic task: how each moves, steps and is built; a new one is a blend of the recorded ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

JOIN_FRAMES = 8
"""Within so many frames what is left of a difference at a join has gone."""


@dataclass(frozen=True, eq=False)
class Unit:
    """A stretch from standing to a beat (start), or from a beat to standing (stop).

    z : (F, d) latents without the worker's own offset, contact : (F, 2), control : as of the dynamics
    foot : 0 or 1, which comes down at the beat; -1 where no foot does
    """

    z: np.ndarray
    contact: np.ndarray
    control: float
    foot: int

    @property
    def n_steps(self) -> int:
        """Frames from its first to its last."""
        return len(self.z) - 1


def chosen(units: Sequence[Unit], foot: int, control: float, z: np.ndarray | None = None) -> Unit:
    """The unit at this foot whose control is nearest, and, among those about as near, the one that begins nearest to z.

    Units of the other foot only where there is none of this.
    """
    fitting = [unit for unit in units if unit.foot == foot] or list(units)
    away = np.array([abs(unit.control - control) for unit in fitting])
    if z is None:
        return fitting[int(away.argmin())]
    apart = np.array([np.linalg.norm(unit.z[0] - z) for unit in fitting])
    return fitting[int((away + 0.5 * apart).argmin())]


def joined(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Latents before (F, d) and after (G, d), whose first frame is the last one of before -> (F + G - 1, d).

    What differs at the join, in place and in rate, goes away within JOIN_FRAMES of ``after``: the speed has no jump.
    """
    span = min(JOIN_FRAMES, len(after) - 1)
    if span < 1 or len(before) < 2:
        return np.concatenate([before[:-1], after])
    gap = before[-1] - after[0]
    rate = ((before[-1] - before[-2]) - (after[1] - after[0])) * span
    u = np.clip(np.arange(len(after)) / span, 0.0, 1.0)[:, None]
    eased = after + gap * (1 + 2 * u) * (1 - u) ** 2 + np.clip(rate, -2.0, 2.0) * u * (1 - u) ** 2
    return np.concatenate([before[:-1], eased])


def spread_out(units: Sequence[Unit], at_most: int) -> tuple[Unit, ...]:
    """At most so many of the units, of both feet and evenly over their controls."""
    kept: list[Unit] = []
    feet = sorted({unit.foot for unit in units})
    for foot in feet:
        own = sorted((unit for unit in units if unit.foot == foot), key=lambda unit: unit.control)
        places = np.unique(np.linspace(0, len(own) - 1, max(at_most // len(feet), 1)).round().astype(int))
        kept += [own[int(i)] for i in places]
    return tuple(kept)


ROOM = 1.2
"""A draw may lie this much further out than any recording."""


@dataclass(frozen=True, eq=False)
class Guide:
    """anchors : (F, 3, D) usual latents at a beat of each foot (F = 1 where none steps): of 1, the control, its square

    log_frames : (2,) log frames of a beat: of 1 and the control; spread : of log frames about it, at most recorded
    apart : greatest recorded distance of a beat's first d latents from the usual ones
    low, high : (d,) least and greatest recorded latents of those that the dynamics move
    """

    anchors: np.ndarray
    log_frames: np.ndarray
    spread: float
    apart: float
    low: np.ndarray
    high: np.ndarray

    @classmethod
    def of(cls, beats: Sequence[Unit], moved: int) -> Guide:
        """Of all recorded beats, from one to the next; the dynamics move the first ``moved`` latents."""
        feet = sorted({beat.foot for beat in beats})
        anchors = np.stack([_anchor([beat for beat in beats if beat.foot == foot]) for foot in feet])
        control = np.array([beat.control for beat in beats])
        logs = np.log([beat.n_steps for beat in beats])
        powers = np.stack([control**0, control], axis=1)[:, : 1 + (np.ptp(control) > 1e-9)]
        fitted = np.linalg.lstsq(powers, logs, rcond=None)[0]
        frames = z = np.concatenate([beat.z[:, :moved] for beat in beats])
        wide = (ROOM - 1) * np.ptp(frames, axis=0)
        spread = float(np.abs(logs - powers @ fitted).max())
        bare = cls(anchors, np.append(fitted, [0.0])[:2], spread, 0.0, z.min(axis=0) - wide, z.max(axis=0) + wide)
        apart = [np.linalg.norm((beat.z[0] - bare.usual(beat.foot, beat.control))[:moved]) for beat in beats]
        return cls(bare.anchors, bare.log_frames, spread, float(max(apart)), bare.low, bare.high)

    def usual(self, foot: int, control: float) -> np.ndarray:
        """(D,) latents at a beat of this foot."""
        anchor = self.anchors[min(max(foot, 0), len(self.anchors) - 1)]
        return np.asarray(np.array([1.0, control, control**2]) @ anchor)

    def frames(self, control: float) -> float:
        """How many a beat takes."""
        return float(np.exp(self.log_frames @ np.array([1.0, control])))

    def lasts(self, frames: int, control: float) -> bool:
        """Whether a beat may take so many."""
        return bool(abs(np.log(frames / self.frames(control))) <= ROOM * self.spread)

    def allows(self, z: np.ndarray, foot: int, control: float) -> bool:
        """Whether a beat z (T, d), up to and with the first frame of the next one, is like a recorded one."""
        after = self.usual(1 - foot if foot >= 0 else foot, control)[: z.shape[1]]
        near = np.linalg.norm(z[-1] - after) <= ROOM * self.apart
        return bool(self.lasts(len(z) - 1, control) and near and np.all((z >= self.low) & (z <= self.high)))


def _anchor(beats: list[Unit]) -> np.ndarray:
    """(3, D) by least squares."""
    z, control = np.array([beat.z[0] for beat in beats]), np.array([beat.control for beat in beats])
    n_powers = min(3, len(np.unique(control)))
    powers = np.stack([control**0, control, control**2], axis=1)[:, :n_powers]
    fitted = np.linalg.lstsq(powers, z, rcond=None)[0]
    return np.vstack([fitted, np.zeros((3 - n_powers, z.shape[1]))])


STILL_LEGS_PER_S = 0.12
"""A root slower than this stands: what goes before is waiting, and no part of the way."""
FEWEST_FRAMES = 3


def strikes(contact: np.ndarray) -> list[tuple[int, int]]:
    """(frame, foot) of each coming down of a foot in contact (T, 2), in order; feet take turns.

    Flickers shorter than FEWEST_FRAMES do not count, nor does the second of two strikes of one foot in a row.
    """
    found = []
    for foot in (0, 1):
        bears = np.asarray(contact[:, foot], bool)
        for frame in np.flatnonzero(bears[1:] & ~bears[:-1]) + 1:
            before, after = bears[max(frame - FEWEST_FRAMES, 0) : frame], bears[frame : frame + FEWEST_FRAMES]
            if not before.any() and after.all():
                found.append((int(frame), foot))
    found.sort()
    return [beat for i, beat in enumerate(found) if i == 0 or beat[1] != found[i - 1][1]]


def turns(z: np.ndarray, rate_hz: float, level: tuple[float, float] | None = None) -> list[int]:
    """Frames at which a new cycle begins: the first latent comes up through its middle, after having been well below.

    z : (T, d). The first latent, smoothed over a tenth of a second, must fall well below the middle in between, so that
    a tremble makes no cycle. level : the middle and what is well below it; None: the middle of the range of z, and a
    third of the spread below.
    """
    from scipy.ndimage import gaussian_filter1d

    wave = gaussian_filter1d(z[:, 0], 0.1 * rate_hz, mode="nearest")
    if level is None:
        middle = float(0.5 * (np.quantile(wave, 0.05) + np.quantile(wave, 0.95)))
        level = middle, middle - float(wave.std()) / 3
    armed, found = False, []
    for frame in range(1, len(wave)):
        armed = armed or wave[frame] < level[1]
        if armed and wave[frame - 1] < level[0] <= wave[frame]:
            found.append(frame)
            armed = False
    return found


def onset(speed: np.ndarray, limit: float = STILL_LEGS_PER_S) -> int:
    """The last frame of standing before the first movement, 0 where it moves from the first frame on; speed (T,)."""
    moving = np.flatnonzero(speed > limit)
    return max(int(moving[0]) - 1, 0) if len(moving) else 0


def starts_still(speed: np.ndarray, limit: float = STILL_LEGS_PER_S) -> bool:
    """Whether the take begins standing: speed (T,) of the root in legs a second."""
    return bool(np.all(speed[:3] <= limit))


@dataclass(frozen=True, eq=False)
class CyclicWorker:
    """One worker, or n of them. z (..., d): where the worker's latents lie beside everybody's; log_step (...): own step
    at a speed over the usual (log), or own time of a cycle; bone_length_m (..., B); pace: as fast as asked of the body.
    """

    z: np.ndarray
    log_step: np.ndarray
    bone_length_m: np.ndarray
    name: str = ""
    pace: float = 1.0


@dataclass(frozen=True, eq=False)
class Crew:
    """The W recorded workers: offsets (W, d) of latents, log_step (W,), bone_length_m (W, B)."""

    names: tuple[str, ...]
    offsets: np.ndarray
    log_step: np.ndarray
    bone_length_m: np.ndarray

    def known(self, task: str, name: str) -> CyclicWorker:
        """A recorded worker. Raises ValueError for an unknown name, with the nearest."""
        if name not in self.names:
            near = get_close_matches(str(name), self.names, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.names)}"
            raise ValueError(f"{task}: no worker {name!r}; {hint}")
        i = self.names.index(name)
        return CyclicWorker(self.offsets[i], self.log_step[i], self.bone_length_m[i], name)

    def drawn(self, n: int, rng: np.random.Generator) -> CyclicWorker:
        """n new workers: a Gaussian with the recorded workers' mean and covariance, all of it in one draw."""
        weight = rng.standard_normal((n, len(self.names))) / np.sqrt(max(len(self.names) - 1, 1))
        return self.blended(weight)

    @property
    def typical(self) -> CyclicWorker:
        """The mean of the recorded workers."""
        one = self.blended(np.zeros((1, len(self.names))))
        return CyclicWorker(one.z[0], one.log_step[0], one.bone_length_m[0])

    def blended(self, weight: np.ndarray) -> CyclicWorker:
        """n workers at the mean plus ``weight`` (n, W) times each recorded one's deviation from it."""
        mean = self.offsets.mean(axis=0), self.log_step.mean(), np.log(self.bone_length_m).mean(axis=0)
        return CyclicWorker(
            mean[0] + weight @ (self.offsets - mean[0]),
            mean[1] + weight @ (self.log_step - mean[1]),
            np.exp(mean[2] + weight @ (np.log(self.bone_length_m) - mean[2])),
        )
