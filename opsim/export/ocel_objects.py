"""What the objects of a run are called: an id each, no two alike, whatever a scenario calls its people and places.

An object-centric event log as OCEL 2.0 has it, whatever file it goes to: types, then events and objects in turn.

What the kinds of rows are called as events, and which attributes each has.

What workers and stations are doing, as changes over time.

The objects of a run: jobs, workers, points of the flow, orders, tools and vehicles, as far as they occur.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import isfinite
from typing import NamedTuple

import numpy as np

from opsim import log as kinds
from opsim.export.tables import FIRST, RunClock
from opsim.log import CREATE, JOIN, KINDS, TRANSPORT, WORKER_KINDS, EventLog
from opsim.log import TOOL as HOLDS_TOOL
from opsim.plan import Plan
from opsim.subjects.stations.plan import STATION

WORKER, ORDER, TOOL, VEHICLE = "worker", "order", "tool", "vehicle"
"""Types of objects; beside them the kinds of ``StationPlan`` (station, store, conveyor), and ``job PRODUCT``."""


def job_type(product: str) -> str:
    """The type of the jobs of a product."""
    return f"job {product}"


@dataclass(frozen=True)
class ObjectIds:
    """Ids by rank and number. An id begins with the type, and ends with a number where several have one name."""

    plan: Plan

    @cached_property
    def workers(self) -> list[str]:
        return [f"{WORKER} {worker.name}" for worker in self.plan.workers]

    @cached_property
    def stations(self) -> list[str]:
        """Of all points of the flow: their names are of one kind of list, no two alike."""
        return [f"{point.kind} {point.name}" for point in self.plan.stations]

    @cached_property
    def tools(self) -> list[str]:
        return [f"{TOOL} {tool.name}" for tool in self.plan.tools]

    @cached_property
    def vehicles(self) -> list[str]:
        """Of each vehicle by its number: those of a transporter have its name, numbered from 1."""
        return [f"{VEHICLE} {pool.name} #{n + 1}" for pool in self.plan.transporters for n in range(pool.n)]

    def job(self, number: int) -> str:
        return f"job {number}"

    def order_of(self, job: int) -> tuple[int, int] | None:
        """(rank of its source, number of its order there) of a job; None where its source has no list of orders."""
        n, rank = divmod(job, len(self.plan.sources))
        firsts = self._firsts[rank]
        return (rank, bisect_right(firsts, n) - 1) if firsts else None

    def order(self, job: int) -> str | None:
        """The order that a job came from; orders of a source are numbered from 1, in its list's order."""
        found = self.order_of(job)
        return None if found is None else f"{ORDER} {self.plan.sources[found[0]].name} #{found[1] + 1}"

    @cached_property
    def _firsts(self) -> list[list[int]]:
        """Of each source, the number of the first job of each of its orders."""
        return [[order.first for order in source.orders] for source in self.plan.sources]


Value = str | int | float
Related = tuple[tuple[str, str], ...]
"""(id of an object, qualifier) of each."""
STRING, TIME, INTEGER, FLOAT = "string", "time", "integer", "float"
"""Types of attributes; the standard has ``boolean`` too."""


@dataclass(frozen=True)
class Type:
    """Of events or objects; attributes : (name, one of the types above) of all that one of them may have."""

    name: str
    attributes: tuple[tuple[str, str], ...] = ()


class Event(NamedTuple):
    """time : ISO 8601; values : (attribute, value) of those that it has."""

    id: str
    type: str
    time: str
    values: tuple[tuple[str, Value], ...]
    objects: Related


class Thing(NamedTuple):
    """An object. values : (attribute, value, since when) of each it ever had, in order of time; objects : related."""

    id: str
    type: str
    values: tuple[tuple[str, Value, str], ...]
    objects: Related


@dataclass(frozen=True)
class ObjectLog:
    """n_things : objects; events, things : each call begins anew; events come in order of time."""

    event_types: tuple[Type, ...]
    object_types: tuple[Type, ...]
    n_things: int
    events: Callable[[], Iterator[Event]]
    things: Callable[[], Iterator[Thing]]


WORDS = {
    kinds.OFF: "off duty",
    kinds.SETUP: "set up",
    kinds.TOOL: "hold tool",
    kinds.SENT_ON: "send on",
    kinds.STANDS: "line stands",
}
"""Kinds whose event is not called as they are."""
CLOSED, DRIVE = "closed", "drive"
"""A station that is off; a vehicle that goes, is loaded or unloaded."""

