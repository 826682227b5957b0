"""How fast muscles tire and recover, by region of the body; and how long they were seen to hold on."""

from __future__ import annotations

from dataclasses import dataclass

TRACKING_PER_S = 10.0
"""How fast resting muscle is taken into work and let go, 1/s: the papers' L, which they call arbitrary."""


@dataclass(frozen=True, slots=True)
class Muscle:
    """The muscles about a joint. tires_per_s, recovers_per_s : F and R of the three-compartment model, 1/s

    at_rest : r, how many times faster they recover where nothing is asked of them
    """

    tires_per_s: float
    recovers_per_s: float
    at_rest: float = 15.0


MUSCLES: dict[str, Muscle] = {
    "shoulder": Muscle(0.01820, 0.00168),
    "elbow": Muscle(0.00912, 0.00094),
    "grip": Muscle(0.00980, 0.00064, 30.0),
    "trunk": Muscle(0.00755, 0.00075),
    "knee": Muscle(0.01500, 0.00149),
    "ankle": Muscle(0.00589, 0.00058),
    "general": Muscle(0.00970, 0.00091),
}
"""F and R: Frey-Law, Looft & Heitsman 2012, J. Biomech. 45, 1803-1808, table 1 ("general" is all joints pooled, and
stands for the hip, which was not measured). r: Looft, Herkert & Frey-Law 2018, J. Biomech. 77, 16-25: 15 for ankle,
knee and elbow, 30 for the grip; shoulder, trunk and "general" were not measured and take 15: an assumption."""

ENDURANCE: dict[str, tuple[float, float]] = {
    "shoulder": (14.86, -1.83),
    "elbow": (17.98, -2.21),
    "grip": (33.55, -1.61),
    "trunk": (22.69, -2.27),
    "knee": (19.38, -1.88),
    "ankle": (34.71, -2.06),
    "general": (21.92, -1.98),
}
"""(b0 in seconds, b1): Frey Law & Avin 2010, Ergonomics 53, 109-129, table 2, power models of 194 publications."""


def endurance_seen_s(region: str, share: float) -> float:
    """Seconds for which a share of strength, above 0 to 1, was held on average: b0 * share ** b1 (Frey Law & Avin)."""
    b0, b1 = ENDURANCE[region]
    return b0 * share**b1
