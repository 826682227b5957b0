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


def most_downstream(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """The job that is nearest to its end, by ``steps_to_go``, which comes before; then the oldest call."""
    return (oldest_since_s, walk_s, -rating, -n_waiting, station_rank, worker_rank)


def best_skill(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """The worker where he is best; then the oldest call, then the shorter walk."""
    return (-rating, oldest_since_s, walk_s, -n_waiting, station_rank, worker_rank)


def least_exposed(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):
    """Whose body has gone through least so far, by ``less_gone_through``, which comes before; then the oldest call."""
    return (oldest_since_s, walk_s, -rating, -n_waiting, station_rank, worker_rank)


def whose_it_is(outside_zone, floater):
    """Before everything else: people whose own station it is, then floaters, then people out of their zones; a floater
    out of a zone of his own is the last.
    """
    return (outside_zone, floater)


def more_urgent(priority):
    """Of a station, or of the job that calls there: the higher the sooner."""
    return (-priority,)


def nearer_to_its_end(steps_to_go):
    """Before the key of ``most_downstream``: the fewest operations left, this one included, on average."""
    return (steps_to_go,)


def less_gone_through(dose):
    """Before the keys of ``least_exposed``: the least dose so far, RULA x seconds."""
    return (dose,)


ALLOCATION_RULES = {
    "longest_queue": longest_queue,
    "nearest": nearest,
    "oldest_job": oldest_job,
    "most_downstream": most_downstream,
    "best_skill": best_skill,
    "least_exposed": least_exposed,
}
