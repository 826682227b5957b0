"""Which of the jobs that wait in front of a station comes next: each gets a key, the smallest goes first.

Priorities come before any rule, and a job that was pre-empted before the others of its priority. ``work_s`` is the
mean time of the operation the job waits for, ``left_s`` that of this and all later ones, ``left_steps`` how many these
are on average; ``due_s`` is infinite where a job has no due date; ``setup_s`` is the mean set-up that the server needs.
"""


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


def queue_key(priority, preempted, *by_rule):
    """What the queue is ordered by: priority, then those that were begun and pre-empted, then the rule's own key."""
    return (-priority, not preempted, *by_rule)


def may_preempt(priority, priority_on_server):
    """Whether a waiting job takes the server of another: only of a lower priority."""
    return priority > priority_on_server


def victim_key(priority, since_s, number):
    """Which of several jobs gives its server up: the lowest priority, then the one begun last."""
    return (priority, -since_s, -number)
