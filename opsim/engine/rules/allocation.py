"""Which free worker goes to which station that calls for one: every pair gets a key, the smallest goes first."""


def longest_queue(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """The station with most jobs waiting, in its buffer or on servers; then the oldest call, then the nearer worker."""
    return (-n_waiting, oldest_since_s, walk_s, -rating, station_rank, worker_rank)


def nearest(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """The shortest walk; then the job that waits longest, then the better skill."""
    return (walk_s, oldest_since_s, -rating, -n_waiting, station_rank, worker_rank)


def oldest_job(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """First come, first served: the oldest call; then the nearer worker, then the better skill."""
    return (oldest_since_s, walk_s, -rating, -n_waiting, station_rank, worker_rank)


ALLOCATION_RULES = {"longest_queue": longest_queue, "nearest": nearest, "oldest_job": oldest_job}
