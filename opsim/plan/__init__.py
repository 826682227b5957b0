"""Scenario -> Plan: names become numbers (in natural order, so number = rank), routes become tables, units are gone.

Both engines read a Plan and nothing else.
"""

from opsim.plan.calendar import Duty, Pause, ShiftPlan
from opsim.plan.compile import compile_plan
from opsim.plan.lines import CrewPlan, LinePlan
from opsim.plan.loads import StationLoad, station_loads
from opsim.plan.plan import Plan
from opsim.plan.products import Operation, ProductPlan, Ways
from opsim.plan.resources import BreakdownPlan, MaintenancePlan, RepairTeamPlan
from opsim.plan.sources import SourcePlan
from opsim.plan.stations import StationPlan
from opsim.plan.tasks import Ranks, TaskPlan
from opsim.plan.workers import RotationPlan, WalkingPlan, WorkerPlan

__all__ = [
    "BreakdownPlan",
    "CrewPlan",
    "Duty",
    "LinePlan",
    "MaintenancePlan",
    "Operation",
    "Pause",
    "Plan",
    "ProductPlan",
    "Ranks",
    "RepairTeamPlan",
    "RotationPlan",
    "ShiftPlan",
    "SourcePlan",
    "StationLoad",
    "StationPlan",
    "TaskPlan",
    "WalkingPlan",
    "Ways",
    "WorkerPlan",
    "compile_plan",
    "station_loads",
]
