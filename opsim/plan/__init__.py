"""Scenario -> Plan: names become numbers (in natural order, so number = rank), routes become tables, units are gone.

Both engines read a Plan and nothing else.
"""

from opsim.plan.calendar import Duty, Pause, ShiftPlan
from opsim.plan.compile import compile_plan
from opsim.plan.crews import CrewPlan
from opsim.plan.failures import BreakdownPlan, MaintenancePlan, RepairTeamPlan
from opsim.plan.lines import LinePlan
from opsim.plan.loads import StationLoad, station_loads
from opsim.plan.material import Operation, ProductPlan, Ways
from opsim.plan.plan import Plan
from opsim.plan.ranks import Ranks
from opsim.plan.release import SourcePlan
from opsim.plan.rotations import RotationPlan
from opsim.plan.station import StationPlan
from opsim.plan.tasks import TaskPlan
from opsim.plan.walking import WalkingPlan
from opsim.plan.worker import WorkerPlan

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
