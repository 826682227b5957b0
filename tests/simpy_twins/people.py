"""Twins of floors where people decide: shifts, teams, skills, ways."""

from itertools import count
from typing import NamedTuple

import simpy
from simpy_twins.floor import EndOfInstant, Floor, Job, Worker, exponential, on_grid, uniform


class Call(NamedTuple):
    """A job on the server of a station that waits for a worker, and the event that ends its wait."""

    job: Job
    station: str
    answer: simpy.Event


SHIFTS = """
opsim: 1
name: shift change
run: {start: Mon 06:00, horizon: 20 d, seed: 1}
layout: {places: {bay: [0 m, 0 m]}}
tasks: {weld: {dist: uniform, low: 1200 s, high: 4200 s}}
stations: {bench: {at: bay, tasks: [weld]}}
products: {part: {route: [bench]}}
release: {kind: poisson, every: 85 min}
shifts:
  early: {from: 06:00, to: 14:00, at_end: resume_any}
  late: {from: 14:00, to: 22:00, at_end: resume_any}
workers: {ana: {shift: early, skills: {bench: 1.0}}, ben: {shift: late, skills: {bench: 1.0}}}
"""
DAY_S, SHIFT_S = 24 * 3600.0, 8 * 3600.0


def shifts(floor: Floor) -> None:
    """A job that is begun at the end of a shift is gone on with by whoever comes next, at his own pace."""
    env, bench, there = floor.env, simpy.Resource(floor.env, 1), simpy.Store(floor.env)
    at_work = {}
    times = {name: floor.times(uniform(1200.0, 4200.0), "duration", "weld", name) for name in ("ana", "ben")}

    def calendar(worker, start_s):
        for day in count():
            worker.waits("off", "")
            yield env.timeout(day * DAY_S + start_s - env.now)
            worker.waits()
            there.put(worker)
            yield env.timeout(SHIFT_S)
            yield EndOfInstant(env, 0)  # what is done at this instant is done
            if worker in there.items:
                there.items.remove(worker)
            else:
                at_work[worker.name].interrupt()

    def part(n):
        job, done = Job(floor, n, "part"), 0.0
        job.now("queue", station="bench")
        with bench.request() as server:
            yield server
            while done < 1.0:
                job.now("held", station="bench", cause="worker")
                yield EndOfInstant(env)  # who has to go has gone
                worker = yield there.get()
                at_work[worker.name] = env.active_process
                k, whole_s = next(times[worker.name])
                try:
                    rest_s = on_grid(whole_s * (1.0 - done))
                    yield worker.performs(job, rest_s, k, done, station="bench", task="weld")
                    done = 1.0
                    worker.waits()
                    there.put(worker)
                except simpy.Interrupt:
                    done = job.progress(env.now)
        job.leaves()

    env.process(calendar(Worker(floor, "ana", "bay"), 0.0))
    env.process(calendar(Worker(floor, "ben", "bay"), SHIFT_S))
    floor.poisson(85 * 60.0, part)


TEAM = """
opsim: 1
name: team
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {lift: {dist: uniform, low: 10 s, high: 30 s, team: 2}, pack: {dist: exponential, mean: 15 s}}
stations: {s1: {at: a, tasks: [lift]}, s2: {at: b, tasks: [pack]}}
products: {part: {route: [s1, s2]}}
release: {kind: poisson, every: 60 s}
workers: {w1: {home: a, skills: {s1: 1.0}}, w2: {home: b, walk: 1 m/s, skills: {s1: 0.8, s2: 1.0}}}
"""


def team(floor: Floor) -> None:
    """Two lift together as long as the slower takes; one of them packs as well, where nobody waits to lift."""
    env = floor.env
    lift, pack, w2_free = simpy.Resource(env, 1), simpy.Resource(env, 1), simpy.PriorityResource(env, 1)
    w1, w2 = Worker(floor, "w1", "a"), Worker(floor, "w2", "b")
    times = {
        (task, worker): floor.times(draw, "duration", task, worker.name, rating=rating)
        for task, worker, draw, rating in (
            ("lift", w1, uniform(10.0, 30.0), 1.0),
            ("lift", w2, uniform(10.0, 30.0), 0.8),
            ("pack", w2, exponential(15.0), 1.0),
        )
    }

    def goes_to(place, **about):
        if w2.place != place:
            yield w2.walks(place, 6.0 / 1.0, **about)

    def lifts(worker, job, k, lasts_s):
        worker.now("work", lasts_s, station="s1", product=job.product, task="lift", k=k, progress_from=0.0)
        yield env.timeout(lasts_s)
        worker.waits(cause="team", station="s1", **job.who)

    def part(n):
        job = Job(floor, n, "part")
        job.now("queue", station="s1")
        server = lift.request()
        yield server
        job.now("held", station="s1", cause="worker")
        both = w2_free.request(priority=0)
        yield both
        job.now("held", station="s1", cause="team")
        w1.waits(cause="team", station="s1", **job.who)
        yield from goes_to("a", station="s1", **job.who)
        parts = {worker: next(times["lift", worker]) for worker in (w1, w2)}
        slowest_s = max(lasts_s for _, lasts_s in parts.values())
        job.now("work", slowest_s, station="s1", task="lift", progress_from=0.0)
        yield env.all_of([env.process(lifts(worker, job, *part)) for worker, part in parts.items()])
        job.now("queue", station="s2")
        w1.waits()
        w2.waits()
        lift.release(server)
        yield EndOfInstant(env)  # who waits to be lifted takes the server, and calls both again
        w2_free.release(both)
        with pack.request() as server:
            yield server
            job.now("held", station="s2", cause="worker")
            yield EndOfInstant(env)  # who calls both at this instant comes first
            with w2_free.request(priority=1) as alone:
                yield alone
                yield from goes_to("b", station="s2", **job.who)
                k, lasts_s = next(times["pack", w2])
                yield w2.performs(job, lasts_s, k, station="s2", task="pack")
                w2.waits()
                job.leaves()
                yield EndOfInstant(env)  # and so he does when w2 comes free

    floor.poisson(60.0, part)


