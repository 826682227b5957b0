"""Decisions: pure functions of scalars that return a key (a tuple of floats ending in natural rank) or a bool.

They use + - * / comparisons, min and max only, so that a compiled engine can run the same source. Smallest key wins.
"""

LEAST_EXPOSED = "least_exposed"
"""Its name, among the rules of allocation and among those of rotations."""


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


def batch_begins(n_waiting, size, longest_wait_s, most_wait_s):
    """Whether jobs of one class begin: enough for a full batch, or the first of them has waited as long as it may."""
    return n_waiting >= size or longest_wait_s >= most_wait_s


def takes_over(member, holder):
    """Bucket brigade: what is in the hands of somebody before him, or in nobody's."""
    return holder < member


def takes_up(member, holder):
    """Rabbit chase: what is in nobody's hands."""
    return holder < 0


def overtakes(station, station_of_next):
    """Whether a job that comes to a station of the line would be ahead of the one that is ahead of it."""
    return station > station_of_next


FINISH, FINISH_JOB, RESUME, RESUME_ANY, HAND_OVER, RESTART = range(6)
INTERRUPTION_RULES = {
    "finish": FINISH,
    "finish_job": FINISH_JOB,
    "resume": RESUME,
    "resume_any": RESUME_ANY,
    "hand_over": HAND_OVER,
    "restart": RESTART,
}


def works_on(rule, begun, operation_begun):
    """Whether somebody whose time has come goes on with what he is at.

    begun : whether he has done any of it since he took it up; operation_begun : whether any of the job's tasks here is
    """
    if rule == FINISH_JOB:
        return operation_begun
    return begun and rule in (FINISH, HAND_OVER)


def is_kept_for_him(rule, done):
    """Whether the rest waits for who began it; ``done``: the share of the performance that was done."""
    return rule == RESUME and done > 0


def is_lost(rule):
    """Whether what was done of the performance is lost."""
    return rule == RESTART


def pause_lasts_s(start_s, end_s):
    """A pause keeps its length, however late it begins."""
    return end_s - start_s


def is_absent(chance, share):
    """Whether somebody misses a shift; ``chance``: a number in [0, 1) of this worker and shift."""
    return chance < share


def stays_on(is_needed, most_s):
    """Whether somebody works overtime at the end of his shift, or still does."""
    return is_needed and most_s > 0


def first_relief(since_s, worker_rank):
    """Which of several who wait to be relieved comes first: who has waited longest."""
    return (since_s, worker_rank)


INFINITE_S = 1e300


def together_s(one_s: float, other_s: float) -> float:
    """How long two take together for what takes one of them one_s and the other other_s alone."""
    return 1.0 / (1.0 / one_s + 1.0 / other_s)


def meeting_s(gap_m: float, walk_m_per_s: float, line_m_per_s: float) -> float:
    """How long a worker walks to a job that is gap_m downstream of him (negative: upstream) and moves downstream."""
    if gap_m <= 0:
        return -gap_m / (walk_m_per_s + line_m_per_s)
    if walk_m_per_s <= line_m_per_s:
        return INFINITE_S
    return gap_m / (walk_m_per_s - line_m_per_s)


def strolled_m(from_m: float, to_m: float, walk_m_per_s: float, seconds: float) -> float:
    """Where somebody is who walks upstream to a point, and waits there."""
    return max(to_m, from_m - walk_m_per_s * seconds)


def leaves_defect(chance, yield_share):
    """``chance``: a number in [0, 1) of this operation on this job."""
    return chance >= yield_share


def share_of_good(yield_share, worst):
    """Of operations: the station's own yield, times the quality of the worst of those who worked on it."""
    return yield_share * worst


def turned_down(chance, bad, finds, false_alarms):
    """Whether a job is held to be bad: where it is, with ``finds``; where it is good, with ``false_alarms``."""
    return chance < (finds if bad else false_alarms)


def reworked(n_reworks, most):
    """Whether a job that was turned down, and was reworked so often before, is reworked again."""
    return n_reworks < most


def source_in_turn(n_released, source_rank):
    """Of several saturated sources the one that has made fewest jobs."""
    return (n_released, source_rank)


