"""The structs of blocks, for those that refer to them; imported once, they are known by their names."""

from opsim.engine.floor.parts.belts import Belt
from opsim.engine.floor.parts.crews import Crew, CrewGate
from opsim.engine.floor.parts.doings import Doing, Holds
from opsim.engine.floor.parts.doses import Dose
from opsim.engine.floor.parts.failing import Failing, RepairTeam, Shop, Stop
from opsim.engine.floor.parts.gathering import Teams
from opsim.engine.floor.parts.gauges import Chances, Gauge
from opsim.engine.floor.parts.grips import Crib, Grip, JobTools, Want
from opsim.engine.floor.parts.hours import Hours
from opsim.engine.floor.parts.humans import Effects, Human, Model
from opsim.engine.floor.parts.job_blocks import JobBlocks
from opsim.engine.floor.parts.lines import Along, Andon, Due, Helping, Line, LineGate
from opsim.engine.floor.parts.loops import CardLine, Guard, Loop, Loops
from opsim.engine.floor.parts.ovens import Oven
from opsim.engine.floor.parts.people import Known, Needs, People, Relief
from opsim.engine.floor.parts.preempting import Preempting
from opsim.engine.floor.parts.presence import Duty, Moment, Pause, Presence
from opsim.engine.floor.parts.rotating import Counted, Posts, Rotation
from opsim.engine.floor.parts.sequencing import Sequence
from opsim.engine.floor.parts.servers import Servers, Stopped
from opsim.engine.floor.parts.sharing import Shared
from opsim.engine.floor.parts.splitting import Split, Splits
from opsim.engine.floor.parts.stints import Stint
from opsim.engine.floor.parts.stocks import Filling, Kits, Need, Refill, Shelf, Stock
from opsim.engine.floor.parts.vehicles import Leg, Pickup, Pool, Vehicle
from opsim.engine.floor.parts.wear import Countdown, Cycles, Wear

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
