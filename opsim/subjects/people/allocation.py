"""Free workers are sent to stations that call; who is not sent stays, goes home, or walks on his round.

Whose work it is comes before the rule of allocation: zones, floaters, priorities, the way ahead, and what each worker's
body has gone through so far.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.event_list import lowest_bit
from opsim.engine.floor.floor_state import CREWS, Floor
from opsim.engine.floor.keys import is_better, keep_best, pair_key, pair_numbers, put
from opsim.engine.floor.log_rows import log_worker
from opsim.engine.floor.machine import here, inlined, step
from opsim.engine.floor.state import Job, Station, Worker
from opsim.engine.rules import LEAST_EXPOSED
from opsim.subjects.human.human_effects import hang
from opsim.subjects.human.human_models import bodies_of
from opsim.subjects.human.human_state import dose_so_far
from opsim.subjects.people.worker import be_busy, clear_bit, may_serve, on_round, walk, walk_time_s
from opsim.subjects.routes.routing import take_claim
from opsim.subjects.sequencing.plan import MOST_DOWNSTREAM
from opsim.subjects.stations.station import call_off, go_and_perform

ORDER = 1
"""Among the ways to begin a task: somebody on patrol has come for one before anything else is looked at."""
_whose_it_is, _more_urgent = inlined(rules.whose_it_is), inlined(rules.more_urgent)
_nearer_to_its_end = inlined(rules.nearer_to_its_end)


def install_preferences(build: Any) -> None:
    """What comes before the rule of allocation, where there is some; one operation a stop, where the plan says so."""
    for part in _parts(build.plan):
        build.hang(build.floor.prefixes, part)
    if build.plan.idle == "patrol" and build.plan.serve == "one":
        for station in build.stations:
            build.hang(station.acts, serves, None, ORDER)


def _parts(plan: Any) -> Any:
    if any(worker.zone or worker.floater for worker in plan.workers):
        yield by_zone
    by = {"stations": by_station, "products": by_product}
    wanted = {"stations": any(station.priority for station in plan.stations), "products": True}
    yield from (by[name] for name in plan.priorities if wanted[name])
    if plan.rule == MOST_DOWNSTREAM:
        yield by_way_ahead
    if plan.rule == LEAST_EXPOSED:
        yield by_dose


@step
def by_zone(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """People whose own station it is come first, then floaters."""
    outside = 1 if worker.has_zone and not worker.zone[station.rank] else 0
    key = _whose_it_is(outside, worker.floater)
    put(floor, float(key[0]))
    put(floor, float(key[1]))
    return True


@step
def by_station(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The station of the higher priority."""
    put(floor, _more_urgent(station.priority)[0])
    return True


