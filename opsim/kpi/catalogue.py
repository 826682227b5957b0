"""Names of the figures a scenario may list under ``outputs``; apart, so that reading a scenario needs no numpy.

Figures that are of one thing each and not of the whole: what has to be named where one of them is asked for.

Which way of a figure is better, where everybody agrees; and how a figure is named by who asks for two of them.

Apart from the figures themselves, so that reading a scenario needs no numpy.

One figure of one replication.

Figures of what bodies go through, in words.

Figures of lifting, holding still, energy and rest, in words.

Figures sorted by what they are of, so that a long list of them can be read.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

USUAL = (
    "throughput_per_h",
    "throughput_per_calendar_h",
    "lost_per_h",
    "lost_share",
    "time_in_system_s",
    "work_in_progress",
    "worker_states",
    "station_states",
    "queue_length",
    "walked_m",
    "cycle_time_s",
    "duration_s",
)
"""What stands in front where a scenario names no outputs."""

WALKING = ("walking_min_per_h", "steps_per_h", "step_length_m", "cadence_per_min", "walking_measured_share")
"""What needs the postures of walking too, of which a scenario's ``walking:`` says where they come from."""

POSTURE = (
    "trunk_beyond_60_min_per_h",
    "trunk_beyond_20_min_per_h",
    "trunk_flexion_mean_deg",
    "trunk_flexion_p95_deg",
    "trunk_flexion_share",
    "posture_measured_share",
    *WALKING,
)
"""What needs the postures behind the work. They are made only where one is asked for, as decoding takes longer than a
run; and how much of the work was measured then stands beside what was asked for."""

