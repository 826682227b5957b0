"""Which of several parallel stations a job goes to: every station with room gets a key, the smallest wins."""


def shortest_queue(n_inside, servers, station_rank):
    """Fewest jobs per server, those in process included."""
    return (n_inside / servers, station_rank)
