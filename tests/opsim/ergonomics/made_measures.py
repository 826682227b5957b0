"""Measures of made postures, and what is said of made tasks."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from opsim.ergonomics.angles import ANGLES, AT, COLUMNS
from opsim.ergonomics.scores.scoring import ASKED, bounds_of
from opsim.subjects.exposure.plan import Handling

EDGES = (0.0, 3.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 76.0, 100.0)
ANGLE = st.one_of(st.sampled_from([*EDGES, *(-edge for edge in EDGES)]), st.floats(-170, 170))
LENGTH = st.sampled_from([-0.3, 0.0, 0.05, 0.1, 0.25, 0.4])


@st.composite
def frames(draw):
    """Measures of a posture, of which at most three are not known."""
    row = np.zeros(len(COLUMNS))
    for name in ASKED:
        row[AT[name]] = draw(ANGLE if name in ANGLES else LENGTH)
        if "abduction" in name:  # an angle out of a plane
            row[AT[name]] = np.clip(row[AT[name]], -89.0, 89.0)
    for name in draw(st.lists(st.sampled_from(ASKED), max_size=3)):
        row[AT[name]] = np.nan
    return row


@st.composite
def said(draw):
    """Bounds with few things open."""
    open_ones = draw(st.lists(st.sampled_from(["load_kg", "grip", "force", "forearm", "arms_supported", "sitting",
                                               "legs", "rapid"]), max_size=2))  # fmt: skip
    told = Handling(
        load_kg=draw(st.sampled_from([0.0, 1.0, 2.0, 5.0, 8.0, 10.0, 14.0, 25.0])),
        grip=draw(st.sampled_from(["good", "fair", "poor", "unacceptable"])),
        force=draw(st.sampled_from(["intermittent", "repeated", "static", "shock"])),
        forearm=draw(st.sampled_from(["mid", "end"])),
        arms_supported=draw(st.booleans()),
        sitting=draw(st.booleans()),
        legs=draw(st.sampled_from(["balanced", "unbalanced"])),
        rapid=draw(st.booleans()),
    )
    return bounds_of(replace(told, **dict.fromkeys(open_ones)), walking=draw(st.booleans()))


def upright(**measures):
    """A body that stands with hanging arms, in metres and degrees, but for some measures."""
    row = np.zeros(len(COLUMNS))
    for side in ("left", "right"):
        row[AT[f"{side}_across_m"]], row[AT[f"{side}_elbow_above_m"]] = -0.2, -0.3
    for name, value in measures.items():
        row[AT[name]] = value
    return row
