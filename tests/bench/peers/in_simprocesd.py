"""simprocesd: factories of machines. Cycle times from a callable by a property; it has no pool of workers by skill."""

from bench.peers.times import BUFFER, N_STATIONS
from simprocesd.model import System
from simprocesd.model.factory_floor import Buffer, PartGenerator, PartProcessor, Sink, Source


class Timed:
    """A source or machine whose cycle times come from a callable."""

    def __init__(self, seconds, **arguments):
        self.seconds = seconds
        super().__init__(**arguments)

    @property
    def cycle_time(self):
        return self.seconds()

    @cycle_time.setter
    def cycle_time(self, _seconds):
        pass


class TimedSource(Timed, Source):
    pass


class TimedMachine(Timed, PartProcessor):
    pass


def mm1(until_s, times):
    came_s, spent = {}, []

    class Arrivals(PartGenerator):
        def generate_part(self):
            part = super().generate_part()
            came_s[part.id] = source.env.now
            return part

    system = System()
    source = TimedSource(times.gap, name="source", part_generator=Arrivals(name_prefix="part"))
    machine = TimedMachine(times.service[0], name="machine", upstream=[Buffer(upstream=[source])])
    machine.add_finish_processing_callback(lambda m, part: spent.append(m.env.now - came_s.pop(part.id)))
    Sink(upstream=[machine])
    system.simulate(until_s, print_summary=False)
    return len(spent), sum(spent) / len(spent)


def line(until_s, times):
    system, before = System(), Source()
    for rank, serve in enumerate(times.service):
        before = TimedMachine(serve, upstream=[before], name=f"m{rank}")
        if rank < N_STATIONS - 1:
            before = Buffer(upstream=[before], capacity=BUFFER)
    sink = Sink(upstream=[before])
    system.simulate(until_s, print_summary=False)
    return sink.received_parts_count, sink.received_parts_count / until_s
