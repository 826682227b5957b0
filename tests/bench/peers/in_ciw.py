"""Ciw: networks of queues. Its workers belong to a node, so it has no pool of workers across stations."""

import ciw
from bench.peers.times import BUFFER, N_STATIONS


class Next(ciw.dists.Distribution):
    """Seconds from a callable."""

    def __init__(self, seconds):
        self.seconds = seconds

    def sample(self, t=None, ind=None):
        return self.seconds()

    def __deepcopy__(self, _memo):
        """NOTE: Ciw copies its networks; copies of one generator would give every station the same seconds."""
        return self


def mm1(until_s, times):
    network = ciw.create_network(
        arrival_distributions=[Next(times.gap)],
        service_distributions=[Next(times.service[0])],
        number_of_servers=[1],
    )
    spent = [record.exit_date - record.arrival_date for record in _records(network, until_s)]
    return len(spent), sum(spent) / len(spent)


def line(until_s, times):
    """All jobs wait before the first station from the start; 0.8 a second are never used up."""
    after_first = N_STATIONS - 1
    n_jobs = int(0.8 * until_s) + 100
    network = ciw.create_network(
        arrival_distributions=[ciw.dists.Sequential([0.0, float("inf")])] + [None] * after_first,
        batching_distributions=[ciw.dists.Deterministic(n_jobs)] + [ciw.dists.Deterministic(1)] * after_first,
        service_distributions=[Next(serve) for serve in times.service],
        number_of_servers=[1] * N_STATIONS,
        queue_capacities=[float("inf")] + [BUFFER] * after_first,
        routing=[[float(to == start + 1) for to in range(N_STATIONS)] for start in range(N_STATIONS)],
    )
    finished = sum(record.node == N_STATIONS for record in _records(network, until_s))
    return finished, finished / until_s


def _records(network, until_s):
    simulation = ciw.Simulation(network)
    simulation.simulate_until_max_time(until_s)
    return [record for record in simulation.get_all_records() if record.exit_date < until_s]
