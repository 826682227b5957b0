"""Figures of lifting, holding still, energy and rest, in words."""

from __future__ import annotations

NAMES = {
    "lifting_index": "Lifting index (NIOSH; load over its limit)",
    "composite_lifting_index": "Lifting index of all lifts together (NIOSH)",
    "lifts_per_h": "Lifts and lowers",
    "lifts_out_of_range_share": "Lifts beyond the lifting equation's range",
    "static_hold_min_per_h": "Held still out of neutral",
    "longest_hold_s": "Longest hold",
    "iso_11226_min_per_h": "Held beyond ISO 11226",
    "en_1005_4_min_per_h": "Not acceptable by EN 1005-4",
    "movements_per_min": "Movements beyond 20°",
    "repetitions_per_min": "Performances begun, a minute of work",
    "energy_kcal_per_min": "Energy (Garg)",
    "rest_allowance_share": "Rest that the work asks for",
}
_BOUNDS = {"at_most": "at most", "worst": "whoever has most"}
_REGIONS = {
    "trunk": "trunk",
    "left_arm": "left arm",
    "right_arm": "right arm",
    "neck": "neck",
    "head": "head against upright",
}
_HELD = ("static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "movements_per_min")
PARTS = {
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
}
"""Parts in words, by figure."""