_LASTS = (("end", TIME), ("duration_s", FLOAT))
FOR = ("for", STRING)
"""The id of the job that somebody walks to, or waits at."""
_WHY = (*_LASTS, ("reason", STRING))
_WAY = (("from", STRING), ("to", STRING))
_DONE = (
    *_LASTS,
    *(("operation", STRING), ("task", STRING), ("performance", INTEGER), ("k", INTEGER)),
    *(("progress_from", FLOAT), ("progress_to", FLOAT), ("pace_shift", FLOAT)),
)
_STOP = (*_WHY, ("task", STRING), ("occurrence", INTEGER))
_PLAIN = (("operation", STRING), ("reason", STRING))
ATTRIBUTES: dict[int, tuple[tuple[str, str], ...]] = {
    **dict.fromkeys((kinds.WORK, kinds.SETUP), _DONE),
    kinds.WALK: (*_LASTS, *_WAY, FOR),
    kinds.TRANSPORT: (*_WHY, *_WAY),
    kinds.WAIT: (*_WHY, ("place", STRING), FOR),
    **dict.fromkeys((kinds.BREAK, kinds.OFF, kinds.ABSENT), (*_WHY, ("place", STRING))),
    **dict.fromkeys((kinds.QUEUE, kinds.HELD, kinds.BLOCKED), (*_WHY, ("operation", STRING), ("task", STRING))),
    **dict.fromkeys((kinds.DOWN, kinds.REPAIR), _STOP),
    kinds.STANDS: _WHY,
    kinds.TOOL: (*_LASTS, ("operation", STRING), ("task", STRING)),
}
"""By kind, what an event of it may have; those of an instant have ``_PLAIN``."""


def attributes_of(kind: int) -> tuple[tuple[str, str], ...]:
    """(name, type) of what an event of a kind may have."""
    return ATTRIBUTES.get(kind, _PLAIN)


def type_names(log: EventLog, by_task: bool = False) -> list[str]:
    """(rows,) what each row's event is called. by_task : work and set-up are told apart by their task."""
    words = [WORDS.get(kind, name) for kind, name in enumerate(KINDS)]
    alone = (log["worker"] < 0) & (log["job"] < 0)
    names = [words[kind] for kind in log["kind"].tolist()]
    for kind, word in ((kinds.OFF, CLOSED), (kinds.TRANSPORT, DRIVE)):
        for row in np.flatnonzero(alone & (log["kind"] == kind)).tolist():
            names[row] = word
    if by_task:
        tasks = log.names["task"]
        for row in np.flatnonzero(np.isin(log["kind"], (kinds.WORK, kinds.SETUP)) & (log["task"] >= 0)).tolist():
            names[row] = f"{names[row]}: {tasks[log['task'][row]]}"
    return names


Changes = list[tuple[float, str]]
"""(from when on, state) in order of time; the first from 0 s."""

_WORKER_WORDS = {kinds.OFF: "off duty", kinds.SETUP: "set up"}
_ORDER = ("work", "set up", "closed", "repair", "down", "blocked", "waiting")
"""States of a station, the one that counts first: finished work is work after closing time too."""
_STATE = {
    kinds.WORK: "work",
    kinds.SETUP: "set up",
    kinds.OFF: "closed",
    kinds.REPAIR: "repair",
    kinds.DOWN: "down",
    kinds.BLOCKED: "blocked",
    kinds.HELD: "waiting",
}
STARVED = "starved"


def worker_changes(log: EventLog, plan: Plan) -> Iterator[Changes]:
    """Of each worker, from his rows: work, set up, repair, walk, wait, break, off duty, absent."""
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    rows = rows[np.lexsort([log["end_s"][rows], log["start_s"][rows], log["worker"][rows]])]
    firsts = np.searchsorted(log["worker"][rows], np.arange(len(plan.workers) + 1))
    words = [_WORKER_WORDS.get(kind, name) for kind, name in enumerate(KINDS)]
    for first, last in pairwise(firsts.tolist()):
        own = rows[first:last]
        kind = log["kind"][own]
        begins = np.flatnonzero(np.diff(kind, prepend=-1))
        yield [(at_s, words[doing]) for at_s, doing in zip(log["start_s"][own][begins].tolist(), kind[begins].tolist())]


