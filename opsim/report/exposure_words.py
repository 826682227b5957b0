"""Figures of what bodies go through, in words."""

from __future__ import annotations

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
NAMES = {
    "rula_from_5_min_per_h": "RULA 5 or more",
    "rula_from_7_min_per_h": "RULA 7",
    "reba_from_8_min_per_h": "REBA 8 or more",
    "owas_from_3_min_per_h": "OWAS category 3 or 4",
    "arm_beyond_60_min_per_h": "Upper arm raised 60° or more",
    "arm_beyond_90_min_per_h": "Upper arm raised 90° or more",
    "rula_mean": "RULA, mean over time",
    "rula_p90": "RULA, not exceeded in 90 % of the time",
    "rula_most": "RULA, the highest",
    "reba_mean": "REBA, mean over time",
    "reba_p90": "REBA, not exceeded in 90 % of the time",
    "reba_most": "REBA, the highest",
    "posture_dose": "Posture dose (RULA score times hours)",
    "exposure_gini": "Unevenness of exposure (Gini; 0: all alike)",
    "exposure_by_station": "Exposure at the station",
    "exposure_by_task": "Exposure at the task",
    "exposure_by_product": "Exposure with the product",
    "exposure_by_hour": "Exposure by the hour of the day",
    "exposure_by_region": "Exposure that comes from",
}
REGIONS = {
    "trunk": "the trunk",
    "neck": "the neck",
    "arms": "the arms",
    "wrists": "the wrists",
    "legs": "the legs",
    "load": "the load",
    "time": "repeating or holding",
}
"""From where a score comes, as it is said."""
_BY = ("exposure_by_station", "exposure_by_task", "exposure_by_product", "exposure_by_hour", "exposure_by_region")
_BOUNDS = {"at_most": "at most", "worst": "whoever has most"}
_BOTH = {**LEVELS, **{f"{level}_at_most": f"{words}, at most" for level, words in LEVELS.items()}}
PARTS = {
    **{kpi: _BOUNDS for kpi in NAMES if kpi not in (*_BY, "exposure_gini")},
    **dict.fromkeys(_BY, _BOTH),
    "exposure_gini": {**LEVELS, "posture_dose": "posture dose"},
}
"""Parts in words, by figure."""
