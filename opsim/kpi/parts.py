"""Parts of figures in words: levels of scores, regions of the body, bounds, what became of a job."""

from __future__ import annotations

from opsim.kpi.catalogue import REGION, SCORED

LEVELS = {
    "rula_from_5": "RULA 5 or more",
    "rula_from_7": "RULA 7",
    "reba_from_8": "REBA 8 or more",
    "owas_from_3": "OWAS category 3 or 4",
    "arm_beyond_60": "upper arm raised 60° or more",
    "arm_beyond_90": "upper arm raised 90° or more",
    "trunk_beyond_60": "trunk flexed 60° or more",
    "trunk_beyond_20": "trunk flexed 20° or more",
}
REGION_NAMES = {
    "trunk": "the trunk",
    "neck": "the neck",
    "arms": "the arms",
    "wrists": "the wrists",
    "legs": "the legs",
    "load": "the load",
    "time": "repeating or holding",
}
"""From where a score comes, as it is said."""
_BY = (*(kpi for kpi in SCORED if kpi.startswith("exposure_by_")), *REGION)
_BOUNDS = {"at_most": "at most", "worst": "whoever has most"}
_BOTH = {**LEVELS, **{f"{level}_at_most": f"{words}, at most" for level, words in LEVELS.items()}}
_REGIONS = {
    "trunk": "trunk",
    "left_arm": "left arm",
    "right_arm": "right arm",
    "neck": "neck",
    "head": "head against upright",
}
_HELD = ("static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "movements_per_min")
PART_NAMES = {
    "interruptions_per_h": {
        "resumed": "gone on with by the same one",
        "by_another": "gone on with by another",
        "handed_over": "handed over at once",
        "restarted": "begun anew",
        "open": "not gone on with",
    },
    "line_stopped_share": {
        "unfinished": "a job was not done",
        "full": "no room behind it",
        "down": "a station was down",
        "closed": "closed: a pause, not counted",
        "away": "nobody there: a pause, not counted",
    },
    **dict.fromkeys(SCORED, _BOUNDS),
    **dict.fromkeys(_BY, _BOTH),
    "exposure_gini": {**LEVELS, "posture_dose": "posture dose"},
    "lifting_index": {**_BOUNDS, "most": "the highest of any lift"},
    "composite_lifting_index": _BOUNDS,
    "energy_kcal_per_min": _BOUNDS,
    **dict.fromkeys(_HELD, _REGIONS),
    "en_1005_4_min_per_h": {**_REGIONS, "neck": "head and neck", "sideways": "trunk bent sideways or twisted"},
    "repetitions_per_min": {"most": "of the task begun most"},
    "rest_allowance_share": {
        "murrell": "for energy (Murrell)",
        "murrell_at_most": "for energy (Murrell), at most",
        "price": "for energy (Price)",
        "price_at_most": "for energy (Price), at most",
        "rohmert": "for what is held still (Rohmert)",
    },
    "fatigue_most": {
        **{f"{side}_{joint}": f"{side} {joint}" for joint in ("shoulder", "elbow") for side in ("left", "right")},
        **{"back": "low back", "hips": "hips", "knees": "knees"},
    },
}
"""By figure."""


def part_name(kpi: str, part: str) -> str:
    """A part in words; as it is written where there are none."""
    return PART_NAMES.get(kpi, {}).get(part, part)
