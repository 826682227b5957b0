"""Twins of floors where jobs wait: for a server, for room, for a card, for a second try."""

from itertools import repeat

import simpy
from simpy_twins.floor import EndOfInstant, Floor, Job, Worker, exponential, uniform

QUEUE = """
opsim: 1
name: M/M/3
run: {horizon: 2000 s, seed: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {serve: {dist: exponential, mean: 10 s}}
stations: {counter: {at: hall, tasks: [serve], servers: 3}}
products: {customer: {route: [counter]}}
release: {kind: poisson, every: 4 s}
workers: {w1: {skills: {counter: 1.0}}, w2: {skills: {counter: 1.0}}, w3: {skills: {counter: 1.0}}}
allocation: {rule: oldest_job}
"""


def queue(floor: Floor) -> None:
    """Three servers with a worker each; of those who are free the first one serves."""
    servers, free = simpy.Resource(floor.env, 3), simpy.PriorityStore(floor.env)
    times = {}
    for name in ("w1", "w2", "w3"):
        free.put(Worker(floor, name, "hall"))
        times[name] = floor.times(exponential(10.0), "duration", "serve", name)

    def customer(n):
        job = Job(floor, n, "customer")
        job.now("queue", station="counter")
        with servers.request() as server:
            yield server
            yield EndOfInstant(floor.env, n)  # all who come free at this instant are free
            worker = yield free.get()
            k, lasts_s = next(times[worker.name])
            yield worker.performs(job, lasts_s, k, station="counter", task="serve")
            worker.waits()
            free.put(worker)
        job.leaves()

    floor.poisson(4.0, customer)


LINE = """
opsim: 1
name: blocking line
run: {horizon: 1500 s, seed: 1}
layout: {places: {p1: [0 m, 0 m], p2: [1 m, 0 m], p3: [2 m, 0 m]}}
tasks: {t1: {dist: exponential, mean: 5 s}, t2: {dist: exponential, mean: 5 s}, t3: {dist: exponential, mean: 5 s}}
stations:
  s1: {at: p1, tasks: [t1], buffer: 1}
  s2: {at: p2, tasks: [t2], buffer: 0}
  s3: {at: p3, tasks: [t3], buffer: 1}
products: {part: {route: [s1, s2, s3]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""


class Station:
    """A server, some places in front of it, and a worker of its own."""

    def __init__(self, floor: Floor, number: int, n_places: float, mean_s: float):
        self.name, self.task = f"s{number}", f"t{number}"
        self.places, self.server = simpy.Resource(floor.env, n_places), simpy.Resource(floor.env, 1)
        self.worker = Worker(floor, f"w{number}", f"p{number}")
        self.times = floor.times(exponential(mean_s), "duration", self.task, self.worker.name)

    def serves(self, job: Job):
        """The job is on the server: the worker does his task."""
        k, lasts_s = next(self.times)
        yield self.worker.performs(job, lasts_s, k, station=self.name, task=self.task)
        self.worker.waits()


def line(floor: Floor) -> None:
    """Three stations; a job that is done keeps its server until the next station has a place for it."""
    stations = [Station(floor, number, 1 + buffer, 5.0) for number, buffer in ((1, 1), (2, 0), (3, 1))]

    def source():
        n = 0
        while True:
            place = stations[0].places.request()
            yield place
            floor.env.process(part(n, place))
            n += 1

    def part(n, place):
        job = Job(floor, n, "part")
        for station, following in zip(stations, [*stations[1:], None]):
            job.now("queue", station=station.name)
            with station.server.request() as server:
                yield server
                yield from station.serves(job)
                next_place = None
                if following is not None:
                    job.now("blocked", station=station.name)
                    next_place = following.places.request()
                    yield next_place
            station.places.release(place)
            place = next_place
        job.leaves()

    floor.env.process(source())


KANBAN = """
opsim: 1
name: kanban
run: {horizon: 1500 s, seed: 1}
layout: {places: {p1: [0 m, 0 m], p2: [1 m, 0 m], p3: [2 m, 0 m]}}
tasks: {t1: {dist: exponential, mean: 5 s}, t2: {dist: exponential, mean: 5 s}, t3: {dist: exponential, mean: 5 s}}
stations: {s1: {at: p1, tasks: [t1]}, s2: {at: p2, tasks: [t2]}, s3: {at: p3, tasks: [t3]}}
cards: {one: {n: 2, from: s1, to: s1}, two: {n: 2, from: s2, to: s3}}
products: {part: {route: [s1, s2, s3]}}
release: {kind: poisson, every: 6 s}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""