SCORED = (
    *("rula_from_5_min_per_h", "rula_from_7_min_per_h", "reba_from_8_min_per_h", "owas_from_3_min_per_h"),
    *("arm_beyond_60_min_per_h", "arm_beyond_90_min_per_h"),
    *("rula_mean", "rula_p90", "rula_most", "reba_mean", "reba_p90", "reba_most"),
    *("posture_dose", "exposure_gini"),
    *("exposure_by_station", "exposure_by_task", "exposure_by_product", "exposure_by_hour"),
)
REGION = ("exposure_by_region",)
LIFTED = ("lifting_index", "composite_lifting_index", "lifts_per_h", "lifts_out_of_range_share")
HELD = (
    *("static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "en_1005_4_min_per_h", "movements_per_min"),
    "repetitions_per_min",
)
ENERGY, REST = ("energy_kcal_per_min",), ("rest_allowance_share",)
EXPOSURE = (*SCORED, *REGION, *LIFTED, *HELD, *ENERGY, *REST)
"""What bodies went through in the whole shift: one pass over all postures, made only where one of these is asked."""

TRIPS = ("trips_per_h",)
"""Of every pair of places: made only where asked for, as there may be thousands of pairs."""

KPIS = (
    *USUAL,
    "time_in_system_quantile_s",
    "lead_time_s",
    "lead_time_quantile_s",
    "cycle_time_quantile_s",
    "late_share",
    "tardiness_s",
    "takt_s",
    "takt_attainment",
    "line_balance_efficiency",
    "balance_loss",
    "smoothness_index_s",
    "oee",
    "oee_factor",
    "active_period_s",
    "bottleneck",
    "stops_per_h",
    "down_s",
    "wait_for_repair_s",
    "mean_time_between_failures_s",
    "stop_share",
    "repair_team_use",
    "stock",
    "stock_empty",
    "stored_per_h",
    "time_to_store_s",
    "parts_used_per_h",
    "on_conveyor",
    "conveyor_blocked",
    "transporter_states",
    "driven_m",
    "pickup_wait_s",
    "scrap_per_h",
    "scrap_share",
    "first_pass_yield",
    "defects_out_share",
    "rework_per_h",
    "false_alarm_share",
    "tool_use",
    "tools_waited_for",
    "on_duty_h",
    "duty_use",
    "overtime_h",
    "absent_share",
    "interruptions_per_h",
    "hand_overs_per_h",
    "handoff_position",
    "incomplete_share",
    "line_stopped_share",
    "learned_share",
    "experience",
    "fatigue_mean",
    "fatigue_most",
    "rest_taken_min_per_h",
    *TRIPS,
    *POSTURE,
    *EXPOSURE,
)


def needs_postures(asked: Iterable[str]) -> bool:
    """Whether any of some figures is one of ``POSTURE`` or ``EXPOSURE``."""
    return not {*POSTURE, *EXPOSURE}.isdisjoint(asked)


def headline(outputs: Iterable[str]) -> set[str]:
    """What stands in front where these outputs are asked for."""
    asked = set(outputs)
    beside = {"walking_measured_share"} if asked.intersection(WALKING) else set()
    return asked | beside | {"posture_measured_share"} if needs_postures(asked) else asked


OF_EACH = {
    "worker": (
        *("worker_states", "walked_m", "experience", "trunk_flexion_share", "rest_allowance_share"),
        *("composite_lifting_index", "static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h"),
        *("en_1005_4_min_per_h", "movements_per_min", "repetitions_per_min"),
    ),
    "station": (
        *("station_states", "queue_length", "cycle_time_s", "cycle_time_quantile_s", "active_period_s", "oee"),
        *("oee_factor", "stops_per_h", "down_s", "wait_for_repair_s", "mean_time_between_failures_s", "stop_share"),
        *("bottleneck", "exposure_by_station"),
    ),
    "task": ("duration_s", "lifting_index", "lifts_per_h", "exposure_by_task"),
    "product": ("lead_time_s", "lead_time_quantile_s", "exposure_by_product"),
    "store": ("stock", "stock_empty"),
    "conveyor": ("on_conveyor", "conveyor_blocked"),
    "line": ("incomplete_share", "line_stopped_share"),
    "tool": ("tool_use",),
}
"""By what is named: the figures without a figure of the whole."""


def subject_of(kpi: str) -> str:
    """What a figure is of, one each: ``station``; "" where it is of the whole too, or of several kinds of things."""
    return next((kind for kind, names in OF_EACH.items() if kpi in names), "")


MORE, LESS = "more", "less"
MORE_IS_BETTER = (
    *("throughput_per_h", "throughput_per_calendar_h", "takt_attainment", "line_balance_efficiency", "oee"),
    *("mean_time_between_failures_s", "first_pass_yield"),
)
LESS_IS_BETTER = (
    *("lost_per_h", "lost_share", "time_in_system_s", "time_in_system_quantile_s", "work_in_progress", "queue_length"),
    *("walked_m", "cycle_time_s", "cycle_time_quantile_s", "duration_s", "lead_time_s", "lead_time_quantile_s"),
    *("late_share", "tardiness_s", "balance_loss", "smoothness_index_s", "stops_per_h", "down_s", "wait_for_repair_s"),
    *("stop_share", "stock_empty", "time_to_store_s", "conveyor_blocked", "driven_m", "pickup_wait_s"),
    *("scrap_per_h", "scrap_share", "defects_out_share", "rework_per_h", "false_alarm_share", "tools_waited_for"),
    *("overtime_h", "absent_share", "interruptions_per_h", "hand_overs_per_h", "incomplete_share"),
    *("line_stopped_share", "posture_dose", "repetitions_per_min", "lifting_index", "composite_lifting_index"),
    *("energy_kcal_per_min", "rest_allowance_share", "longest_hold_s", "movements_per_min", "lifts_out_of_range_share"),
    "learned_share",
)
LESS_OF = ("trunk_beyond_", "trunk_flexion_", "arm_beyond_", "rula_", "reba_", "owas_", "exposure_", "static_hold_")
LESS_OF_LIMITS = ("iso_11226_", "en_1005_", "fatigue_")
"""Beginnings of names of which less is better."""


@dataclass(frozen=True, slots=True)
class AskedFigure:
    """One figure that somebody asked for: ``better`` is MORE or LESS, or "" where nobody said and nobody agrees."""

    kpi: str
    subject: str = ""
    part: str = ""
    better: str = ""

    @property
    def name(self) -> str:
        """As it is written: kpi, kpi/subject or kpi/subject/part."""
        return "/".join((self.kpi, self.subject, self.part)).rstrip("/")


def better_of(kpi: str, part: str = "") -> str:
    """MORE, LESS, or "" where it depends on who asks, as with parts of a state.

    A part that is a share of something, such as a state, has no way that is better for everybody.
    """
    if kpi.endswith("_states") or (kpi.endswith("_share") and part and kpi.startswith("trunk_")):
        return ""
    if kpi in MORE_IS_BETTER:
        return MORE
    return LESS if kpi in LESS_IS_BETTER or kpi.startswith((*LESS_OF, *LESS_OF_LIMITS)) else ""


def read_asked(text: str) -> AskedFigure:
    """``rula_from_5_min_per_h/ana/at_most``, ``less walked_m/ana`` or ``more worker_states/ana/wait`` -> Asked."""
    first, _, rest = text.strip().partition(" ")
    said, named = (first, rest.strip()) if rest and first in (MORE, LESS) else ("", text.strip())
    kpi, subject, part = [*(piece.strip() for piece in named.split("/", 2)), "", ""][:3]
    return AskedFigure(kpi, subject, part, said or better_of(kpi, part))


class Figure(NamedTuple):
    """kpi : its name; subject : worker, station, product or task, empty for the whole; part : a state."""

    kpi: str
    subject: str
    part: str
    unit: str
    value: float


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
EXPOSURE_NAMES = {
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
_BY = ("exposure_by_station", "exposure_by_task", "exposure_by_product", "exposure_by_hour", "exposure_by_region")
_BOUNDS = {"at_most": "at most", "worst": "whoever has most"}
_BOTH = {**LEVELS, **{f"{level}_at_most": f"{words}, at most" for level, words in LEVELS.items()}}
EXPOSURE_PARTS = {
    **{kpi: _BOUNDS for kpi in EXPOSURE_NAMES if kpi not in (*_BY, "exposure_gini")},
    **dict.fromkeys(_BY, _BOTH),
    "exposure_gini": {**LEVELS, "posture_dose": "posture dose"},
}
"""Parts in words, by figure."""


STRAIN_NAMES = {
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
_REGIONS = {
    "trunk": "trunk",
    "left_arm": "left arm",
    "right_arm": "right arm",
    "neck": "neck",
    "head": "head against upright",
}
_HELD = ("static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "movements_per_min")
STRAIN_PARTS = {
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


FLOW, STATIONS, MATERIAL, PEOPLE, BODIES = "flow", "stations and tasks", "material and transport", "people", "bodies"
KINDS = (FLOW, STATIONS, MATERIAL, PEOPLE, BODIES)
"""In the order in which they are shown."""

_OF = {
    STATIONS: (
        *("station_states", "queue_length", "cycle_time_s", "cycle_time_quantile_s", "duration_s", "oee", "oee_factor"),
        *("active_period_s", "bottleneck", "stops_per_h", "down_s", "wait_for_repair_s", "stop_share"),
        *("mean_time_between_failures_s", "repair_team_use", "tool_use", "tools_waited_for", "line_stopped_share"),
        "incomplete_share",
    ),
    MATERIAL: (
        *("stock", "stock_empty", "stored_per_h", "time_to_store_s", "parts_used_per_h", "on_conveyor"),
        *("conveyor_blocked", "transporter_states", "driven_m", "pickup_wait_s"),
    ),
    PEOPLE: (
        *("worker_states", "walked_m", "on_duty_h", "duty_use", "overtime_h", "absent_share", "interruptions_per_h"),
        *("hand_overs_per_h", "handoff_position", "learned_share", "experience", "fatigue_mean", "fatigue_most"),
        "rest_taken_min_per_h",
    ),
    BODIES: (*POSTURE, *EXPOSURE),
}
_KIND = {kpi: kind for kind, kpis in _OF.items() for kpi in kpis}


def kind_of(kpi: str) -> str:
    """One of KINDS; FLOW for all that is of nothing else."""
    return _KIND.get(kpi, FLOW)
