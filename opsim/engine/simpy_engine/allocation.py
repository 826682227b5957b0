"""Free workers are sent to stations that call."""

from opsim.clock import on_grid
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Station, Worker
from opsim.engine.simpy_engine.station import perform
from opsim.engine.simpy_engine.worker import log_worker
from opsim.log import WALK


def send_workers(floor: Floor) -> None:
    """Serve the best pair of free worker and calling station, again and again."""
    while floor.free and floor.calling and (pair := _best_pair(floor)) is not None:
        _send(floor, *pair)


def _best_pair(floor: Floor) -> tuple[Worker, Station] | None:
    best = best_key = None
    for station in floor.calling.values():
        n_waiting, since_s, rank = len(station.calling) + len(station.queue), station.calling[0][0], station.rank
        for worker in floor.free.values():
            rating = worker.plan.rating[rank]
            if rating > 0:
                walk_s = _walk_m(floor, worker, station) / worker.plan.walk_m_per_s
                key = floor.rule(n_waiting, since_s, walk_s, rating, rank, worker.rank)
                if best_key is None or key < best_key:
                    best, best_key = (worker, station), key
    return best


def _send(floor: Floor, worker: Worker, station: Station) -> None:
    log_worker(floor, worker)
    del floor.free[worker.rank]
    _since_s, _number, job = station.calling.pop(0)
    if not station.calling:
        del floor.calling[station.rank]
    worker.job, worker.station = job, station
    walk_m = _walk_m(floor, worker, station)
    worker.walk_from, worker.place = worker.place, station.plan.place
    if walk_m == 0:
        perform(floor, job, worker)
        return
    worker.kind, worker.since_s = WALK, floor.now
    floor.at_end_of(on_grid(walk_m / worker.plan.walk_m_per_s), worker.stretch_over)


def _walk_m(floor: Floor, worker: Worker, station: Station) -> float:
    return floor.plan.distance_m[worker.place][station.plan.place]
