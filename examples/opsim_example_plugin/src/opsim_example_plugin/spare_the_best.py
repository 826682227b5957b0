"""A dispatch rule: the smallest key goes first, and natural ranks at the end break ties."""


def spare_the_best(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """Those who are slower at it go first, so that the best stay free; of equals the oldest call, then the nearer."""
    return (+rating, oldest_since_s, walk_s, station_rank, worker_rank)
