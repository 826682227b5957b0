"""A dispatch rule: the smallest key goes first, and natural ranks at the end break ties."""


def best_skill(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """Everybody goes where he is best; of equals the oldest call, then the shortest walk."""
    return (-rating, oldest_since_s, walk_s, station_rank, worker_rank)
