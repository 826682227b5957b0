"""Twins of floors where machines decide: breakdowns, a conveyor, a vehicle, a server that is taken away."""

import simpy
from simpy_twins.floor import EndOfInstant, Floor, Job, Subject, Worker, exponential, uniform

BREAKDOWNS = """
opsim: 1
name: breakdowns
run: {horizon: 4 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t1: {dist: uniform, low: 20 s, high: 60 s}, t2: {dist: uniform, low: 20 s, high: 60 s}}
stations:
  m1: {at: a, tasks: [t1], breakdowns: {jam: {JAM}}}
  m2: {at: b, tasks: [t2], breakdowns: {jam: {JAM}}}
products: {part: {route: [m1, m2]}}
release: {kind: poisson, every: 80 s}
repair_teams: {crew: {n: 1}}
workers: {w1: {skills: {m1: 1.0}}, w2: {skills: {m2: 1.0}}}
""".replace(
    "JAM",
    "by: clock, every: {dist: exponential, mean: 200 s}, job: resume, team: crew, "
    "repair: {dist: exponential, mean: 60 s}",
)


class Machine(Subject):
    """A machine with a worker of its own. up : happens when it is repaired; at_work : the process to interrupt"""

    def __init__(self, floor: Floor, number: int, place: str, crew: simpy.Resource):
        super().__init__(floor, station=f"m{number}", task=f"m{number}: jam")
        self.number, self.name, self.task = number, f"m{number}", f"t{number}"
        self.server, self.worker = simpy.Resource(floor.env, 1), Worker(floor, f"w{number}", place)
        self.times = floor.times(uniform(20.0, 60.0), "duration", self.task, self.worker.name)
        self.up, self.at_work = floor.env.event().succeed(), None
        self.uptimes = floor.times(exponential(200.0), "uptime", self.name, "jam")
        self.repairs = floor.times(exponential(60.0), "repair", self.name, "jam")
        floor.env.process(self.breaks_down(crew))

    def breaks_down(self, crew: simpy.Resource):
        """It runs until it breaks down, waits for the crew, is repaired."""
        for (k, uptime_s), (_, repair_s) in zip(self.uptimes, self.repairs):
            yield self.env.timeout(uptime_s)
            self.up = self.env.event()
            if self.at_work is not None:
                self.at_work.interrupt()
            self.now("down", k=k, cause="breakdown")
            yield EndOfInstant(self.env, self.number)  # of two that break down at once, the first is seen to first
            with crew.request() as someone:
                yield someone
                self.now("repair", k=k, cause="breakdown")
                yield self.env.timeout(repair_s)
            self.close(self.env.now)
            self.up.succeed()

    def serves(self, job: Job):
        """The worker does the job's task, in as many pieces as breakdowns leave of it."""
        k, rest_s, done = None, 0.0, 0.0
        while done < 1.0:
            job.now("held", station=self.name, cause="down")
            yield self.up
            if k is None:
                k, rest_s = next(self.times)
            try:
                self.at_work = self.env.active_process
                yield self.worker.performs(job, rest_s, k, done, station=self.name, task=self.task)
                done = 1.0
            except simpy.Interrupt:
                done, rest_s = job.progress(self.env.now), rest_s - (self.env.now - job.since_s)
            self.at_work = None
            self.worker.waits()


def breakdowns(floor: Floor) -> None:
    """Two machines and one crew; what was begun waits for the repair, and the same worker goes on with it."""
    crew = simpy.Resource(floor.env, 1)
    machines = [Machine(floor, 1, "a", crew), Machine(floor, 2, "b", crew)]

    def part(n):
        job = Job(floor, n, "part")
        for machine in machines:
            job.now("queue", station=machine.name)
            with machine.server.request() as server:
                yield server
                yield from machine.serves(job)
        job.leaves()

    floor.poisson(80.0, part)


CONVEYOR = """
opsim: 1
name: conveyor
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [4 m, 0 m]}}
tasks:
  feed: {dist: exponential, mean: 4 s, automatic: true}
  pack: {dist: exponential, mean: 5 s, automatic: true}
stations: {feeder: {at: a, tasks: [feed]}, packer: {at: b, tasks: [pack], buffer: 0}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
products: {part: {route: [feeder, belt, packer]}}
release: {kind: poisson, every: 6 s}
"""
RIDE_S, PITCH_S = 8.0, 2.0


def conveyor(floor: Floor) -> None:
    """Jobs ride until they stand behind another one, get on a pitch apart, and move up a pitch after who gets off."""
    env = floor.env
    feeder, packer = simpy.Resource(env, 1), simpy.Resource(env, 1)
    entrance, belt = simpy.Resource(env, 1), simpy.Resource(env, int(RIDE_S / PITCH_S))
    times = {
        (task, station): floor.times(exponential(mean_s), "automatic", task, station)
        for task, station, mean_s in (("feed", "feeder", 4.0), ("pack", "packer", 5.0))
    }
    last_off = env.timeout(0, -PITCH_S)

    def runs(job, task, station):
        k, lasts_s = next(times[task, station])
        return job.works(lasts_s, k, station=station, task=task)

    def moves_on(at_entrance):
        yield env.timeout(PITCH_S)
        entrance.release(at_entrance)

    def part(n):
        nonlocal last_off
        job = Job(floor, n, "part")
        job.now("queue", station="feeder")
        with feeder.request() as server:
            yield server
            yield runs(job, "feed", "feeder")
            job.now("blocked", station="feeder")
            at_entrance = entrance.request()
            yield at_entrance
            on_belt = belt.request()
            yield on_belt
        env.process(moves_on(at_entrance))
        before, off = last_off, env.event()
        last_off = off
        job.now("transport", station="belt")
        yield env.timeout(RIDE_S)
        job.now("queue", station="belt")
        before_off_s = yield before
        if env.now < before_off_s + PITCH_S:
            yield env.timeout(before_off_s + PITCH_S - env.now)
        job.now("blocked", station="belt")
        with packer.request() as server:
            yield server
            belt.release(on_belt)
            off.succeed(env.now)
            yield runs(job, "pack", "packer")
        job.leaves()

    floor.poisson(6.0, part)


