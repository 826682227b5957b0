"""Every figure, declared once: its name, title and unit, which way is better, of what it is and what it needs.

Apart from how figures are computed, so that reading a scenario needs no numpy.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

MORE, LESS = "more", "less"
FLOW, STATIONS, MATERIAL, PEOPLE, BODIES = "flow", "stations and tasks", "material and transport", "people", "bodies"
KINDS = (FLOW, STATIONS, MATERIAL, PEOPLE, BODIES)
"""In the order in which they are shown."""
POSTURES, WALKS, PAIRS = "postures of work", "postures of walking too", "pairs of places"
SCORES, REGIONS, LIFTS = "scores of postures", "scores by region", "lifts"
HOLDS, METABOLISM, REST_TIMES = "holds and movements", "energy spent", "rest that is asked for"


@dataclass(frozen=True, slots=True)
class Kpi:
    """A figure as it is declared.

    name   : as ``outputs`` of a scenario and results have it
    title  : as reports have it
    better : MORE or LESS, where everybody agrees; a part that is a share of something is better in no way
    kind   : one of KINDS, under which a long list of figures has it
    of     : what it is of, one each, such as ``station``; "" where it is of the whole too, or of several kinds
    needs  : what is made for it, and only where it is asked for; "" where the rows of the log are enough
    usual  : whether it stands in front where a scenario names no outputs
    """

    name: str
    title: str
    unit: str
    better: str
    kind: str
    of: str = ""
    needs: str = ""
    usual: bool = False


DECLARED = (
    Kpi("throughput_per_h", "Throughput (good units)", "1/h", MORE, FLOW, usual=True),
    Kpi("throughput_per_calendar_h", "Throughput (good units) per calendar hour", "1/h", MORE, FLOW, usual=True),
    Kpi("lost_per_h", "Jobs turned away", "1/h", LESS, FLOW, usual=True),
    Kpi("lost_share", "Share of jobs turned away", "share", LESS, FLOW, usual=True),
    Kpi("time_in_system_s", "Time in system", "s", LESS, FLOW, usual=True),
    Kpi("work_in_progress", "Jobs inside", "jobs", LESS, FLOW, usual=True),
    Kpi("worker_states", "State of worker", "share", "", PEOPLE, of="worker", usual=True),
    Kpi("station_states", "State of station", "share", "", STATIONS, of="station", usual=True),
    Kpi("queue_length", "Jobs waiting at the station", "jobs", LESS, STATIONS, of="station", usual=True),
    Kpi("walked_m", "Walked", "m", LESS, PEOPLE, of="worker", usual=True),
    Kpi("cycle_time_s", "Work a job gets at the station", "s", LESS, STATIONS, of="station", usual=True),
    Kpi("duration_s", "Duration of the task", "s", LESS, STATIONS, of="task", usual=True),
    Kpi("time_in_system_quantile_s", "Time in system, quantiles", "s", LESS, FLOW),
    Kpi("lead_time_s", "Lead time of the product", "s", LESS, FLOW, of="product"),
    Kpi("lead_time_quantile_s", "Lead time of the product, quantiles", "s", LESS, FLOW, of="product"),
    Kpi("cycle_time_quantile_s", "Work a job gets at the station, quantiles", "s", LESS, STATIONS, of="station"),
    Kpi("late_share", "Jobs later than their due date", "share", LESS, FLOW),
    Kpi("tardiness_s", "Tardiness, mean (0 where a job is early)", "s", LESS, FLOW),
    Kpi("takt_s", "Takt that the release asks for", "s", "", FLOW),
    Kpi("takt_attainment", "Jobs that follow the one before within takt", "share", MORE, FLOW),
    Kpi("line_balance_efficiency", "Line balance efficiency", "share", MORE, FLOW),
    Kpi("balance_loss", "Line balance loss", "share", LESS, FLOW),
    Kpi("smoothness_index_s", "Smoothness index (0 s: every station has the same work)", "s", LESS, FLOW),
    Kpi("oee", "Overall equipment effectiveness (OEE)", "share", MORE, STATIONS, of="station"),
    Kpi("oee_factor", "Factors of OEE", "share", "", STATIONS, of="station"),
    Kpi("active_period_s", "Active period of the station", "s", "", STATIONS, of="station"),
    Kpi("bottleneck", "Time as the bottleneck", "share", "", STATIONS, of="station"),
    Kpi("stops_per_h", "Stops of the station", "1/h", LESS, STATIONS, of="station"),
    Kpi("down_s", "Time from a stop until the station runs again", "s", LESS, STATIONS, of="station"),
    Kpi("wait_for_repair_s", "Time from a stop until its repair began", "s", LESS, STATIONS, of="station"),
    Kpi("mean_time_between_failures_s", "Mean time between failures (MTBF)", "s", MORE, STATIONS, of="station"),
    Kpi("stop_share", "Station stood because of", "share", LESS, STATIONS, of="station"),
    Kpi("repair_team_use", "Use of the repair team", "share", "", STATIONS),
    Kpi("stock", "Jobs in the store", "jobs", "", MATERIAL, of="store"),
    Kpi("stock_empty", "Time in which the store was empty", "share", LESS, MATERIAL, of="store"),
    Kpi("stored_per_h", "Put into a store", "1/h", "", MATERIAL),
    Kpi("time_to_store_s", "Time until it is in the store", "s", LESS, MATERIAL),
    Kpi("parts_used_per_h", "Parts used", "1/h", "", MATERIAL),
    Kpi("on_conveyor", "Jobs on the conveyor", "jobs", "", MATERIAL, of="conveyor"),
    Kpi(
        "conveyor_blocked",
        "Time in which the end of the conveyor found no room",
        "share",
        LESS,
        MATERIAL,
        of="conveyor",
    ),
    Kpi("transporter_states", "State of the vehicles", "share", "", MATERIAL),
    Kpi("driven_m", "Driven by all vehicles", "m", LESS, MATERIAL),
    Kpi("pickup_wait_s", "Wait of a job until it was loaded", "s", LESS, MATERIAL),
    Kpi("scrap_per_h", "Scrap", "1/h", LESS, FLOW),
    Kpi("scrap_share", "Share of scrap", "share", LESS, FLOW),
    Kpi("first_pass_yield", "Good at the first go (first pass yield)", "share", MORE, FLOW),
    Kpi("defects_out_share", "Finished with a defect that nobody found", "share", LESS, FLOW),
    Kpi("rework_per_h", "Rework", "1/h", LESS, FLOW),
    Kpi("false_alarm_share", "Good ones among what was turned down", "share", LESS, FLOW),
    Kpi("tool_use", "Use of tools", "share", "", STATIONS, of="tool"),
    Kpi("tools_waited_for", "Jobs that wait for tools", "jobs", LESS, STATIONS),
    Kpi("on_duty_h", "On duty", "h", "", PEOPLE),
    Kpi("duty_use", "Busy, of the time on duty without breaks", "share", "", PEOPLE),
    Kpi("overtime_h", "Overtime, finishing included", "h", LESS, PEOPLE),
    Kpi("absent_share", "Share of shifts missed", "share", LESS, PEOPLE),
    Kpi("interruptions_per_h", "Work broken off", "1/h", LESS, PEOPLE),
    Kpi("hand_overs_per_h", "Hand-overs of the crew", "1/h", LESS, PEOPLE),
    Kpi("handoff_position", "Where on the line a job is handed over (share of its work)", "share", "", PEOPLE),
    Kpi("incomplete_share", "Jobs that left the line unfinished", "share", LESS, STATIONS, of="line"),
    Kpi("line_stopped_share", "Time in which the line stood", "share", LESS, STATIONS, of="line"),
    Kpi("learned_share", "Time as a share of that of the first repetition", "share", LESS, PEOPLE),
    Kpi("experience", "Repetitions of the task behind somebody", "", "", PEOPLE, of="worker"),
    Kpi("fatigue_mean", "Fatigue at work, from 0 (fresh) to 1", "share", LESS, PEOPLE),
    Kpi("fatigue_most", "Most fatigue after a piece of work, from 0 (fresh) to 1", "share", LESS, PEOPLE),
    Kpi("rest_taken_min_per_h", "Rest by need", "min/h", "", PEOPLE),
    Kpi("trips_per_h", "Trips", "1/h", "", FLOW, needs=PAIRS),
    Kpi("trunk_beyond_60_min_per_h", "Trunk flexed 60° or more", "min/h", LESS, BODIES, needs=POSTURES),
    Kpi("trunk_beyond_20_min_per_h", "Trunk flexed 20° or more", "min/h", LESS, BODIES, needs=POSTURES),
    Kpi("trunk_flexion_mean_deg", "Trunk flexion at work, mean", "deg", LESS, BODIES, needs=POSTURES),
    Kpi("trunk_flexion_p95_deg", "Trunk flexion at work, 95th percentile", "deg", LESS, BODIES, needs=POSTURES),
    Kpi("trunk_flexion_share", "Time by trunk flexion", "share", LESS, BODIES, of="worker", needs=POSTURES),
    Kpi("posture_measured_share", "Work whose posture is known", "share", "", BODIES, needs=POSTURES),
    Kpi("walking_min_per_h", "Walking", "min/h", "", BODIES, needs=WALKS),
    Kpi("steps_per_h", "Steps", "1/h", "", BODIES, needs=WALKS),
    Kpi("step_length_m", "Step length", "m", "", BODIES, needs=WALKS),
    Kpi("cadence_per_min", "Steps a minute of walking", "1/min", "", BODIES, needs=WALKS),
    Kpi("walking_measured_share", "Walking whose posture is known", "share", "", BODIES, needs=WALKS),
    Kpi("rula_from_5_min_per_h", "RULA 5 or more", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("rula_from_7_min_per_h", "RULA 7", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("reba_from_8_min_per_h", "REBA 8 or more", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("owas_from_3_min_per_h", "OWAS category 3 or 4", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("arm_beyond_60_min_per_h", "Upper arm raised 60° or more", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("arm_beyond_90_min_per_h", "Upper arm raised 90° or more", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("rula_mean", "RULA, mean over time", "1", LESS, BODIES, needs=SCORES),
    Kpi("rula_p90", "RULA, not exceeded in 90 % of the time", "1", LESS, BODIES, needs=SCORES),
    Kpi("rula_most", "RULA, the highest", "1", LESS, BODIES, needs=SCORES),
    Kpi("reba_mean", "REBA, mean over time", "1", LESS, BODIES, needs=SCORES),
    Kpi("reba_p90", "REBA, not exceeded in 90 % of the time", "1", LESS, BODIES, needs=SCORES),
    Kpi("reba_most", "REBA, the highest", "1", LESS, BODIES, needs=SCORES),
    Kpi("posture_dose", "Posture dose (RULA score times hours)", "score h", LESS, BODIES, needs=SCORES),
    Kpi("exposure_gini", "Unevenness of exposure (Gini; 0: all alike)", "1", LESS, BODIES, needs=SCORES),
    Kpi("exposure_by_station", "Exposure at the station", "min/h", LESS, BODIES, of="station", needs=SCORES),
    Kpi("exposure_by_task", "Exposure at the task", "min/h", LESS, BODIES, of="task", needs=SCORES),
    Kpi("exposure_by_product", "Exposure with the product", "min/h", LESS, BODIES, of="product", needs=SCORES),
    Kpi("exposure_by_hour", "Exposure by the hour of the day", "min/h", LESS, BODIES, needs=SCORES),
    Kpi("exposure_by_region", "Exposure that comes from", "min/h", LESS, BODIES, needs=REGIONS),
    Kpi("lifting_index", "Lifting index (NIOSH; load over its limit)", "1", LESS, BODIES, of="task", needs=LIFTS),
    Kpi(
        "composite_lifting_index",
        "Lifting index of all lifts together (NIOSH)",
        "1",
        LESS,
        BODIES,
        of="worker",
        needs=LIFTS,
    ),
    Kpi("lifts_per_h", "Lifts and lowers", "1/h", "", BODIES, of="task", needs=LIFTS),
    Kpi("lifts_out_of_range_share", "Lifts beyond the lifting equation's range", "share", LESS, BODIES, needs=LIFTS),
    Kpi("static_hold_min_per_h", "Held still out of neutral", "min/h", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("longest_hold_s", "Longest hold", "s", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("iso_11226_min_per_h", "Held beyond ISO 11226", "min/h", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("en_1005_4_min_per_h", "Not acceptable by EN 1005-4", "min/h", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("movements_per_min", "Movements beyond 20°", "1/min", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("repetitions_per_min", "Performances begun, a minute of work", "1/min", LESS, BODIES, of="worker", needs=HOLDS),
    Kpi("energy_kcal_per_min", "Energy (Garg)", "kcal/min", LESS, BODIES, needs=METABOLISM),
    Kpi("rest_allowance_share", "Rest that the work asks for", "share", LESS, BODIES, of="worker", needs=REST_TIMES),
)
"""In the order in which they are listed."""
CATALOGUE = {one.name: one for one in DECLARED}
KPIS = CATALOGUE.keys()
"""Of ours, and of the subjects of somebody else that have been asked for (``opsim.plugins.subjects``)."""
USUAL = tuple(one.name for one in DECLARED if one.usual)


def needing(*what: str) -> tuple[str, ...]:
    """Names of the figures that need one of these."""
    return tuple(one.name for one in DECLARED if one.needs in what)


TRIPS = needing(PAIRS)
"""Of every pair of places: made only where asked for, as there may be thousands of pairs."""
WALKING = needing(WALKS)
"""What needs the postures of walking too, of which a scenario's ``walking:`` says where they come from."""
POSTURE = needing(POSTURES, WALKS)
"""What needs the postures behind the work. They are made only where one is asked for, as decoding takes longer than a
run; and how much of the work was measured then stands beside what was asked for."""
SCORED, REGION, LIFTED, HELD = needing(SCORES), needing(REGIONS), needing(LIFTS), needing(HOLDS)
ENERGY, REST = needing(METABOLISM), needing(REST_TIMES)
EXPOSURE = (*SCORED, *REGION, *LIFTED, *HELD, *ENERGY, *REST)
"""What bodies went through in the whole shift: one pass over all postures, made only where one of these is asked."""