def station_changes(log: EventLog, plan: Plan) -> Iterator[Changes]:
    """Of each point of the flow: what the best of its servers does, work before blocked before waiting before starved.

    waiting : a job on a server waits, for a worker, parts, tools; nothing is said of stores and conveyors
    """
    of_job = (log["job"] >= 0) & np.isin(log["kind"], (kinds.WORK, kinds.SETUP, kinds.BLOCKED, kinds.HELD))
    of_station = (log["job"] < 0) & (log["worker"] < 0) & np.isin(log["kind"], kinds.STATION_KINDS)
    rows = np.flatnonzero((log["station"] >= 0) & (of_job | of_station))
    rows = rows[np.argsort(log["station"][rows], kind="stable")]
    firsts = np.searchsorted(log["station"][rows], np.arange(len(plan.stations) + 1))
    for point, (first, last) in zip(plan.stations, pairwise(firsts.tolist())):
        yield _swept(log, rows[first:last]) if point.kind == STATION else []


def _swept(log: EventLog, rows: np.ndarray) -> Changes:
    """The first state of ``_ORDER`` that holds, instant by instant."""
    times_s = np.unique(np.concatenate([[0.0], log["start_s"][rows], log["end_s"][rows]]))
    times_s = times_s[times_s < log.horizon_s]
    holds = np.zeros((len(_ORDER), times_s.size + 1), dtype=np.int64)
    for kind, word in _STATE.items():
        here = rows[log["kind"][rows] == kind]
        state = _ORDER.index(word)
        np.add.at(holds[state], np.searchsorted(times_s, log["start_s"][here]), 1)
        np.add.at(holds[state], np.searchsorted(times_s, log["end_s"][here]), -1)
    on = np.vstack([np.cumsum(holds, axis=1)[:, :-1] > 0, np.ones((1, times_s.size), dtype=bool)])
    state = np.argmax(on, axis=0)
    begins = np.flatnonzero(np.diff(state, prepend=-1))
    words = (*_ORDER, STARVED)
    return [(at_s, words[which]) for at_s, which in zip(times_s[begins].tolist(), state[begins].tolist())]


Values = tuple[tuple[str, Value, str], ...]
OF_ORDER, MADE_FROM, JOINED_INTO, WORKS_AT = "of order", "made from", "joined into", "works at"
"""Qualifiers between objects."""
_STATE_COLUMN = ("state", STRING)
_OF_JOB = (("product", STRING), ("source", STRING), ("number", INTEGER), ("units", INTEGER), ("due", TIME))
_OF_POINT = (("place", STRING), ("servers", INTEGER), _STATE_COLUMN)
THING_ATTRIBUTES: dict[str, tuple[tuple[str, str], ...]] = {
    WORKER: (
        *(("home", STRING), ("walk_m_per_s", FLOAT), ("height_m", FLOAT), ("mass_kg", FLOAT), ("age_years", FLOAT)),
        *(("sex", STRING), _STATE_COLUMN),
    ),
    ORDER: (("source", STRING), ("quantity", INTEGER), ("ordered", TIME), ("due", TIME)),
    TOOL: (("pieces", INTEGER),),
    VEHICLE: (("transporter", STRING), ("speed_m_per_s", FLOAT), ("capacity", INTEGER)),
}


def state_attributes_of(kind: str) -> tuple[tuple[str, str], ...]:
    """(name, type) of what objects of a type may have."""
    return THING_ATTRIBUTES.get(kind, _OF_JOB if kind.startswith(job_type("")) else _OF_POINT)