def kanban(floor: Floor) -> None:
    """Two cards for s1, two for s2 and s3 together: who finds none waits outside, or on the server of s1."""
    s1, s2, s3 = (Station(floor, number, float("inf"), 5.0) for number in (1, 2, 3))
    one, two = (simpy.Container(floor.env, init=2) for _ in range(2))

    def at(station, job):
        job.now("queue", station=station.name)
        with station.server.request() as server:
            yield server
            yield from station.serves(job)
            if station is s1:
                job.now("blocked", station="s1", cause="card")
                yield two.get(1)
        if station is not s2:
            yield (one if station is s1 else two).put(1)

    def part(n):
        job = Job(floor, n, "part")
        job.now("held", cause="card")
        yield one.get(1)
        for station in (s1, s2, s3):
            yield from at(station, job)
        job.leaves()

    floor.poisson(6.0, part)


REWORK = """
opsim: 1
name: rework
run: {horizon: 2 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [6 m, 0 m]}}
tasks: {make: {dist: uniform, low: 20 s, high: 40 s}, look: {fixed: 10 s}, mend: {dist: uniform, low: 10 s, high: 30 s}}
stations:
  press: {at: a, tasks: [make], yield: 0.8}
  check: {at: b, tasks: [look], inspect: {finds: 0.9, false_alarms: 0.05, then: {rework: solder}, most: 2}}
  solder: {at: c, tasks: [mend], yield: 0.7}
products: {part: {route: [press, check]}}
release: {kind: poisson, every: 40 s}
workers: {w1: {skills: {press: 1.0}}, w2: {skills: {check: 1.0}}, w3: {skills: {solder: 1.0}}}
"""


def rework(floor: Floor) -> None:
    """What is found to be bad is mended twice at most, and looked at again; the third time it is scrap."""
    servers = {name: simpy.Resource(floor.env, 1) for name in ("press", "check", "solder")}
    workers = {
        name: Worker(floor, who, place) for name, who, place in zip(servers, ("w1", "w2", "w3"), ("a", "b", "c"))
    }
    tasks = dict(zip(servers, ("make", "look", "mend")))
    times = {
        "press": floor.times(uniform(20.0, 40.0), "duration", "make", "w1"),
        "check": enumerate(repeat(10.0)),
        "solder": floor.times(uniform(10.0, 30.0), "duration", "mend", "w3"),
    }

    def at(station, job):
        job.now("queue", station=station)
        yield EndOfInstant(floor.env, job.number)  # of two that come at one instant, the first one made
        with servers[station].request() as server:
            yield server
            k, lasts_s = next(times[station])
            yield workers[station].performs(job, lasts_s, k, station=station, task=tasks[station])
            workers[station].waits()

    def is_bad(station, n, visit, good):
        return floor.chance(n, "yield", station, "release", visit) >= good

    def part(n):
        job = Job(floor, n, "part")
        yield from at("press", job)
        bad = is_bad("press", n, 0, 0.8)
        for look in range(3):
            yield from at("check", job)
            if floor.chance(n, "quality", "check", "release", look) >= (0.9 if bad else 0.05):
                job.leaves("finish", cause="bad" if bad else "")
                return
            cause = "bad" if bad else "false_alarm"
            if look == 2:
                job.leaves("scrap", station="check", cause=cause)
                return
            job.at_once("rework", station="check", cause=cause)
            yield from at("solder", job)
            bad = is_bad("solder", n, look, 0.7)

    floor.poisson(40.0, part)
