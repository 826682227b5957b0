"""FactorySimPy: nodes and edges of a factory on SimPy. It has no workers, so no pool."""

from contextlib import redirect_stdout
from io import StringIO

import simpy

with redirect_stdout(StringIO()):
    from factorysimpy.edges.buffer import Buffer
    from factorysimpy.nodes.machine import Machine
    from factorysimpy.nodes.sink import Sink
    from factorysimpy.nodes.source import Source

from bench.peers.times import BUFFER

ENDLESS = 10**9


def mm1(until_s, times):
    stats = _run(until_s, {"inter_arrival_time": times.gap, "blocking": False}, [times.service[0]], ENDLESS)
    finished = stats["num_item_received"]
    return finished, stats["total_cycle_time"] / finished


def line(until_s, times):
    stats = _run(until_s, {"inter_arrival_time": 0, "blocking": True}, times.service, 1)
    return stats["num_item_received"], stats["num_item_received"] / until_s


def _run(until_s, source, services, before_first):
    """It prints as it goes: kept from the screen."""
    with redirect_stdout(StringIO()):
        env = simpy.Environment()
        nodes = [Source(env, "source", out_edge_selection="FIRST_AVAILABLE", **source)]
        for rank, serve in enumerate(services):
            nodes.append(Machine(env, f"m{rank}", work_capacity=1, processing_delay=serve, blocking=True))
        nodes.append(Sink(env, "sink"))
        between = [before_first, *[BUFFER] * (len(services) - 1), ENDLESS]
        for rank, capacity in enumerate(between):
            Buffer(env, f"b{rank}", capacity=capacity).connect(nodes[rank], nodes[rank + 1])
        env.run(until=until_s)
    return nodes[-1].stats
