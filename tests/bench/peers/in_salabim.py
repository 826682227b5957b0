"""salabim in its ``yield`` mode, monitors off: components, Stores and filters."""

import salabim
from bench.peers.times import BUFFER, N_STATIONS, SKILLS

salabim.yieldless(False)


def mm1(until_s, times):
    env, spent, serve = salabim.Environment(trace=False), [], times.service[0]
    server = salabim.Resource("server", capacity=1)
    for monitor in (server.claimed_quantity, server.available_quantity, server.capacity, server.occupancy):
        monitor.monitor(False)
    for queue in (server.requesters(), server.claimers()):
        queue.length.monitor(False)
        queue.length_of_stay.monitor(False)

    class Customer(salabim.Component):
        def process(self):
            came_s = env.now()
            yield self.request(server)
            yield self.hold(serve())
            self.release(server)
            spent.append(env.now() - came_s)

    class Source(salabim.Component):
        def process(self):
            while True:
                yield self.hold(times.gap())
                Customer()

    Source()
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)


def line(until_s, times):
    env, finished = salabim.Environment(trace=False), [0]
    buffers = [salabim.Store(f"buffer {rank}", capacity=BUFFER, monitor=False) for rank in range(N_STATIONS - 1)]

    class Machine(salabim.Component):
        def setup(self, rank):
            self.rank, self.serve = rank, times.service[rank]

        def process(self):
            while True:
                if self.rank:
                    yield self.from_store(buffers[self.rank - 1])
                    part = self.from_store_item()
                else:
                    part = salabim.Component("part", process=None)
                yield self.hold(self.serve())
                if self.rank < N_STATIONS - 1:
                    yield self.to_store(buffers[self.rank], part)
                else:
                    finished[0] += 1

    for rank in range(N_STATIONS):
        Machine(rank=rank)
    env.run(until_s)
    return finished[0], finished[0] / until_s


def pool(until_s, times):
    env, spent, serve = salabim.Environment(trace=False), [], times.service[0]
    idle = salabim.Store("idle", monitor=False)

    class Worker(salabim.Component):
        def setup(self, skills):
            self.skills = skills

    class Job(salabim.Component):
        def setup(self, station):
            self.station = station

        def process(self):
            came_s, station = env.now(), self.station
            yield self.from_store(idle, filter=lambda worker: station in worker.skills)
            worker = self.from_store_item()
            yield self.hold(serve())
            spent.append(env.now() - came_s)
            yield self.to_store(idle, worker)

    class Source(salabim.Component):
        def process(self):
            while True:
                yield self.hold(times.gap())
                Job(station=times.station())

    for skills in SKILLS:
        Worker(skills=skills).enter(idle)
    Source()
    env.run(until_s)
    return len(spent), sum(spent) / len(spent)
