"""All figures of a replication, and the samples behind the histograms."""

from collections.abc import Callable, Iterable

import numpy as np

from opsim.kpi.catalogue import EXPOSURE, POSTURE, TRIPS, Figure
from opsim.kpi.cycle_times import cycle_times, durations, oee, task_durations, work_by_visit
from opsim.kpi.states import active_time, bottleneck, station_states, worker_states
from opsim.kpi.throughput import (
    due_dates,
    line_balance,
    lost,
    takt,
    throughput,
    time_in_system,
    times_in_system,
    work_in_progress,
)
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.plugins.registry import subjects_of
from opsim.subjects.breakdowns.figures import outages, stops
from opsim.subjects.human.figures import fatigue, learned
from opsim.subjects.lines.figures import crews, lines
from opsim.subjects.material.figures import stores
from opsim.subjects.people.figures import trips, walked
from opsim.subjects.quality.figures import quality
from opsim.subjects.shifts.figures import duty, interruptions
from opsim.subjects.tools.figures import tools
from opsim.subjects.transport.figures import conveyors, transporters

_FUNCTIONS = (
    throughput,
    lost,
    time_in_system,
    due_dates,
    work_in_progress,
    worker_states,
    station_states,
    walked,
    work_by_visit,
    durations,
    takt,
    line_balance,
    oee,
    active_time,
    bottleneck,
    outages,
    stops,
    stores,
    conveyors,
    transporters,
    quality,
    tools,
    duty,
    interruptions,
    crews,
    lines,
    learned,
    fatigue,
)


def figures(log: EventLog, plan: Plan, asked: Iterable[str] = ()) -> list[Figure]:
    """Every figure this log has, in one fixed order; those that need postures, and trips, only where asked for.

    Where the plan looks at no postures (``posture: off``) these are left out, whoever asks.
    Raises ValueError where a task's postures cannot be had.
    """
    asked = set(asked)
    wanted = asked if plan.posture else set()
    functions: tuple[Callable[[EventLog, Plan], Iterable[Figure]], ...] = _FUNCTIONS
    if not wanted.isdisjoint(POSTURE):
        from opsim.subjects.exposure.trunk_figures import trunk_flexion

        functions = (*functions, trunk_flexion)
    if not set(TRIPS).isdisjoint(asked):
        functions = (*functions, trips)
    found = [figure for function in functions for figure in function(log, plan)]
    if not wanted.isdisjoint(EXPOSURE):  # a run that looks at no postures does not load what scores them
        from opsim.subjects.exposure.figures import exposure

        found += exposure(log, plan, wanted)
    found += [figure for subject, part in subjects_of(plan) for figure in subject.figures(log, plan, part)]
    return [figure._replace(value=float(figure.value)) for figure in found]


def samples(log: EventLog, plan: Plan) -> dict[tuple[str, str], np.ndarray]:
    """(kpi, subject) -> the single values in the window behind the means."""
    named = {
        "time_in_system_s": times_in_system,
        "cycle_time_s": cycle_times,
        "duration_s": task_durations,
    }
    return {
        (kpi, subject): values for kpi, function in named.items() for subject, values in function(log, plan).items()
    }
