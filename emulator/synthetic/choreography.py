"""A made body: joint positions by forward kinematics, limbs placed by two-bone reach. For synthetic tasks only.

Facing x, left is y, up is z. Lengths are those of a person 1.75 m tall; the body scales them.

What the made tasks look like: key postures at points of the common clock, moved by four latent numbers.

Latents: 0 how far, high or deep; 1 sideways; 2 how much trunk; 3 how the other arm or the step goes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from emulator.skeleton import CANONICAL

STATURE_M = 1.75
SIDES = (("left", 1.0), ("right", -1.0))
REST = {
    "pelvis": np.array([0.0, 0.0, 0.968]),
    "pitch": np.array([0.03]),
    "lean": np.array([0.0]),
    "twist": np.array([0.0]),
    "nod": np.array([0.10]),
    "look": np.array([0.0]),
    "left_wrist": np.array([0.08, 0.25, 0.885]),
    "right_wrist": np.array([0.08, -0.25, 0.885]),
    "left_ankle": np.array([0.0, 0.11, 0.08]),
    "right_ankle": np.array([0.0, -0.11, 0.08]),
    "left_toe": np.array([0.0]),
    "right_toe": np.array([0.0]),
}
"""Standing at rest. Metres of the average body in the frame of the floor; radians. pitch, lean, twist turn the trunk,
nod and look the head beyond it; left_toe and right_toe pitch the foot, positive with the toes down."""
_ELBOW_POLE = np.array([-0.45, 0.55, -0.75])
_KNEE_POLE = np.array([1.0, 0.18, 0.0])
_STRAIGHT = 0.999
_SOFT = 0.90
Fields = dict[str, np.ndarray]


@dataclass(frozen=True)
class Body:
    """One person: stature in metres and the ratios of arms and legs to the average person's of that stature."""

    stature_m: float = STATURE_M
    arm: float = 1.0
    leg: float = 1.0

    @property
    def scale(self) -> float:
        return self.stature_m / STATURE_M


def joints_m(pose: dict[str, np.ndarray], body: Body) -> np.ndarray:
    """Joint positions (T, 21, 3) in metres, in canonical order, from the fields of ``REST``, each (T, 3) or (T, 1).

    A wrist or ankle out of reach is approached along the straight line to 99.9 % of the limb.
    """
    rise = np.array([0.0, 0.0, (body.leg - 1) * 0.85])
    place = {"pelvis": pose["pelvis"] + rise}
    trunk = _turn(pose["pitch"], pose["lean"], pose["twist"])
    _trunk(place, pose, trunk)
    for side, sign in SIDES:
        _arm(place, side, sign, trunk, pose[f"{side}_wrist"] + rise, body.arm)
        _leg(place, side, sign, pose[f"{side}_ankle"], pose[f"{side}_toe"][..., 0], body.leg)
    return np.stack([place[name] for name in CANONICAL], axis=-2) * body.scale


def _trunk(place: Fields, pose: Fields, trunk: np.ndarray) -> None:
    low = _turn(0.6 * pose["pitch"], 0.6 * pose["lean"], 0.4 * pose["twist"])
    head = _turn(pose["pitch"] + pose["nod"], pose["lean"], pose["twist"] + pose["look"])
    place["spine"] = place["pelvis"] + low @ np.array([0.0, 0.0, 0.11])
    place["chest"] = place["spine"] + trunk @ np.array([0.0, 0.0, 0.16])
    place["neck"] = place["chest"] + trunk @ np.array([0.0, 0.0, 0.23])
    place["head"] = place["neck"] + head @ np.array([0.03, 0.0, 0.16])


def _arm(
    place: dict[str, np.ndarray], side: str, sign: float, trunk: np.ndarray, wrist: np.ndarray, ratio: float
) -> None:
    mirror = np.array([1.0, sign, 1.0])
    shoulder = place["chest"] + trunk @ (mirror * [0.0, 0.19, 0.17])
    wrist = soft_target(shoulder, wrist, 0.55 * ratio)
    elbow, wrist = two_bones(shoulder, wrist, 0.29 * ratio, 0.26 * ratio, trunk @ (mirror * _ELBOW_POLE))
    hand = wrist + 0.085 * ratio * _unit(wrist - elbow)
    place |= {
        f"{side}_{joint}": at
        for joint, at in zip(("shoulder", "elbow", "wrist", "hand"), (shoulder, elbow, wrist, hand))
    }