@step
def by_product(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The job of the higher priority."""
    put(floor, _more_urgent(job.priority)[0])
    return True


@step
def by_way_ahead(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The job with the fewest operations left, on average."""
    put(floor, _nearer_to_its_end(job.plan.left_steps[job.step])[0])
    return True


@step
def serves(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """He has come to work at this stop of his round: he does one operation, and walks on."""
    worker.served = 1
    return False


STAY, HOME, PATROL = range(3)


@step
def send_workers(floor: Floor) -> None:
    """Serve the best pair of free worker and calling station, again and again; then the idle do as the plan says."""
    while True:
        while floor.free and floor.n_calling and not floor.none_fits and _serve_one(floor):
            pass
        if floor.idle == STAY or not floor.free:
            return
        if floor.idle == HOME:
            _go_home(floor)
            return
        if not _walk_on(floor):
            return


@inlined
def _numbers(floor: Floor, worker: Worker, station: Station) -> tuple[float, float, float, float, float, float]:
    n_waiting = len(station.calling) + len(station.queue)
    return pair_numbers(floor, worker, station, n_waiting, station.calling[0].since_s)


@inlined
def _key(floor: Floor, worker: Worker, station: Station) -> None:
    first = station.calling[0]
    pair_key(floor, worker, station, first.job, len(station.calling) + len(station.queue), first.since_s)


@inlined
def _is_best(
    floor: Floor, worker: Worker, station: Station, best: Worker, best_station: Station, is_second: bool
) -> bool:
    """Whether a pair comes before the best so far, where blocks put something before the rule's numbers."""
    if is_second:
        _key(floor, best, best_station)
        keep_best(floor)
    _key(floor, worker, station)
    if not is_better(floor):
        return False
    keep_best(floor)
    return True


@inlined
def _next_able(floor: Floor, at: int) -> int:
    """The number, from one on, of the next of those free who can serve at a station that calls."""
    free, calls = floor.free, floor.calls
    while at < len(free):
        skills = free[at].skills
        for word in range(floor.n_words):
            if skills[word] & calls[word]:
                return at
        at += 1
    return at


@step
def _serve_best(floor: Floor) -> bool:
    """The worker of the best pair is sent, where there is one; True where there may be another pair."""
    best, best_station = floor.no_worker, floor.outside
    patrols, n_pairs = floor.idle == PATROL, 0
    smallest = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    at = _next_able(floor, 0)
    while at < len(floor.free):
        worker = floor.free[at]
        for word in range(floor.n_words):
            able = worker.skills[word] & floor.calls[word]
            while able:
                station = floor.stations[(word << 6) + lowest_bit(able)]
                able &= able - 1
                if patrols and not on_round(worker, station):
                    continue
                n_pairs += 1
                if n_pairs == 1:
                    best, best_station = worker, station  # most often the only pair, and its key is never asked for
                    continue
                if floor.prefixes:
                    if _is_best(floor, worker, station, best, best_station, n_pairs == 2):
                        best, best_station = worker, station
                    continue
                if n_pairs == 2:
                    smallest = _numbers(floor, best, best_station)
                numbers = _numbers(floor, worker, station)
                if numbers < smallest:
                    best, best_station, smallest = worker, station, numbers
        at = _next_able(floor, at + 1)
    if not best:
        floor.none_fits = not patrols  # these fit by where they stand, too
        return False
    if best_station.calling[0].job.with_tools:
        floor.found_worker, floor.found_station = best, best_station
        floor.tools_line(floor, best_station, best_station.calling[0].job)
        best, best_station = floor.found_worker, floor.found_station
    n_free, calls = len(floor.free), floor.calls[0]
    _send(floor, best, best_station, best_station.calling[0].job)
    # it was the only pair, and nobody has come free or has called since: there is none, and no need to look
    return n_pairs > 1 or len(floor.free) >= n_free or floor.n_words > 1 or floor.calls[0] & ~calls != 0


@step
def send(floor: Floor, worker: Worker, station: Station, job: Job) -> None:
    """A free worker goes to a job on a server of a station, which calls there for anybody, or waits for him."""
    log_worker(floor, worker)
    be_busy(floor, worker)
    calls = station.calling
    if calls and calls[0].job is job:
        take_claim(floor, calls, 0)
        if not calls:
            clear_bit(floor.calls, station.rank)
            floor.n_calling -= 1
    else:
        call_off(floor, station, job)
    if job.with_tools:
        station.sent.line(floor, station, job)
    worker.job, worker.station = job, station
    go_and_perform(floor, worker, job)


@step
def _go_home(floor: Floor) -> None:
    at = 0
    while at < len(floor.free):
        worker = floor.free[at]
        at += 1
        if worker.place != worker.home and not worker.limited[CREWS]:
            metres = floor.distance_m[worker.place * floor.n_places + worker.home]
            if metres > 0:
                log_worker(floor, worker)
                at -= 1
                worker.in_free = 0
                del floor.free[at]
                walk(floor, worker, worker.home, metres / worker.walk_m_per_s)
            else:
                worker.place = worker.home


@step
def _walk_on(floor: Floor) -> bool:
    """Patrolling workers go to the next station of their round; True where one came to a call without walking."""
    came = False
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if not worker.in_free:
            continue
        for _ in range(worker.n_patrol):
            worker.round = (worker.round + 1) % worker.n_patrol
            worker.served = 0
            station = floor.stations[worker.patrol[worker.round]]
            walk_s = walk_time_s(floor, worker, station)
            if walk_s > 0:
                log_worker(floor, worker)
                be_busy(floor, worker)
                walk(floor, worker, station.place, walk_s)
                break
            worker.place = station.place
            if station.calling and may_serve(worker, station):
                came = True
                break
    return came


_serve_one, _send = here(_serve_best), here(send)
_less_gone_through = inlined(rules.less_gone_through)


def install_doses(build: Any) -> None:
    """Doses are counted where a rule of the plan asks for them; ``humans`` tells them who works."""
    if not build.plan.evens_out:
        return
    bodies = bodies_of(build)
    ask_rate, ask_order = bodies.asks(bodies.answer_rate), bodies.asks(bodies.answer_order)
    for worker in build.workers:
        dose = worker.dose = build.arena.new("Dose")
        dose.rates = bodies.rates_of(worker.rank)
        dose.ask_rate, dose.ask_order = ask_rate, ask_order
    if not build.floor.has_humans:
        hang(build)


@step
def by_dose(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """Who has gone through less so far."""
    put(floor, _less_gone_through(dose_so_far(floor, worker))[0])
    return True
