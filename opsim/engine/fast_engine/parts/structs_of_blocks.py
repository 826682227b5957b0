"""The structs of blocks, for those that refer to them; imported once, they are known by their names."""

from opsim.engine.fast_engine.parts.belts import Belt
from opsim.engine.fast_engine.parts.crews import Crew, CrewGate
from opsim.engine.fast_engine.parts.doings import Doing, Holds
from opsim.engine.fast_engine.parts.doses import Dose
from opsim.engine.fast_engine.parts.failing import Failing, RepairTeam, Shop, Stop
from opsim.engine.fast_engine.parts.gathering import Teams
from opsim.engine.fast_engine.parts.gauges import Chances, Gauge
from opsim.engine.fast_engine.parts.grips import Crib, Grip, JobTools, Want
from opsim.engine.fast_engine.parts.hours import Hours
from opsim.engine.fast_engine.parts.humans import Effects, Human, Model
from opsim.engine.fast_engine.parts.job_blocks import JobBlocks
from opsim.engine.fast_engine.parts.lines import Along, Andon, Due, Helping, Line, LineGate
from opsim.engine.fast_engine.parts.loops import CardLine, Guard, Loop, Loops
from opsim.engine.fast_engine.parts.ovens import Oven
from opsim.engine.fast_engine.parts.people import Known, Needs, People, Relief
from opsim.engine.fast_engine.parts.preempting import Preempting
from opsim.engine.fast_engine.parts.presence import Duty, Moment, Pause, Presence
from opsim.engine.fast_engine.parts.rotating import Counted, Posts, Rotation
from opsim.engine.fast_engine.parts.sequencing import Sequence
from opsim.engine.fast_engine.parts.servers import Servers, Stopped
from opsim.engine.fast_engine.parts.sharing import Shared
from opsim.engine.fast_engine.parts.splitting import Split, Splits
from opsim.engine.fast_engine.parts.stints import Stint
from opsim.engine.fast_engine.parts.stocks import Filling, Kits, Need, Refill, Shelf, Stock
from opsim.engine.fast_engine.parts.vehicles import Leg, Pickup, Pool, Vehicle
from opsim.engine.fast_engine.parts.wear import Countdown, Cycles, Wear

__all__ = [
    "Along",
    "Andon",
    "Belt",
    "CardLine",
    "Chances",
    "Countdown",
    "Counted",
    "Crew",
    "CrewGate",
    "Crib",
    "Cycles",
    "Doing",
    "Dose",
    "Due",
    "Duty",
    "Effects",
    "Failing",
    "Filling",
    "Gauge",
    "Grip",
    "Guard",
    "Helping",
    "Holds",
    "Hours",
    "Human",
    "JobBlocks",
    "JobTools",
    "Kits",
    "Known",
    "Leg",
    "Line",
    "LineGate",
    "Loop",
    "Loops",
    "Model",
    "Moment",
    "Need",
    "Needs",
    "Oven",
    "Pause",
    "People",
    "Pickup",
    "Pool",
    "Posts",
    "Preempting",
    "Presence",
    "Refill",
    "Relief",
    "RepairTeam",
    "Rotation",
    "Sequence",
    "Servers",
    "Shared",
    "Shelf",
    "Shop",
    "Split",
    "Splits",
    "Stint",
    "Stock",
    "Stop",
    "Stopped",
    "Teams",
    "Vehicle",
    "Want",
    "Wear",
]
