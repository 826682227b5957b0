"""What everything would have to do if nothing ever waited: loads from mean durations, found without a run."""

from opsim.plan.loads.bottleneck import Bottleneck, Loads, bottleneck, loads_of, overloads
from opsim.plan.loads.people import Crew, SkillLoad, crew_load, skill_loads
from opsim.plan.loads.utilisation import SharedLoad, StationLoad, shared_loads, station_loads

__all__ = [
    "Bottleneck",
    "Crew",
    "Loads",
    "SharedLoad",
    "SkillLoad",
    "StationLoad",
    "bottleneck",
    "crew_load",
    "loads_of",
    "overloads",
    "shared_loads",
    "skill_loads",
    "station_loads",
]