TRANSPORTER = """
opsim: 1
name: transporter
run: {horizon: 2 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], dock: [0 m, 10 m]}}
tasks:
  cut: {dist: exponential, mean: 40 s, automatic: true}
  pack: {dist: exponential, mean: 15 s, automatic: true}
stations: {saw: {at: a, tasks: [cut], servers: 3}, packer: {at: b, tasks: [pack]}}
transporters: {truck: {at: dock, speed: 2 m/s, load: 3 s, unload: 2 s, capacity: 2, idle: home, legs: [[saw, packer]]}}
products: {part: {route: [saw, packer]}}
release: {kind: poisson, every: 20 s}
"""


def transporter(floor: Floor) -> None:
    """A truck takes what waits for it at the saw, two at most, and goes back to the dock where nobody calls."""
    env, calls = floor.env, simpy.Store(floor.env)
    saw, packer = simpy.Resource(env, 3), simpy.Resource(env, 1)
    drive_s = {"dock": {"a": 5.0}, "a": {"b": 10.0}, "b": {"a": 10.0, "dock": 15.0}}
    cuts = floor.times(exponential(40.0), "automatic", "cut", "saw")
    packs = floor.times(exponential(15.0), "automatic", "pack", "packer")
    truck = Subject(floor, k=0)

    def spends(seconds, place_from, place_to, cause=""):
        truck.now("transport", place_from=place_from, place_to=place_to, cause=cause)
        yield env.timeout(seconds)
        truck.close(env.now)

    def drives(place, to, cause=""):
        yield from spends(drive_s[place][to], place, to, cause)

    def life():
        place = "dock"
        while True:
            call = yield calls.get()
            yield from drives(place, "a", "pickup")
            aboard = []
            while call is not None:
                yield from spends(3.0, "a", "a")
                loaded, _ = call
                loaded.succeed()
                aboard.append(call)
                yield EndOfInstant(env)  # all who call at this instant have called
                call = (yield calls.get()) if calls.items and len(aboard) < 2 else None
            yield from drives("a", "b")
            for _, unloaded in aboard:
                yield from spends(2.0, "b", "b")
                unloaded.succeed()
            place = "b"
            yield EndOfInstant(env)
            if not calls.items:
                yield from drives("b", "dock", "idle")
                place = "dock"

    def part(n):
        job = Job(floor, n, "part")
        job.now("queue", station="saw")
        with saw.request() as server:
            yield server
            k, lasts_s = next(cuts)
            yield job.works(lasts_s, k, station="saw", task="cut")
            job.now("held", station="saw", cause="pickup")
            loaded, unloaded = env.event(), env.event()
            yield EndOfInstant(env, n)
            calls.put((loaded, unloaded))
            yield loaded
        job.now("transport", station="packer")
        yield unloaded
        job.now("queue", station="packer")
        with packer.request() as server:
            yield server
            k, lasts_s = next(packs)
            yield job.works(lasts_s, k, station="packer", task="pack")
        job.leaves()

    env.process(life())
    floor.poisson(20.0, part)


PREEMPTION = """
opsim: 1
name: pre-emption
run: {horizon: 2 h, seed: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {dist: uniform, low: 10 s, high: 40 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], preempt: resume}}
products: {low: {route: [saw]}, mid: {route: [saw], priority: 1}, top: {route: [saw], priority: 2}}
sources:
  s1: {kind: poisson, every: 80 s, products: [low]}
  s2: {kind: poisson, every: 100 s, products: [mid]}
  s3: {kind: poisson, every: 120 s, products: [top]}
"""


def preemption(floor: Floor) -> None:
    """A job takes the saw from one of lower priority, which is the first of its priority to have it again."""
    env, saw = floor.env, simpy.PreemptiveResource(floor.env, 1)
    times = floor.times(uniform(10.0, 40.0), "automatic", "cut", "saw")

    def part(n, product, rank):
        job = Job(floor, 3 * n + 2 - rank, product)
        k, rest_s, done = None, 0.0, 0.0
        job.now("queue", station="saw")
        yield EndOfInstant(env, rank)
        while done < 1.0:
            before_equals = 0.0 if k is None else 0.5
            with saw.request(priority=rank - before_equals, preempt=k is None) as server:
                yield server
                if k is None:
                    k, rest_s = next(times)
                try:
                    yield job.works(rest_s, k, done, station="saw", task="cut")
                    done = 1.0
                except simpy.Interrupt:
                    done, rest_s = job.progress(env.now), rest_s - (env.now - job.since_s)
                    job.now("queue", station="saw", cause="preempted")
        job.leaves()

    floor.poisson(80.0, part, "s1", product="low", rank=2)
    floor.poisson(100.0, part, "s2", product="mid", rank=1)
    floor.poisson(120.0, part, "s3", product="top", rank=0)
