"""Masses of the body's segments and where their centres lie, by sex.

How strong joints are, by sex, age, height and mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


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


HEIGHT_M, MASS_KG, AGE_YEARS = 1.75, 75.0, 40.0
"""Of a body of which nothing is said; whose sex is not said has the mean of both."""
SEXES = ("m", "f")

_HARBO: dict[str, dict[str, tuple[float, float, float, float]]] = {
    "shoulder": {"m": (-30.8, -0.24, 36.0, 0.49), "f": (-28.2, -0.21, 35.0, 0.29)},
    "elbow": {"m": (-23.8, -0.13, 22.0, 0.51), "f": (6.9, -0.13, 9.0, 0.18)},
    "hip": {"m": (-49.8, -0.97, 103.0, 1.14), "f": (-108.7, -0.87, 147.0, 0.50)},
    "knee": {"m": (-107.9, -1.40, 158.0, 1.75), "f": (-201.0, -0.96, 216.0, 0.88)},
}
"""Newton metres: constant, a year of age, a metre of height, a kilogram of mass. Harbo, Brincks & Andersen 2012,
Eur. J. Appl. Physiol. 112, 267-275 (178 healthy people): shoulder abduction, elbow flexion and knee extension
isometric, hip extension isokinetic, which is less than isometric. One limb."""
_BACK = {"m": 234.0, "f": 184.0}
"""Newton metres of torso extension, medians of Stobbe 1982 as in Chaffin, Andersson & Martin, Occupational
Biomechanics; its strengths of men at 20, 40 and 60 degrees of flexion are 288, 232 and 171."""
_LEAST = 0.2
"""Of the strength of the default body: bodies far beyond those measured are not extrapolated below it."""


def strength_nm(joint: str, body: Any = None) -> float:
    """Strength of a shoulder, an elbow, the back, or a hip or knee of one leg, in newton metres.

    body : anything with height_m, mass_kg, age_years and sex, each None where it is not known; None: nothing is
    """
    said = getattr(body, "sex", None)
    sexes = (said,) if said in SEXES else SEXES
    return sum(_of(joint, sex, body) for sex in sexes) / len(sexes)


def _of(joint: str, sex: str, body: Any) -> float:
    if joint == "back":
        return _BACK[sex]
    constant, a_year, a_metre, a_kg = _HARBO[joint][sex]
    usual = constant + a_year * AGE_YEARS + a_metre * HEIGHT_M + a_kg * MASS_KG
    height, mass, age = (
        usual_one if getattr(body, name, None) is None else getattr(body, name)
        for name, usual_one in (("height_m", HEIGHT_M), ("mass_kg", MASS_KG), ("age_years", AGE_YEARS))
    )
    return float(max(_LEAST * usual, constant + a_year * age + a_metre * height + a_kg * mass))
