"""Masses of the body's segments and where their centres lie, by sex."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Segments:
    """Shares of body mass, and the centre of each segment as a share of its length from the end named first.

    back : upper and middle trunk together, above the pelvis, centre from the hips to the neck; trunk : all of it
    head : with the neck; its centre is taken at the joint ``head``
    upper_arm, forearm, hand : from shoulder, elbow, wrist; thigh : from the hip
    """

    head: float
    trunk: float
    trunk_centre: float
    back: float
    back_centre: float
    upper_arm: float
    upper_arm_centre: float
    forearm: float
    forearm_centre: float
    hand: float
    hand_centre: float
    thigh: float
    thigh_centre: float


MALE = Segments(
    0.0694, 0.4346, 0.4862, 0.3229, 0.6153, 0.0271, 0.5772, 0.0162, 0.4574, 0.0061, 0.7900, 0.1416, 0.4095
)  # fmt: skip
FEMALE = Segments(
    0.0668, 0.4257, 0.5036, 0.3010, 0.6501, 0.0255, 0.5754, 0.0138, 0.4559, 0.0056, 0.7474, 0.1478, 0.3612
)  # fmt: skip
"""de Leva 1996, J. Biomech. 29, 1223-1230, table 4 (Zatsiorsky's masses and centres, moved to joint centres): trunk as
CERV-MIDH, hand as wrist to third knuckle. ``back`` is its upper and middle trunk: in men 0.1596 at 122.6 mm and 0.1633
at 339.1 mm below CERV, of 603.3 mm to the hips; in women 0.1545 at 115.1 mm and 0.1465 at 320.6 mm, of 614.8 mm."""


def segments_of(sex: str | None) -> Segments:
    """Of a man ("m"), a woman ("f"), or the mean of both."""
    if sex in ("m", "f"):
        return MALE if sex == "m" else FEMALE
    both = (0.5 * (getattr(MALE, name) + getattr(FEMALE, name)) for name in Segments.__slots__)
    return Segments(*both)
