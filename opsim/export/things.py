"""The objects of a run: jobs, workers, points of the flow, orders, tools and vehicles, as far as they occur."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import numpy as np

from opsim.export.object_ids import ORDER, TOOL, VEHICLE, WORKER, ObjectIds, job_type
from opsim.export.object_log import FLOAT, INTEGER, STRING, TIME, Related, Thing, Type, Value
from opsim.export.run_clock import FIRST, RunClock
from opsim.export.state_changes import Changes, station_changes, worker_changes
from opsim.log import CREATE, JOIN, TRANSPORT, EventLog
from opsim.log import TOOL as HOLDS_TOOL
from opsim.plan import Plan

Values = tuple[tuple[str, Value, str], ...]
OF_ORDER, MADE_FROM, JOINED_INTO, WORKS_AT = "of order", "made from", "joined into", "works at"
"""Qualifiers between objects."""
_STATE = ("state", STRING)
_OF_JOB = (("product", STRING), ("source", STRING), ("number", INTEGER), ("units", INTEGER), ("due", TIME))
_OF_POINT = (("place", STRING), ("servers", INTEGER), _STATE)
ATTRIBUTES: dict[str, tuple[tuple[str, str], ...]] = {
    WORKER: (
        *(("home", STRING), ("walk_m_per_s", FLOAT), ("height_m", FLOAT), ("mass_kg", FLOAT), ("age_years", FLOAT)),
        *(("sex", STRING), _STATE),
    ),
    ORDER: (("source", STRING), ("quantity", INTEGER), ("ordered", TIME), ("due", TIME)),
    TOOL: (("pieces", INTEGER),),
    VEHICLE: (("transporter", STRING), ("speed_m_per_s", FLOAT), ("capacity", INTEGER)),
}


def attributes_of(kind: str) -> tuple[tuple[str, str], ...]:
    """(name, type) of what objects of a type may have."""
    return ATTRIBUTES.get(kind, _OF_JOB if kind.startswith(job_type("")) else _OF_POINT)


@dataclass(frozen=True)
class Things:
    """The objects of one replication; two of one name in a scenario are two objects still."""

    log: EventLog
    plan: Plan
    ids: ObjectIds
    clock: RunClock

    def types(self) -> tuple[Type, ...]:
        """The types of those that occur."""
        return tuple(Type(kind, attributes_of(kind)) for kind in dict.fromkeys(one.type for one in self))

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
        return tuple((_STATE[0], word, time) for (_, word), time in zip(changes, times))

    def _seen(self, column: str) -> set[int]:
        return set(np.unique(self.log[column]).tolist()) - {-1}

    @cached_property
    def _created(self) -> EventLog:
        return self.log.of(CREATE)


def _fixed(**values: Value | None) -> Values:
    """Values that hold from the beginning on; those that are not known are left out."""
    return tuple((name, value, FIRST) for name, value in values.items() if value is not None)
