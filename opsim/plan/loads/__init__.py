"""What everything would have to do if nothing ever waited: loads from mean durations, found without a run."""

from opsim.plan.loads.bottleneck import Bottleneck, bottleneck
from opsim.plan.loads.overload import overloads
from opsim.plan.loads.people import Crew, SkillLoad, crew_load, skill_loads
from opsim.plan.loads.shared import SharedLoad, shared_loads
from opsim.plan.loads.stations import StationLoad, station_loads

__all__ = [
    "Bottleneck",
    "Crew",
    "SharedLoad",
    "SkillLoad",
    "StationLoad",
    "bottleneck",
    "crew_load",
    "overloads",
    "shared_loads",
    "skill_loads",
    "station_loads",
]
