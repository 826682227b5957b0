"""SimPy written for speed: two processes for the queue; a list of idle workers and events of waiting jobs."""

import simpy
from bench.peers.times import SKILLS


def mm1(until_s, times):
    env, spent, serve = simpy.Environment(), [], times.service[0]
    queue = simpy.Store(env)

    def source():
        while True:
            yield env.timeout(times.gap())
            yield queue.put(env.now)

    def server():
        while True:
            came_s = yield queue.get()
            yield env.timeout(serve())
            spent.append(env.now - came_s)

    env.process(source())
    env.process(server())
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)


def pool(until_s, times):
    env, spent, serve = simpy.Environment(), [], times.service[0]
    idle, waiting = list(range(len(SKILLS))), []

    def job(station):
        came_s = env.now
        worker = next((w for w in idle if station in SKILLS[w]), None)
        if worker is None:
            turn = env.event()
            waiting.append((station, turn))
            worker = yield turn
        else:
            idle.remove(worker)
        yield env.timeout(serve())
        spent.append(env.now - came_s)
        for rank, (asked, turn) in enumerate(waiting):
            if asked in SKILLS[worker]:
                del waiting[rank]
                turn.succeed(worker)
                return
        idle.append(worker)

    def source():
        while True:
            yield env.timeout(times.gap())
            env.process(job(times.station()))

    env.process(source())
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)
