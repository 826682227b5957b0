"""Jobs between stations: carried by the worker who did the last task."""

from opsim.engine.rules import walks_to_carry
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.station import arrive
from opsim.engine.simpy_engine.worker import log_worker, set_free, walk
from opsim.log import QUEUE, TRANSPORT


def bring(floor: Floor, job: Job, station: Station, carrier: Worker | None) -> None:
    """The job has its place at the next station and comes there: carried, or at once."""
    walk_s = 0.0 if carrier is None else carrier.walk_s[carrier.place][station.rank]
    if carrier is None or walk_s == 0:
        if carrier is not None:
            carrier.place = station.place
            _stand_at(carrier, station)
            set_free(floor, carrier)
        arrive(floor, station, job)
        return
    log_worker(floor, carrier)
    job.kind, carrier.station = TRANSPORT, station
    mass_kg, most_kg = job.plan.mass_kg, carrier.plan.most_load_kg
    carrier.walks_left = walks_to_carry(job.lot, mass_kg, most_kg) - 1 if mass_kg and most_kg else 0
    walk(floor, carrier, station.place, walk_s)


def put_down(floor: Floor, job: Job, carrier: Worker) -> None:
    """The carrier has come to the station with the job and is free there, if he need not go again for the rest."""
    if carrier.walks_left:
        _go_again(floor, carrier)
        return
    floor.job_now(job, QUEUE)
    _stand_at(carrier, job.station)
    set_free(floor, carrier)
    arrive(floor, job.station, job)


def _go_again(floor: Floor, carrier: Worker) -> None:
    """A part of the lot is there, or he is back where the rest of it lies: he walks the other way."""
    carrier.walks_left -= 1
    log_worker(floor, carrier)
    goal = carrier.walk_from
    walk(floor, carrier, goal, floor.plan.distance_m[carrier.place][goal] / carrier.plan.walk_m_per_s)


def _stand_at(carrier: Worker, station: Station) -> None:
    """Where the station is on his round, he goes on from it; elsewhere he serves nobody and walks to his next stop."""
    if station.rank in carrier.plan.patrol:
        carrier.round = carrier.plan.patrol.index(station.rank)
