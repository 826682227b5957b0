"""Which way of a figure is better, where everybody agrees; and how a figure is named by who asks for two of them.

Apart from the figures themselves, so that reading a scenario needs no numpy.
"""

from __future__ import annotations

from dataclasses import dataclass

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
class Asked:
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


def read_asked(text: str) -> Asked:
    """``rula_from_5_min_per_h/ana/at_most``, ``less walked_m/ana`` or ``more worker_states/ana/wait`` -> Asked."""
    first, _, rest = text.strip().partition(" ")
    said, named = (first, rest.strip()) if rest and first in (MORE, LESS) else ("", text.strip())
    kpi, subject, part = [*(piece.strip() for piece in named.split("/", 2)), "", ""][:3]
    return Asked(kpi, subject, part, said or better_of(kpi, part))