def stock_wanted(n_on_floor, n_waited_for, level):
    """Pieces that a base stock lacks: level + waited for - pieces in the store or on the way to it; 0 if none."""
    return max(0, level + n_waited_for - n_on_floor)


def longest_down(since_s, station_rank, stop_rank):
    """The stop that waits longest."""
    return (since_s, station_rank, stop_rank)


def in_turn(turns_away, at_post_s, here_s, member):
    """Everybody moves up by one post."""
    return (turns_away, member)


def least_time(turns_away, at_post_s, here_s, member):
    """Who was at the post for the shortest time so far; of several whose turn comes first."""
    return (at_post_s, turns_away, member)


def least_exposed_member(turns_away, at_post_s, here_s, member):
    """Posts by how heavy they are, each to whose body has gone through least so far, by ``less_gone_through``, which
    comes before; of several to the one whose turn comes first.
    """
    return (turns_away, member)


ROTATION_RULES = {"in_turn": in_turn, "least_time": least_time, "least_exposed": least_exposed_member}


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


def fifo(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """First come, first served."""
    return (since_s, number)


def spt(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """The shortest operation first."""
    return (work_s, since_s, number)


def edd(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """The earliest due date first."""
    return (due_s, since_s, number)


def critical_ratio(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """The smallest ratio of time left to work left first; late jobs have a negative one."""
    ratio = (due_s - now_s) / left_s if left_s > 0 else due_s - now_s
    return (ratio, since_s, number)


def least_setup(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """The shortest set-up first: stay with a product as long as there are jobs of it."""
    return (setup_s, since_s, number)


def downstream_first(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):
    """The fewest operations left first: what is nearly done is finished before new things are begun."""
    return (left_steps, since_s, number)


SEQUENCING_RULES = {
    "fifo": fifo,
    "spt": spt,
    "edd": edd,
    "critical_ratio": critical_ratio,
    "least_setup": least_setup,
    "downstream_first": downstream_first,
}
BY_DUE_DATE = ("edd", "critical_ratio")
"""Those that mean nothing where no job has a due date."""


def queue_key(priority, preempted, *by_rule):
    """What the queue is ordered by: priority, then those that were begun and pre-empted, then the rule's own key."""
    return (-priority, not preempted, *by_rule)


def may_preempt(priority, priority_on_server):
    """Whether a waiting job takes the server of another: only of a lower priority."""
    return priority > priority_on_server


def victim_key(priority, since_s, number):
    """Which of several jobs gives its server up: the lowest priority, then the one begun last."""
    return (priority, -since_s, -number)


COMPLETION, REPAIR, BREAKDOWN, CALENDAR, ARRIVAL = range(5)


def enough(n_free, n_wanted):
    """Whether as many are free as are wanted."""
    return n_free >= n_wanted


def soonest_there(drive_s, vehicle_number):
    """The free vehicle that is soonest at the job that has called longest."""
    return (drive_s, vehicle_number)


def nearest_stop(drive_s, place_rank):
    """Of the places where something on a vehicle goes, the nearest."""
    return (drive_s, place_rank)


def walks_to_carry(lot, mass_kg, most_load_kg):
    """How often somebody walks, there and back, to bring a lot whose units have a mass; a unit at least each time."""
    units_at_once = max(1, (most_load_kg + 1e-9) // mass_kg)
    trips = -(-lot // units_at_once)
    return 2 * trips - 1


def keeps_shared(n_inside, servers, buffer, filled):
    """The half-full-buffer rule, with ``filled`` 0.5: the next station has no free server and ``filled`` of its buffer.

    n_inside : jobs at the next station, in its buffer and on its servers

    Source: Ostolaza, McClain & Thomas 1990, The use of dynamic (state-dependent) assembly-line balancing to improve
    throughput, J. Manufacturing and Operations Management 3:105-133; McClain, Thomas & Sox 1992, "On-the-fly" line
    balancing with very little WIP, Int. J. Production Economics 27:283-289.
    """
    return n_inside >= servers and n_inside - servers >= filled * buffer