def soft_target(start: np.ndarray, target: np.ndarray, length: float) -> np.ndarray:
    """Targets (T, 3), those beyond ``_SOFT`` of a limb's length drawn in smoothly: a limb never locks straight."""
    apart = target - start
    distance = np.linalg.norm(apart, axis=-1, keepdims=True) / length
    room = _STRAIGHT - _SOFT
    soft = _SOFT + room * -np.expm1(-np.maximum(distance - _SOFT, 0.0) / room)
    return start + apart * np.where(distance > _SOFT, soft / np.maximum(distance, 1e-12), 1.0)


def _leg(
    place: dict[str, np.ndarray], side: str, sign: float, ankle: np.ndarray, toe_pitch: np.ndarray, ratio: float
) -> None:
    mirror = np.array([1.0, sign, 1.0])
    hip = place["pelvis"] + mirror * [0.0, 0.10, -0.05]
    knee, ankle = two_bones(hip, ankle, 0.43 * ratio, 0.41 * ratio, np.broadcast_to(mirror * _KNEE_POLE, hip.shape))
    toe = ankle + np.stack(
        [0.16 * np.cos(toe_pitch + 0.36), sign * 0.03 + 0 * toe_pitch, -0.16 * np.sin(toe_pitch + 0.36)], -1
    )
    _put(place, side, hip=hip, knee=knee, ankle=ankle, toe=toe)


def _put(place: Fields, side: str, **joints: np.ndarray) -> None:
    for joint, at in joints.items():
        place[f"{side}_{joint}"] = at


