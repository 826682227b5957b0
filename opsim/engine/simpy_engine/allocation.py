"""Free workers are sent to stations that call; who is not sent stays, goes home, or walks on his round."""

from opsim.engine.simpy_engine.floor import Floor, pair_key
from opsim.engine.simpy_engine.state import CREWS, Job, Station, Worker
from opsim.engine.simpy_engine.station import call_off, perform
from opsim.engine.simpy_engine.worker import log_worker, walk


def send_workers(floor: Floor) -> None:
    """Serve the best pair of free worker and calling station, again and again; then the idle do as the plan says."""
    idle = floor.plan.idle
    while True:
        while floor.free and floor.calling and _serve_best(floor, idle == "patrol"):
            pass
        if idle == "stay" or not floor.free:
            return
        if idle == "home":
            _go_home(floor)
            return
        if not _walk_on(floor):
            return


def _serve_best(floor: Floor, patrols: bool) -> bool:
    """The worker of the best pair is sent, where there is one; True where there may be another pair."""
    best = best_key = None
    calling, calls = floor.calling, floor.calls
    for worker in floor.free.values():
        able = worker.skills & calls
        while able:  # NOTE: only stations he can serve are looked at, by the bits of their ranks
            station = calling[(able & -able).bit_length() - 1]
            able &= able - 1
            if patrols and not on_round(worker, station):
                continue
            if best is None:
                best = worker, station  # NOTE: most often the only pair, and its key is never asked for
                continue
            best_key = best_key or _key(floor, *best)
            key = _key(floor, worker, station)
            if key < best_key:
                best, best_key = (worker, station), key
    if best is None:
        return False
    n_free = len(floor.free)
    if best[1].calling[0][3].with_tools:
        best = _who_waits_longest(floor, best, patrols)
    worker, station = best
    send(floor, worker, station, station.calling[0][3])
    # NOTE: it was the only pair, and nobody has come free or has called since: there is none, and no need to look
    return best_key is not None or len(floor.free) >= n_free or floor.calls & ~calls != 0


def _who_waits_longest(floor: Floor, best: tuple[Worker, Station], patrols: bool) -> tuple[Worker, Station]:
    """The pair, or that of who has waited longer for the same tools, where somebody is free for him too."""
    station = best[1]
    for other in station.before(floor, station.calling[0][3]):  # type: ignore[misc]
        able = [worker for worker in floor.free.values() if worker.may_serve(other)]
        able = [worker for worker in able if not patrols or on_round(worker, other)]
        if able:
            return min(able, key=lambda worker: _key(floor, worker, other)), other
    return best


def _key(floor: Floor, worker: Worker, station: Station) -> tuple[float, ...]:
    calls = station.calling
    return pair_key(floor, worker, station, calls[0][3], len(calls) + len(station.queue), calls[0][1])


def send(floor: Floor, worker: Worker, station: Station, job: Job) -> None:
    """A free worker goes to a job on a server of a station, which calls there for anybody, or waits for him."""
    if floor.now > worker.since_s:
        log_worker(floor, worker)
    del floor.free[worker.rank]
    calls = station.calling
    if calls and calls[0][3] is job:  # NOTE: most often
        del calls[0]
        if not calls:
            del floor.calling[station.rank]
            floor.calls ^= 1 << station.rank
    else:
        call_off(floor, station, job)
    if job.with_tools:
        station.sent(floor, job)  # type: ignore[misc]
    worker.job, worker.station = job, station
    walk_s = worker.walk_s[worker.place][station.rank]
    if walk_s > 0:
        walk(floor, worker, station.place, walk_s)
    else:
        worker.place = station.place
        perform(floor, job, worker)


def on_round(worker: Worker, station: Station) -> bool:
    """Whether this is the station of his round where the worker stands: the only one a patrolling worker serves, and
    none any more once he has served there as long as he shall.
    """
    at, patrol = worker.round, worker.plan.patrol
    return at >= 0 and patrol[at] == station.rank and worker.place == station.place and not worker.served


def _go_home(floor: Floor) -> None:
    away = [w for w in floor.free.values() if w.place != w.plan.place and CREWS not in w.limits]
    for worker in away:
        metres = floor.plan.distance_m[worker.place][worker.plan.place]
        if metres > 0:
            _leave(floor, worker, worker.plan.place, metres / worker.plan.walk_m_per_s)
        else:
            worker.place = worker.plan.place


def _walk_on(floor: Floor) -> bool:
    """Patrolling workers go to the next station of their round; True where one came to a call without walking."""
    came = False
    for worker in sorted(floor.free.values(), key=lambda w: w.rank):
        patrol = worker.plan.patrol
        for _ in patrol:
            worker.round, worker.served = (worker.round + 1) % len(patrol), False
            station = floor.stations[patrol[worker.round]]
            walk_s = worker.walk_s[worker.place][station.rank]
            if walk_s > 0:
                _leave(floor, worker, station.place, walk_s)
                break
            worker.place = station.place
            if station.calling and worker.may_serve(station):
                came = True
                break
    return came


def _leave(floor: Floor, worker: Worker, place: int, walk_s: float) -> None:
    log_worker(floor, worker)
    del floor.free[worker.rank]
    walk(floor, worker, place, walk_s)
