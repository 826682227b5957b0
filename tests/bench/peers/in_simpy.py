"""SimPy by hand, as its users write it: a process per customer, Stores between machines, a FilterStore of workers."""

import simpy
from bench.peers.times import BUFFER, N_STATIONS, SKILLS


def mm1(until_s, times):
    env, spent = simpy.Environment(), []
    server, serve = simpy.Resource(env), times.service[0]

    def customer():
        came_s = env.now
        with server.request() as turn:
            yield turn
            yield env.timeout(serve())
        spent.append(env.now - came_s)

    def source():
        while True:
            yield env.timeout(times.gap())
            env.process(customer())

    env.process(source())
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)


def line(until_s, times):
    env, finished = simpy.Environment(), [0]
    buffers = [simpy.Store(env, capacity=BUFFER) for _ in range(N_STATIONS - 1)]

    def machine(rank, serve):
        while True:
            if rank:
                yield buffers[rank - 1].get()
            yield env.timeout(serve())
            if rank < N_STATIONS - 1:
                yield buffers[rank].put(1)
            else:
                finished[0] += 1

    for rank, serve in enumerate(times.service):
        env.process(machine(rank, serve))
    env.run(until_s)
    return finished[0], finished[0] / until_s


def pool(until_s, times):
    env, spent, serve = simpy.Environment(), [], times.service[0]
    idle = simpy.FilterStore(env)
    idle.items = list(range(len(SKILLS)))

    def job(station):
        came_s = env.now
        worker = yield idle.get(lambda w: station in SKILLS[w])
        yield env.timeout(serve())
        idle.put(worker)
        spent.append(env.now - came_s)

    def source():
        while True:
            yield env.timeout(times.gap())
            env.process(job(times.station()))

    env.process(source())
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)