def needs_postures(asked: Iterable[str]) -> bool:
    """Whether any of some figures is one of ``POSTURE`` or ``EXPOSURE``."""
    return not {*POSTURE, *EXPOSURE}.isdisjoint(asked)


def headline(outputs: Iterable[str]) -> set[str]:
    """What stands in front where these outputs are asked for."""
    asked = set(outputs)
    beside = {"walking_measured_share"} if asked.intersection(WALKING) else set()
    return asked | beside | {"posture_measured_share"} if needs_postures(asked) else asked


def subject_of(kpi: str) -> str:
    """What a figure is of, one each: ``station``; "" where it is of the whole too, or of several kinds of things."""
    return CATALOGUE[kpi].of if kpi in CATALOGUE else ""


def kind_of(kpi: str) -> str:
    """One of KINDS; FLOW for a figure that is not known."""
    return CATALOGUE[kpi].kind if kpi in CATALOGUE else FLOW


def better_of(kpi: str, part: str = "") -> str:
    """MORE, LESS, or "" where it depends on who asks, as with parts of a state.

    A part that is a share of something, such as a state, has no way that is better for everybody.
    """
    if kpi not in CATALOGUE or (part and kpi == "trunk_flexion_share"):
        return ""
    return CATALOGUE[kpi].better


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


def figure(kpi: str, subject: str, part: str, value: float) -> Figure:
    """A figure in the unit that it is declared with."""
    return Figure(kpi, subject, part, CATALOGUE[kpi].unit, value)
