"""Which of several parallel stations a job goes to: every station with room gets a key, the smallest wins.

``n_inside`` counts jobs on servers, in the buffer and on their way; ``mean_s`` is the mean time of the operation there,
``setup_s`` that of the set-up the job would need now, ``distance_m`` how far away the station is (0 for a new job),
``position`` where it stands in the list of the route.
"""


def shortest_queue(n_inside, servers, station_rank, n_free=0, mean_s=0.0, setup_s=0.0, distance_m=0.0, position=0):
    """Fewest jobs per server, those in process included."""
    return (n_inside / servers, station_rank)


def least_loaded(n_inside, servers, station_rank, n_free, mean_s, setup_s, distance_m, position):
    """Least work per server, this job's own and its set-up included: where it would be done first."""
    return ((n_inside + 1) * mean_s / servers + setup_s, station_rank)


def first_free(n_inside, servers, station_rank, n_free, mean_s, setup_s, distance_m, position):
    """The first of the list with a free server; where all are busy, fewest jobs per server."""
    return (0.0 if n_free > 0 else n_inside / servers, position, station_rank)


def in_order(n_inside, servers, station_rank, n_free, mean_s, setup_s, distance_m, position):
    """The first of the list that has room: the others take what it cannot."""
    return (position, station_rank)


ROUTING_RULES = {
    "shortest_queue": shortest_queue,
    "least_loaded": least_loaded,
    "first_free": first_free,
    "in_order": in_order,
}
