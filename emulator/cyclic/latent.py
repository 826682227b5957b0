"""Poses of motion that goes on and on: directions without heading, and what the root does from one frame to the next.

Place and heading drop out, so that the tenth cycle has the same poses as the first; the path is the sum of the steps.

The latent space of poses: principal components of unit directions, and the way back to unit directions.

Source: Remillard & Kry (2010), sec. 2 (z = f(q), three components kept 90 % of the variation). Beyond the paper: q is
unit directions instead of joint angles (Chen, Park & Srivastava, sec. 3.1), and the root's travel and height are
foretold from z, linearly.

The finer part of a posture, beyond the components that the dynamics move: foretold from these and the speed.

Source: a Gaussian process from latents to poses, as in the dynamical models of Wang, Fleet & Hertzmann (2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.gaussian_process import Hyper, kernel
from emulator.model.decoding import RootChannel
from emulator.motion import heading_rad, turn
from emulator.skeleton import Skeleton

FLOOR_SHARE = 0.02
"""The floor lies at this quantile of the lowest joint of each frame."""


@dataclass(frozen=True, eq=False)
class Poses:
    """A stretch of motion without place and heading; leading axes are the batch.

    directions : (..., T, B, 3) unit directions in the heading frame of each frame (x forward, y left, z up)
    travel     : (..., T, 3) of the root to the NEXT frame: forward and to the left in legs a second, turning in radians
                 a second; in the heading frame of this frame; the last frame repeats the one before
    height     : (..., T) of the root above the floor, in legs
    """

    directions: np.ndarray
    travel: np.ndarray
    height: np.ndarray

    @property
    def n_frames(self) -> int:
        return int(self.directions.shape[-3])


def leg_length_m(skeleton: Skeleton, bone_length_m: np.ndarray) -> float:
    """Mean length of thigh and shank together; a quarter of all bones for a skeleton without legs."""
    return float(RootChannel(skeleton).leg_m(np.asarray(bone_length_m, float)))


def poses_of(positions_m: np.ndarray, skeleton: Skeleton, rate_hz: float, *, leg_m: float | None = None) -> Poses:
    """Joints (T, J, 3) through time -> Poses; ``leg_m`` by default from the median bones of these frames.

    Raises ValueError for fewer than 3 frames, and where the skeleton names a joint that is missing in a frame.
    """
    positions_m = np.asarray(positions_m, float)
    if len(positions_m) < 3:
        raise ValueError(f"poses need 3 frames, found {len(positions_m)}")
    leg_m = leg_m or leg_length_m(skeleton, np.median(skeleton.bone_lengths(positions_m), axis=0))
    directions = skeleton.directions(positions_m)
    yaw = heading_rad(skeleton, positions_m)
    root = positions_m[:, skeleton.root]
    step = turn(np.diff(root, axis=0), -yaw[:-1]) * rate_hz / leg_m
    travel = np.column_stack([step[:, :2], np.diff(yaw) * rate_hz])
    floor = np.quantile(positions_m[..., 2].min(axis=1), FLOOR_SHARE)
    return Poses(turn(directions, -yaw[:, None]), np.vstack([travel, travel[-1:]]), (root[:, 2] - floor) / leg_m)


def path_of(
    poses: Poses,
    leg_m: float | np.ndarray,
    rate_hz: float,
    *,
    start_xy_m: Sequence[float] = (0.0, 0.0),
    start_yaw_rad: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Where the travel leads: root_m (..., T, 3) and yaw_rad (..., T), from the start given. Inverse of ``poses_of``.

    leg_m : metres, (...) or one number
    """
    travel = np.asarray(poses.travel, float)
    yaw = _summed(travel[..., 2] / rate_hz) + start_yaw_rad
    leg = np.asarray(leg_m, float)[..., None]
    steps = np.stack([travel[..., 0] * leg, travel[..., 1] * leg, np.zeros_like(yaw)], axis=-1) / rate_hz
    level = turn(steps, yaw)[..., :2]
    x, y = _summed(level[..., 0]) + start_xy_m[0], _summed(level[..., 1]) + start_xy_m[1]
    return np.stack([x, y, poses.height * leg], axis=-1), yaw


def positions_of(
    poses: Poses, skeleton: Skeleton, bone_length_m: np.ndarray, rate_hz: float, *, leg_m: float | None = None
) -> np.ndarray:
    """Joints (..., T, J, 3) in metres of a body with bones (B,) on the path of the poses; starts at the origin."""
    root_m, yaw = path_of(poses, leg_m or leg_length_m(skeleton, bone_length_m), rate_hz)
    return skeleton.positions(turn(poses.directions, yaw[..., None]), bone_length_m, root_m)


def _summed(steps: np.ndarray) -> np.ndarray:
    """Sums of the steps before each frame, (..., T): the first is 0."""
    total = np.cumsum(steps, axis=-1)
    return np.concatenate([np.zeros_like(total[..., :1]), total[..., :-1]], axis=-1)


TRAVEL_WEIGHT = 1e-3
"""So little that travel and height do not form the components: their loadings are then their regression on z.

With a weight of 0.3 they did, and where a pause ends the latent jumped: pauses were kept worse, walking no better.
"""