def two_bones(
    start: np.ndarray, target: np.ndarray, upper: float, lower: float, pole: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Middle joint and end (T, 3) of a limb from ``start`` towards ``target``, its middle joint bent towards ``pole``.

    The end is the target where the limb can reach it, else the point 99.9 % of the limb's length away on the way there.
    """
    along = _unit(target - start)
    reach = np.clip(np.linalg.norm(target - start, axis=-1), abs(upper - lower) + 0.02, _STRAIGHT * (upper + lower))
    fore = (upper**2 - lower**2 + reach**2) / (2 * reach)
    side = _unit(pole - np.sum(pole * along, axis=-1, keepdims=True) * along)
    height = np.sqrt(np.maximum(upper**2 - fore**2, 0.0))
    return start + fore[:, None] * along + height[:, None] * side, start + reach[:, None] * along


def _turn(pitch: np.ndarray, lean: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """(T, 3, 3): twist about z, after pitch about y (forward), after lean about x, from angles (T, 1)."""
    (cp, sp), (cl, sl), (ct, st) = ((np.cos(a[..., 0]), np.sin(a[..., 0])) for a in (pitch, lean, twist))
    rows = [
        [ct * cp, -st * cl + ct * sp * sl, st * sl + ct * sp * cl],
        [st * cp, ct * cl + st * sp * sl, -ct * sl + st * sp * cl],
        [-sp, cp * sl, cp * cl],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


Keys = list[tuple[float, dict[str, object]]]


@dataclass(frozen=True)
class Choreography:
    """A made task: its marks on the common clock, mean duration, coefficient of variation, and the postures.

    ``keys(latent (4,), mark_clock (E,))`` gives key postures; what a key leaves out is at rest.
    Key postures stand at fixed points of the common clock; a recorded mark scatters about its own, as a label does.
    ``finish(pose, clock, latent, mark_clock)`` may add what keys cannot say (turning, stepping).
    """

    mark_names: tuple[str, ...]
    mark_clock: tuple[float, ...]
    mean_s: float
    cv: float
    keys: Callable[[np.ndarray, np.ndarray], Keys]
    finish: Callable[..., dict[str, np.ndarray]] | None = None


def pose_at(task: Choreography, clock: np.ndarray, latent: np.ndarray) -> dict[str, np.ndarray]:
    """The fields of ``REST`` at each clock time (T,): a dictionary of (T, 3) or (T, 1).

    All fields ease from key to key together, at rest at each: how much one moves then never looks like another pace.
    """
    mark_clock = np.array(task.mark_clock)
    keys = task.keys(latent, mark_clock)
    times = np.array([at for at, _ in keys])
    move = np.clip(np.searchsorted(times, clock, side="right") - 1, 0, len(times) - 2)
    share = (clock - times[move]) / np.diff(times)[move]
    eased = (share**2 * (3.0 - 2.0 * share))[:, None]
    pose = {}
    for name, rest in REST.items():
        at = np.stack([np.broadcast_to(np.asarray(key.get(name, rest), float), rest.shape) for _, key in keys])
        pose[name] = at[move] + eased * (at[move + 1] - at[move])
    return task.finish(pose, clock, latent, mark_clock) if task.finish else pose


def _reach(a: np.ndarray, mark: np.ndarray) -> Keys:
    far: dict[str, object] = {
        "right_wrist": (0.50 + 0.04 * a[0], -0.14 - 0.05 * a[1], 1.22 + 0.07 * a[0]),
        "pitch": 0.14 + 0.05 * a[2], "twist": 0.20 + 0.05 * a[1], "left_wrist": (0.05 - 0.02 * a[3], 0.27, 0.86),
    }  # fmt: skip
    return [(0.0, {}), (mark[0], far), (1.0, {})]


_HOLD: dict[str, object] = {
    "right_wrist": (0.30, -0.13, 1.10), "left_wrist": (0.28, 0.13, 1.08), "nod": 0.25,
}  # fmt: skip


def _pick(a: np.ndarray, mark: np.ndarray) -> Keys:
    low: dict[str, object] = {
        "right_wrist": (0.48 + 0.03 * a[2], -0.30 - 0.06 * a[1], 0.78 - 0.07 * a[0]), "pitch": 0.50 + 0.08 * a[0],
        "twist": -0.08 - 0.06 * a[1], "nod": 0.25, "left_wrist": (0.22, 0.26, 0.84 + 0.03 * a[3]),
        "pelvis": (-0.05 - 0.01 * a[0], 0.0, 0.945),
    }  # fmt: skip
    return [(0.0, {}), (mark[0], low), (1.0, _HOLD)]


def _place(a: np.ndarray, mark: np.ndarray) -> Keys:
    out: dict[str, object] = {
        "right_wrist": (0.54 + 0.04 * a[0], -0.04 - 0.07 * a[1], 1.02 + 0.06 * a[0]), "pitch": 0.24 + 0.06 * a[2],
        "twist": 0.18 + 0.05 * a[1], "nod": 0.22, "left_wrist": (0.20, 0.24, 0.95 + 0.04 * a[3]),
    }  # fmt: skip
    return [(0.0, _HOLD), (mark[0], out), (1.0, {})]


def _fasten(a: np.ndarray, mark: np.ndarray) -> Keys:
    at: dict[str, object] = {
        "right_wrist": (0.40, -0.06 - 0.03 * a[1], 1.12 + 0.06 * a[0]), "left_wrist": (0.38, 0.12, 1.08 + 0.06 * a[0]),
        "pitch": 0.18 + 0.05 * a[2], "nod": 0.35,
    }  # fmt: skip
    return [(0.0, {}), (mark[0], at), (mark[1], at), (1.0, {})]


def _turn_tool(
    pose: dict[str, np.ndarray], clock: np.ndarray, a: np.ndarray, mark: np.ndarray
) -> dict[str, np.ndarray]:
    """Three turns of the right wrist between the marks, in the plane of the work, 5 cm wide."""
    share = np.clip((clock - mark[0]) / (mark[1] - mark[0]), 0.0, 1.0)
    radius = (0.05 + 0.008 * a[3]) * np.sin(np.pi * share) ** 0.5
    turned = np.stack([0 * share, radius * np.cos(6 * np.pi * share), radius * np.sin(6 * np.pi * share)], axis=-1)
    return pose | {"right_wrist": pose["right_wrist"] + turned}


def _inspect(a: np.ndarray, mark: np.ndarray) -> Keys:
    up: dict[str, object] = {
        "right_wrist": (0.33, -0.12, 1.24 + 0.05 * a[0]), "left_wrist": (0.33, 0.12, 1.24 + 0.05 * a[0]),
        "nod": 0.35 + 0.05 * a[2], "pitch": 0.06,
    }  # fmt: skip
    left = up | {
        "right_wrist": (0.36, -0.03, 1.33 + 0.05 * a[0]),
        "left_wrist": (0.28, 0.18, 1.16),
        "look": 0.15 + 0.05 * a[1],
    }
    right = up | {"right_wrist": (0.28, -0.18, 1.16), "left_wrist": (0.36, 0.03, 1.33 + 0.05 * a[3]), "look": -0.15}
    return [(0.0, {}), (mark[0], up), (0.5 * (mark[0] + mark[1]), left), (mark[1], right), (1.0, {})]


def _lift(a: np.ndarray, mark: np.ndarray) -> Keys:
    low: dict[str, object] = {
        "pelvis": (-0.20, 0.0, 0.56 - 0.04 * a[0]), "pitch": 0.85 + 0.08 * a[2], "nod": -0.20,
        "right_wrist": (0.34, -0.16 - 0.02 * a[1], 0.30 - 0.03 * a[0]),
        "left_wrist": (0.34, 0.16 - 0.02 * a[1], 0.30 - 0.03 * a[0]),
    }  # fmt: skip
    up: dict[str, object] = {
        "right_wrist": (0.42, -0.16, 1.02 + 0.04 * a[3]), "left_wrist": (0.42, 0.16, 1.02 + 0.04 * a[3]),
        "pitch": 0.12, "nod": 0.22,
    }  # fmt: skip
    return [(0.0, {}), (mark[0], low), (mark[1], up), (1.0, {})]


def _stoop(a: np.ndarray, mark: np.ndarray) -> Keys:
    """Bending down over straight legs: what lifting guides warn of, and people do."""
    low: dict[str, object] = {
        "pelvis": (-0.16, 0.0, 0.86 - 0.02 * a[3]), "pitch": 1.25 + 0.13 * a[0], "nod": -0.35,
        "right_wrist": (0.42 + 0.02 * a[2], -0.15 - 0.03 * a[1], 0.36 - 0.07 * a[0]),
        "left_wrist": (0.42 + 0.02 * a[2], 0.15 - 0.03 * a[1], 0.36 - 0.07 * a[0]),
    }  # fmt: skip
    off = low | {
        "pitch": 1.12 + 0.13 * a[0],
        "right_wrist": (0.40, -0.15 - 0.03 * a[1], 0.47 - 0.05 * a[0]),
        "left_wrist": (0.40, 0.15 - 0.03 * a[1], 0.47 - 0.05 * a[0]),
    }
    return [(0.0, {}), (mark[0], low), (mark[1], off), (1.0, _HOLD)]


def _stand(a: np.ndarray, mark: np.ndarray) -> Keys:
    return [(0.0, {}), (1.0, {})]


def _hold_load(a: np.ndarray, mark: np.ndarray) -> Keys:
    held: dict[str, object] = {
        "right_wrist": (0.34, -0.16, 1.06 + 0.04 * a[0]), "left_wrist": (0.34, 0.16, 1.06 + 0.04 * a[0]),
        "pitch": -0.02 + 0.03 * a[2], "nod": 0.15,
    }  # fmt: skip
    return [(0.0, held), (1.0, held)]


def stepping(n_steps: int, swings_arms: bool) -> Callable[..., dict[str, np.ndarray]]:
    """Walking straight ahead in ``n_steps``: a planted foot does not move, a swinging one flies over it."""

    def finish(
        pose: dict[str, np.ndarray], clock: np.ndarray, a: np.ndarray, mark: np.ndarray
    ) -> dict[str, np.ndarray]:
        step_m = 0.58 + 0.03 * a[0] + 0.02 * a[3]
        # a fixed ramp of the phase, so that walking starts and stops softly
        phase = n_steps * (clock - 0.12 * np.sin(2 * np.pi * clock) / (2 * np.pi))
        ahead = _pelvis_ahead(phase, n_steps) * step_m
        feet = {side: _foot(phase, n_steps, first, step_m) for side, first in (("left", 0), ("right", 1))}
        walked = {name: value.copy() for name, value in pose.items()}
        gait = np.sin(np.pi * phase) * np.clip(np.minimum(phase, n_steps - phase), 0, 1)
        swing = np.clip((feet["left"][0] - feet["right"][0]) / (2 * step_m), -1, 1)
        walked["pelvis"][:, 0] += ahead
        walked["pelvis"][:, 1] += 0.02 * np.sin(np.pi * phase) * (1 + 0.3 * a[1])
        walked["pelvis"][:, 2] -= 0.012 + 0.03 * swing**2 / 0.25 - 0.008 * np.abs(gait)
        walked["twist"][:, 0] += -0.12 * swing
        for side, sign in (("left", 1.0), ("right", -1.0)):
            along, height, pitch = feet[side]
            walked[f"{side}_ankle"][:, 0] += along
            walked[f"{side}_ankle"][:, 2] += height
            walked[f"{side}_toe"][:, 0] += pitch
            walked[f"{side}_wrist"][:, 0] += ahead - (sign * 0.42 * swing if swings_arms else 0.0)
            walked[f"{side}_wrist"][:, 2] += 0.12 * swing**2 if swings_arms else 0.0
        return walked

    return finish


def _foot(phase: np.ndarray, n_steps: int, first: int, step_m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ankle along the way, height above standing, toe pitch of the foot that swings in steps first, first + 2, ..."""
    along, height, pitch = np.zeros_like(phase), np.zeros_like(phase), np.zeros_like(phase)
    here = 0.0
    for step in range(first, n_steps, 2):
        there = min(step + 1, n_steps - 1) * step_m
        u = np.clip((phase - step - 0.06) / 0.88, 0.0, 1.0)
        along += (there - here) * u**3 * (10 - 15 * u + 6 * u**2)
        height += 0.09 * np.sin(np.pi * u) ** 2
        pitch += 0.55 * np.sin(np.pi * u) ** 2 * np.cos(np.pi * np.clip(u * 1.1, 0, 1))
        here = there
    return along, height, pitch


def _pelvis_ahead(phase: np.ndarray, n_steps: int) -> np.ndarray:
    """Steps that the pelvis has gone: between the feet at every change of the swinging foot, at rest at both ends."""
    from scipy.interpolate import PchipInterpolator

    at = np.arange(n_steps + 1.0)
    gone = np.concatenate([[0.0], at[1:-1] - 0.5, [n_steps - 1.0]])
    return PchipInterpolator(at, gone)(np.clip(phase, 0, n_steps))


TASKS = {
    "reach": Choreography(("touch",), (0.45,), 1.6, 0.20, _reach),
    "pick": Choreography(("grasp",), (0.48,), 2.0, 0.22, _pick),
    "place": Choreography(("release",), (0.55,), 2.1, 0.22, _place),
    "fasten": Choreography(("start", "stop"), (0.20, 0.82), 6.5, 0.25, _fasten, _turn_tool),
    "inspect": Choreography(("raised", "turned"), (0.25, 0.75), 4.5, 0.28, _inspect),
    "lift": Choreography(("grasp", "set_down"), (0.40, 0.84), 3.4, 0.20, _lift),
    "stoop": Choreography(("grasp", "lift_off"), (0.38, 0.60), 2.8, 0.24, _stoop),
    "carry": Choreography(("halfway",), (0.50,), 4.2, 0.15, _hold_load, stepping(6, False)),
    "walk": Choreography(("halfway",), (0.50,), 3.8, 0.12, _stand, stepping(6, True)),
}
