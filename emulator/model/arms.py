"""The last way of a hand: trunk and arms move, legs and feet stay, and the hand is at its place at the mark.

Posture coefficients of all bones but the legs' are changed by as little as may be in the covariance of recorded
postures, through the whole performance, so that it stays as smooth in time as the recordings' components are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.geometry import sphere
from emulator.geometry.flattening import SIEM, Extrinsic, Flattening
from emulator.model.targets import ANKLES, HandPlaces, blended
from emulator.motion import turn

ROUNDS = 6
NEAR_M = 2e-4
STEP = 1e-4


@dataclass(frozen=True, eq=False)
class Arms:
    """hands : whose places are asked for; rows : which of their numbers; covariance (P, P) of posture coefficients."""

    hands: HandPlaces
    rows: tuple[int, ...]
    covariance: np.ndarray

    @cached_property
    def bones(self) -> np.ndarray:
        """Bones that are no leg's: those beside the ways from the root to the ankles and what hangs from these."""
        skeleton = self.hands.model.skeleton
        legs = {bone for name in ANKLES if name in skeleton.names for bone in skeleton.lineage(skeleton.index(name))}
        below = [bool(legs & set(skeleton.lineage(joint))) for joint in skeleton.bones]
        return np.flatnonzero(~np.array(below))

    def lifted(
        self,
        posture: np.ndarray,
        place: np.ndarray,
        yaw_rad: np.ndarray,
        length_m: np.ndarray,
        turns: np.ndarray,
        miss: np.ndarray,
    ) -> np.ndarray:
        """(n, P) by how much upper bones' coefficients change so that hands come by ``miss`` (n, R).

        posture (n, P) : of the upper bones; place (n, G) : of the marks on the common clock, in cells
        yaw_rad (n, G) : heading at the marks against that at the start; length_m (n, B)
        turns (n, B or 0, 3) : of bones, see ``MotionPerformances``
        """
        basis = blended(self._control, place)
        mean, ways, steps = basis[:, :, -1], basis[:, :, :-1], self._steps(length_m, turns, yaw_rad)
        flat = mean + np.einsum("np,ngpc->ngc", posture, ways)
        goal = self._hand(flat, steps) + miss
        best, moved = np.linalg.norm(miss, axis=1), np.zeros_like(posture)
        left, share = miss.copy(), np.ones(len(miss))
        for _ in range(ROUNDS):
            if best.max(initial=0.0) < NEAR_M:
                break
            now = flat + np.einsum("np,ngpc->ngc", moved, ways)
            around = now[:, None] + STEP * np.moveaxis(ways, 2, 1)  # (n, P, G, C)
            slope = self._slope(around, now, steps)
            across = slope @ self.covariance
            size = across @ np.swapaxes(slope, 1, 2) + 1e-8 * np.eye(len(self.rows))
            step = share[:, None] * np.einsum("nrp,nr->np", across, np.linalg.solve(size, left[..., None])[..., 0])
            tried = goal - self._hand(flat + np.einsum("np,ngpc->ngc", moved + step, ways), steps)
            length = np.linalg.norm(tried, axis=1)
            better = (length < best) & (best >= NEAR_M)  # NOTE: a body moves as it does without the others
            share = np.where(better, 1.0, 0.5 * share)
            moved[better], left[better], best[better] = (moved + step)[better], tried[better], length[better]
        return moved

    def _slope(self, around: np.ndarray, now: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """(n, R, P) how the hands move with the coefficients."""
        n, n_ways = around.shape[:2]
        repeated = np.repeat(steps, n_ways, axis=0)
        hand = self._hand(around.reshape(n * n_ways, *around.shape[2:]), repeated).reshape(n, n_ways, -1)
        return np.swapaxes(hand - self._hand(now, steps)[:, None], 1, 2) / STEP

    def _hand(self, flat: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """(n, R) from the root to the hands along upper bones, of flat coordinates (n, G, C) of the chain's."""
        directions = self._flatten.inverse(flat)
        hands = steps @ directions.reshape(*directions.shape[:2], -1, 1)
        return np.asarray(hands.reshape(len(flat), -1)[:, list(self.rows)])

    def _steps(self, length_m: np.ndarray, turns: np.ndarray, yaw_rad: np.ndarray) -> np.ndarray:
        """(n, G, 3, 3b) what takes directions of the chain to how far the hands are from the root."""
        way = turn(np.eye(3), yaw_rad[..., None])  # (n, G, 3, 3), the axes' images as rows
        turned = sphere.matrices(turns[:, self._chain]) if turns.shape[1] else np.eye(3)
        bones = length_m[:, self._chain, None, None] * turned
        steps = np.einsum("gb,ngji,nbjk->ngibk", self._weight, way, bones)
        return steps.reshape(*yaw_rad.shape, 3, -1)

    @cached_property
    def _weight(self) -> np.ndarray:
        """(G, chain) how much of each bone of the chain lies between the root and each pair's joints."""
        skeleton = self.hands.model.skeleton
        weight = np.zeros((len(self.hands.joints), skeleton.n_bones))
        for g, joints in enumerate(self.hands.joints):
            for joint in joints:
                weight[g, skeleton.lineage(joint)] += 1.0 / len(joints)
        return weight[:, self._chain]

    @cached_property
    def _chain(self) -> np.ndarray:
        """Upper bones between the root and any of the joints."""
        skeleton = self.hands.model.skeleton
        used = {bone for joints in self.hands.joints for joint in joints for bone in skeleton.lineage(joint)}
        return np.array([bone for bone in self.bones if bone in used], dtype=int)

    @cached_property
    def _flatten(self) -> Flattening:
        flatten = self.hands.model.flatten
        return SIEM(flatten.reference[self._chain]) if isinstance(flatten, SIEM) else Extrinsic(len(self._chain))

    @cached_property
    def _control(self) -> np.ndarray:
        """(T + 2, P + 1, C) control points of the chain's channels."""
        control, n_bones = self.hands.posture_control, self.hands.model.skeleton.n_bones
        by_bone = control.reshape(*control.shape[:2], n_bones, -1)[:, :, self._chain]
        return by_bone.reshape(*control.shape[:2], -1)