@dataclass(frozen=True, eq=False)
class PoseLatent:
    """z (..., d) = (q - mean) basis / scale, with q (..., D) a pose laid flat; columns of ``basis`` are orthonormal."""

    mean: np.ndarray
    basis: np.ndarray
    scale: float
    energy: np.ndarray
    """(D,) share of the variance that the first 1, 2, ... components keep."""

    @classmethod
    def fit(cls, sequences: Sequence[Poses], *, components: int | float = 0.9) -> PoseLatent:
        """Principal components of all frames together: a number of them, or as many as keep this share of the energy.

        Raises ValueError for a share outside (0, 1], a number beyond what there is, and poses that never change.
        """
        q = np.concatenate([flattened(poses) for poses in sequences])
        mean = q.mean(axis=0)
        _, spread, rows = np.linalg.svd(q - mean, full_matrices=False)
        if spread[0] <= 1e-9 * np.sqrt(len(q)):
            raise ValueError("the poses never change; there is no motion to model")
        energy = np.minimum(np.cumsum(spread**2) / np.sum(spread**2), 1.0)
        kept = _number(components, energy)
        signs = np.sign(rows[np.arange(kept), np.abs(rows[:kept]).argmax(axis=1)])
        return cls(mean, (rows[:kept] * signs[:, None]).T, float(spread[0] / np.sqrt(len(q))), energy)

    @property
    def n_components(self) -> int:
        return int(self.basis.shape[1])

    def forward(self, poses: Poses) -> np.ndarray:
        """(..., T, d) latents, in spreads of the first component."""
        return (flattened(poses) - self.mean) @ self.basis / self.scale

    def inverse(self, z: np.ndarray) -> Poses:
        """The poses of latents (..., T, d), their directions of unit length again."""
        return unflattened(self.flat(z))

    def flat(self, z: np.ndarray) -> np.ndarray:
        """(..., T, D) the poses of latents laid flat, see ``flattened``, their directions not yet of unit length."""
        return np.asarray(np.asarray(z, float) @ (self.basis.T * self.scale) + self.mean)

    def first(self, components: int) -> PoseLatent:
        """The same space with its first components only."""
        return PoseLatent(self.mean, self.basis[:, :components], self.scale, self.energy)

    def arrays(self) -> dict[str, np.ndarray]:
        """What a file keeps of it."""
        return {"mean": self.mean, "basis": self.basis, "scale": np.array(self.scale), "energy": self.energy}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> PoseLatent:
        return cls(arrays["mean"], arrays["basis"], float(arrays["scale"]), arrays["energy"])


def flattened(poses: Poses) -> np.ndarray:
    """(..., T, D) with D = 3 B + 4: directions, then travel and height with little weight."""
    lead = poses.directions.shape[:-2]
    beside = np.concatenate([poses.travel, poses.height[..., None]], axis=-1)
    return np.concatenate([poses.directions.reshape(*lead, -1), TRAVEL_WEIGHT * beside], axis=-1)


def unflattened(q: np.ndarray) -> Poses:
    """The way back, with directions made unit again."""
    directions = q[..., :-4].reshape(*q.shape[:-1], -1, 3)
    length = np.linalg.norm(directions, axis=-1, keepdims=True)
    return Poses(directions / np.maximum(length, 1e-12), q[..., -4:-1] / TRAVEL_WEIGHT, q[..., -1] / TRAVEL_WEIGHT)


def _number(components: int | float, energy: np.ndarray) -> int:
    if isinstance(components, float) and not 0 < components <= 1:
        raise ValueError(f"a share of the energy lies in (0, 1], found {components:g}")
    if isinstance(components, float):
        return int(np.searchsorted(energy, components - 1e-12) + 1)
    if not 1 <= components <= len(energy):
        raise ValueError(f"between 1 and {len(energy)} components are possible, found {components}")
    return int(components)


@dataclass(frozen=True, eq=False)
class Finer:
    """Mean of y (n, r) at inputs x (n, p): kernel(x, points / length) @ weight; exact sums of its M points.

    points (M, p), length (p,), weight (M, r), mean (r,)
    """

    points: np.ndarray
    length: np.ndarray
    weight: np.ndarray
    mean: np.ndarray

    @classmethod
    def fit(cls, x: Sequence[np.ndarray], y: Sequence[np.ndarray], at_most: int = 220) -> Finer:
        """From all frames of the takes, seen through evenly thinned points, which alone give the hyper-parameters."""
        from emulator.cyclic.gaussian_process import GaussianProcess

        inputs, outputs = np.concatenate(list(x)), np.concatenate(list(y))
        mean = outputs.mean(axis=0)
        few = np.unique(np.linspace(0, len(inputs) - 1, at_most).round().astype(int))
        hyper = GaussianProcess.fit(inputs[few], outputs[few] - mean).hyper
        points = inputs[few]
        across = kernel(points, inputs, hyper)
        inner = hyper.noise**2 * kernel(points, points, hyper) + across @ across.T
        inner.flat[:: len(points) + 1] += 1e-8 * np.trace(inner) / len(points)
        weight = np.linalg.solve(inner, across @ (outputs - mean)) * hyper.signal**2
        return cls(points, hyper.length, weight, mean)

    @property
    def n_outputs(self) -> int:
        return len(self.mean)

    def at(self, x: np.ndarray) -> np.ndarray:
        """(m, r) at x (m, p)."""
        if self.n_outputs == 0:
            return np.zeros((len(x), 0))
        return np.asarray(kernel(x, self.points, Hyper(self.length, 1.0, 1.0)) @ self.weight + self.mean)


def nothing_finer(n_inputs: int) -> Finer:
    """Where the dynamics move all components."""
    return Finer(np.zeros((0, n_inputs)), np.ones(n_inputs), np.zeros((0, 0)), np.zeros(0))