SKILLS = """
opsim: 1
name: two skills
run: {horizon: 1 h, seed: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {drill: {dist: exponential, mean: 15 s}, glue: {dist: exponential, mean: 10 s}}
stations: {s1: {at: hall, tasks: [drill], servers: 2}, s2: {at: hall, tasks: [glue], servers: 2}}
products: {a: {share: 0.4, route: [s1]}, b: {share: 0.6, route: [s2]}}
release: {kind: poisson, every: 9 s}
workers: {ana: {skills: {s1: 1.0, s2: 0.7}}, ben: {skills: {s2: 1.0}}}
allocation: {rule: oldest_job}
"""


def skills(floor: Floor) -> None:
    """Ana can do both, Ben one of them and better: the oldest call first, and of who is free the better one goes."""
    env, free, calls = floor.env, [], []
    servers = {station: simpy.Resource(env, 2) for station in ("s1", "s2")}
    tasks = {"s1": ("drill", exponential(15.0)), "s2": ("glue", exponential(10.0))}
    rating = {"ana": {"s1": 1.0, "s2": 0.7}, "ben": {"s2": 1.0}}
    times = {}
    for name, stations in rating.items():
        free.append(Worker(floor, name, "hall"))
        for station, of in stations.items():
            task, draw = tasks[station]
            times[name, station] = floor.times(draw, "duration", task, name, rating=of)

    def key(pair):
        call, worker = pair
        return call.job.since_s, -rating[worker.name][call.station], call.station, call.job.number

    def send():
        yield EndOfInstant(env)
        while pairs := [(call, worker) for call in calls for worker in free if call.station in rating[worker.name]]:
            call, worker = min(pairs, key=key)
            calls.remove(call)
            free.remove(worker)
            call.answer.succeed(worker)

    def part(n):
        made = "a" if floor.chance(n, "mix", "release") < 0.4 else "b"
        job, station = Job(floor, n, made), {"a": "s1", "b": "s2"}[made]
        job.now("queue", station=station)
        with servers[station].request() as server:
            yield server
            job.now("held", station=station, cause="worker")
            calls.append(Call(job, station, env.event()))
            env.process(send())
            worker = yield calls[-1].answer
            k, lasts_s = next(times[worker.name, station])
            yield worker.performs(job, lasts_s, k, station=station, task=tasks[station][0])
            worker.waits()
            free.append(worker)
        job.leaves()
        env.process(send())

    floor.poisson(9.0, part)


WALKS = """
opsim: 1
name: one worker walks
run: {horizon: 1 h, seed: 1}
layout: {distance: rectilinear, places: {home: [0 m, 0 m], p1: [8 m, 1 m], p2: [12 m, 5 m], p3: [0 m, 9 m]}}
tasks: {tend: {dist: exponential, mean: 10 s}}
stations: {s1: {at: p1, tasks: [tend]}, s2: {at: p2, tasks: [tend]}, s3: {at: p3, tasks: [tend]}}
products: {a: {share: 0.5, route: [s1]}, b: {share: 0.25, route: [s2]}, c: {share: 0.25, route: [s3]}}
release: {kind: poisson, every: 25 s}
workers: {eve: {home: home, walk: 1.2 m/s, skills: {s1: 1.0, s2: 1.0, s3: 1.0}}}
allocation: {rule: nearest, idle: home}
"""


def walks(floor: Floor) -> None:
    """She goes to the nearest call, of equally near ones to the oldest; and home, where nobody calls, all the way."""
    env, calls = floor.env, simpy.FilterStore(floor.env)
    at_m = {"home": (0, 0), "p1": (8, 1), "p2": (12, 5), "p3": (0, 9)}
    places = {"s1": "p1", "s2": "p2", "s3": "p3"}
    servers = {station: simpy.Resource(env, 1) for station in places}
    eve, times = Worker(floor, "eve", "home"), floor.times(exponential(10.0), "duration", "tend", "eve")

    def walk_s(place):
        (x, y), (u, v) = at_m[eve.place], at_m[place]
        return (abs(x - u) + abs(y - v)) / 1.2

    def nearest(call):
        return call is min(calls.items, key=lambda one: (walk_s(places[one.station]), one.job.since_s))

    def part(n):
        drawn = floor.chance(n, "mix", "release")
        made, station = ("a", "s1") if drawn < 0.5 else ("b", "s2") if drawn < 0.75 else ("c", "s3")
        job = Job(floor, n, made)
        job.now("queue", station=station)
        with servers[station].request() as server:
            yield server
            job.now("held", station=station, cause="worker")
            done = env.event()
            calls.put(Call(job, station, done))
            yield done
        job.leaves()

    def life():
        while True:
            yield EndOfInstant(env)  # who takes the server that came free calls as well
            if not calls.items and eve.place != "home":
                yield eve.walks("home", walk_s("home"))
                eve.waits()
                continue
            job, station, done = yield calls.get(nearest)
            if eve.place != places[station]:
                yield eve.walks(places[station], walk_s(places[station]), station=station, **job.who)
            k, lasts_s = next(times)
            yield eve.performs(job, lasts_s, k, station=station, task="tend")
            eve.waits()
            done.succeed()

    env.process(life())
    floor.poisson(25.0, part)
