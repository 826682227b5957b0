"""When people go, and what becomes of the task under way: breaks, the end of the shift, absence, overtime."""

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
