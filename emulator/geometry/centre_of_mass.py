"""Where a body's mass is: shares of its joints, from the segments between them."""

from __future__ import annotations

import numpy as np

from emulator.skeleton import Skeleton

HEAD, TRUNK, TRUNK_CENTRE = 0.0681, 0.43015, 0.4949
LIMBS = (
    ("shoulder", "elbow", 0.0263, 0.5763),
    ("elbow", "wrist", 0.0150, 0.4567),
    ("wrist", "hand", 0.00585, 0.7687),
    ("hip", "knee", 0.1447, 0.3854),
    ("knee", "ankle", 0.0457, 0.4374),
    ("ankle", "toe", 0.0133, 0.5),
)
"""Joints of a limb's segment, its share of body mass, its centre as a share of the way: the means of men and women of
de Leva 1996, J. Biomech. 29, 1223-1230, table 4; trunk from hips to neck; the head's centre at its joint, the foot's
half-way between ankle and toe, which the table does not have. ``opsim`` has the table by sex, for loads on joints."""
SIDES = ("left", "right")
NEEDED = (
    *("neck", "head"),
    *(f"{side}_{j}" for side in SIDES for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")),
)


def joint_masses(skeleton: Skeleton) -> np.ndarray:
    """(J,) shares of the body's mass at its joints, 1 in all, whose mean is the centre of mass.

    A hand or a toe that the skeleton lacks weighs at the wrist or the ankle. Raises ValueError without one of
    ``NEEDED``.
    """
    absent = [name for name in NEEDED if name not in skeleton.names]
    if absent:
        raise ValueError(f"centre of mass: the skeleton has no {', '.join(absent)}")
    at = {name: number for number, name in enumerate(skeleton.names)}
    mass = np.zeros(skeleton.n_joints)
    mass[at["head"]] += HEAD
    mass[at["neck"]] += TRUNK * TRUNK_CENTRE
    for side in SIDES:
        mass[at[f"{side}_hip"]] += 0.5 * TRUNK * (1.0 - TRUNK_CENTRE)
        for near, far, share, centre in LIMBS:
            start = at[f"{side}_{near}"]
            mass[start] += share * (1.0 - centre)
            mass[at.get(f"{side}_{far}", start)] += share * centre
    return mass / mass.sum()


def centre_of_mass_m(skeleton: Skeleton, positions_m: np.ndarray) -> np.ndarray:
    """(..., 3) from joints (..., J, 3). Raises ValueError as ``joint_masses``."""
    return np.asarray(joint_masses(skeleton) @ positions_m)