@dataclass(frozen=True)
class Things:
    """The objects of one replication; two of one name in a scenario are two objects still."""

    log: EventLog
    plan: Plan
    ids: ObjectIds
    clock: RunClock

    def types(self) -> tuple[Type, ...]:
        """The types of those that occur."""
        return tuple(Type(kind, state_attributes_of(kind)) for kind in dict.fromkeys(one.type for one in self))

    def __iter__(self) -> Iterator[Thing]:
        """Each that some row tells of: workers, points of the flow, tools, vehicles, orders, jobs."""
        yield from self._workers()
        yield from self._points()
        yield from self._tools()
        yield from self._vehicles()
        yield from self._orders()
        yield from self._jobs()

    def _workers(self) -> Iterator[Thing]:
        seen, stations = self._seen("worker"), self._seen("station")
        for rank, (worker, changes) in enumerate(zip(self.plan.workers, worker_changes(self.log, self.plan))):
            if rank not in seen:
                continue
            body = {name: getattr(worker.body, name) for name in ("height_m", "mass_kg", "age_years", "sex")}
            home = self.plan.places[worker.place]
            fixed = _fixed(home=home, walk_m_per_s=worker.walk_m_per_s, **body)
            places = (at for at, rating in enumerate(worker.rating) if rating > 0 and at in stations)
            near = tuple((self.ids.stations[at], WORKS_AT) for at in places)
            yield Thing(self.ids.workers[rank], WORKER, (*fixed, *self._changing(changes)), near)

    def _points(self) -> Iterator[Thing]:
        seen = self._seen("station")
        for rank, (point, changes) in enumerate(zip(self.plan.stations, station_changes(self.log, self.plan))):
            if rank in seen:
                fixed = _fixed(place=self.plan.places[point.place], servers=point.servers)
                yield Thing(self.ids.stations[rank], point.kind, (*fixed, *self._changing(changes)), ())

    def _tools(self) -> Iterator[Thing]:
        for rank in np.unique(self.log["k"][self.log["kind"] == HOLDS_TOOL]).tolist():
            yield Thing(self.ids.tools[rank], TOOL, _fixed(pieces=self.plan.tools[rank].n), ())

    def _vehicles(self) -> Iterator[Thing]:
        log = self.log
        drives = (log["kind"] == TRANSPORT) & (log["job"] < 0) & (log["worker"] < 0) & (log["k"] >= 0)
        pools = [pool for pool in self.plan.transporters for _ in range(pool.n)]
        for number in np.unique(log["k"][drives]).tolist():
            pool = pools[number]
            fixed = _fixed(transporter=pool.name, speed_m_per_s=pool.speed_m_per_s, capacity=pool.capacity)
            yield Thing(self.ids.vehicles[number], VEHICLE, fixed, ())

    def _orders(self) -> Iterator[Thing]:
        found = {self.ids.order_of(job): self.ids.order(job) for job in self._created["job"].tolist()}
        for key, name in found.items():
            if key is not None and name is not None:
                source = self.plan.sources[key[0]]
                order = source.orders[key[1]]
                times = _fixed(ordered=self._time(order.time_s), due=self._time(order.due_s))
                yield Thing(name, ORDER, (*_fixed(source=source.name, quantity=order.quantity), *times), ())

    def _jobs(self) -> Iterator[Thing]:
        log, joins = self._created, self.log.of(JOIN)
        into = dict(zip(joins["job"].tolist(), joins["k"].tolist()))
        dues = self._dues(log)
        columns = (log[name].tolist() for name in ("job", "product", "source", "k"))
        for job, product, source, parent, due in zip(*columns, dues):
            made = self.plan.products[product]
            fixed = _fixed(
                product=made.name,
                source=self.plan.sources[source].name,
                number=job // len(self.plan.sources),
                units=made.lot,
                due=due,
            )
            yield Thing(self.ids.job(job), job_type(made.name), fixed, self._near(job, parent, into.get(job, -1)))

    def _near(self, job: int, parent: int, into: int) -> Related:
        order = self.ids.order(job)
        found = [] if order is None else [(order, OF_ORDER)]
        found += [(self.ids.job(parent), MADE_FROM)] if parent >= 0 else []
        return (*found, (self.ids.job(into), JOINED_INTO)) if into >= 0 else tuple(found)

    def _dues(self, created: EventLog) -> list[str | None]:
        """When each job is due: as its order says, else so long after its arrival as its product says."""
        by_product = np.array([made.due_s for made in self.plan.products])
        due_s = created["end_s"] + by_product[created["product"]]
        if any(source.orders for source in self.plan.sources):
            for at, job in enumerate(created["job"].tolist()):
                key = self.ids.order_of(job)
                ordered_s = self.plan.sources[key[0]].orders[key[1]].due_s if key is not None else np.inf
                due_s[at] = ordered_s if isfinite(ordered_s) else due_s[at]
        known = np.isfinite(due_s)
        written = iter(self.clock.texts(due_s[known]))
        return [next(written) if one else None for one in known.tolist()]

    def _time(self, time_s: float) -> str | None:
        return self.clock.texts(np.array([time_s]))[0] if isfinite(time_s) else None

    def _changing(self, changes: Changes) -> Values:
        """A state over time; the first holds from the beginning on."""
        times = [FIRST, *self.clock.texts(np.array([at_s for at_s, _ in changes[1:]]))]
        return tuple((_STATE_COLUMN[0], word, time) for (_, word), time in zip(changes, times))

    def _seen(self, column: str) -> set[int]:
        return set(np.unique(self.log[column]).tolist()) - {-1}

    @cached_property
    def _created(self) -> EventLog:
        return self.log.of(CREATE)


def _fixed(**values: Value | None) -> Values:
    """Values that hold from the beginning on; those that are not known are left out."""
    return tuple((name, value, FIRST) for name, value in values.items() if value is not None)
