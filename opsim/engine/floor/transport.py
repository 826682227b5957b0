"""Jobs between stations: carried by the worker who did the last task."""

from __future__ import annotations

from opsim.engine.floor.machine import here, inlined, step
from opsim.engine.floor.parts.rows import job_now, log_worker
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.engine.floor.station import arrive
from opsim.engine.floor.worker import set_free, walk
from opsim.engine.rules import transport
from opsim.log import QUEUE, TRANSPORT

_walks_to_carry = inlined(transport.walks_to_carry)


@step
def bring(floor: Floor, job: Job, station: Station, carrier: Worker) -> None:
    """The job has its place at the next station and comes there: carried, or at once where nobody carries it."""
    walk_s = carrier.walk_s[carrier.place * floor.n_stations + station.rank] if carrier else 0.0
    if not carrier or walk_s == 0:
        if carrier:
            carrier.place = station.place
            _stand_at(carrier, station)
            set_free(floor, carrier)
        _arrive(floor, station, job)
        return
    log_worker(floor, carrier)
    job.kind = TRANSPORT
    carrier.station = station
    mass_kg, most_kg = job.plan.mass_kg, carrier.most_load_kg
    carrier.walks_left = 0
    if mass_kg > 0 and most_kg > 0:
        carrier.walks_left = int(_walks_to_carry(job.lot, mass_kg, most_kg)) - 1
    walk(floor, carrier, station.place, walk_s)


@step
def put_down(floor: Floor, job: Job, carrier: Worker) -> None:
    """The carrier has come to the station with the job and is free there, if he need not go again for the rest."""
    if carrier.walks_left:
        _go_again(floor, carrier)
        return
    job_now(floor, job, QUEUE, 0)
    _stand_at(carrier, job.station)
    set_free(floor, carrier)
    arrive(floor, job.station, job)


@inlined
def _go_again(floor: Floor, carrier: Worker) -> None:
    """A part of the lot is there, or he is back where the rest of it lies: he walks the other way."""
    carrier.walks_left -= 1
    log_worker(floor, carrier)
    goal = carrier.walk_from
    walk(floor, carrier, goal, floor.distance_m[carrier.place * floor.n_places + goal] / carrier.walk_m_per_s)


@inlined
def _stand_at(carrier: Worker, station: Station) -> None:
    """Where the station is on his round, he goes on from it; elsewhere he serves nobody and walks to his next stop."""
    for i in range(carrier.n_patrol):
        if carrier.patrol[i] == station.rank:
            carrier.round = i
            return


_arrive = here(arrive)
