"""Simantha: lines of machines. Its documents warn against sources with gaps, and it has no workers: only the line."""

from bench.peers.times import BUFFER, N_STATIONS
from simantha import Buffer, Machine, Sink, Source, System


class Timed(Machine):
    """A machine whose cycle times come from a callable: its own distributions are of whole seconds."""

    def __init__(self, seconds, name):
        self.seconds = seconds
        super().__init__(name=name, initial_remaining_process=0)

    def get_cycle_time(self):
        return self.seconds()


def line(until_s, times):
    source, sink = Source(), Sink()
    machines = [Timed(serve, f"m{rank}") for rank, serve in enumerate(times.service)]
    buffers = [Buffer(capacity=BUFFER, name=f"b{rank}") for rank in range(N_STATIONS - 1)]
    source.define_routing(downstream=[machines[0]])
    for rank, machine in enumerate(machines):
        before, after = ([source, *buffers][rank], [*buffers, sink][rank])
        machine.define_routing(upstream=[before], downstream=[after])
    for rank, buffer in enumerate(buffers):
        buffer.define_routing(upstream=[machines[rank]], downstream=[machines[rank + 1]])
    system = System([source, *machines, *buffers, sink])
    system.simulate(simulation_time=until_s, verbose=False, collect_data=False)
    return sink.level, sink.level / until_s
