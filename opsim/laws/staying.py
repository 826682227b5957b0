"""What somebody may still do when his time has come: what the rule of interruption lets him finish, and no more."""

import numpy as np

from opsim.clock import ticks
from opsim.log import SETUP, WAIT, WALK, WORK, EventLog
from opsim.plan import Plan

AT_ONCE = ("resume", "resume_any", "restart")
"""Rules under which a task is left when the time has come."""


def overrun(own: EventLog, plan: Plan, limit: int, of_shift: str) -> int | None:
    """When somebody is first at work after ``limit`` on something that no rule keeps him for; None: never. In ticks.

    own : his rows from his last work before the limit on, in order
    of_shift : the rule of his shift, which holds where the task that the limit met has none
    """
    works = np.isin(own["kind"], (WORK, SETUP))
    ends = ticks(own["end_s"])
    stands_by = np.isin(own["kind"], (WAIT, WALK)) & (own["station"] >= 0)  # or comes to it
    stands_by &= (ticks(own["start_s"]) <= limit) & (ends >= limit)
    at_limit = np.flatnonzero((works & (ends == limit)) | stands_by)[-1:]  # at work, or with the others of a team
    before = np.flatnonzero(works & (ends <= limit))[-1:]
    performance = max(own["performance_id"][before], default=-1)  # perhaps he waits for a tool in the middle of it
    rule, helped = "", (-1, -1)
    job, station = (max(own[name][at_limit], default=-1) for name in ("job", "station"))
    for at in np.flatnonzero(works & (ends > limit)):
        begin = int(ticks(own["start_s"][at]))
        if begin < limit:
            performance, job, station = (own[name][at] for name in ("performance_id", "job", "station"))
            helped = own["task"][at], own["k"][at]  # who is helped goes on with the same at another pace
        rule = rule or plan.tasks[own["task"][at]].interruption or of_shift  # that of the task which the limit met
        same = own["performance_id"][at] == performance or (own["task"][at], own["k"][at]) == helped
        of_team = -1 in (job, own["job"][at])  # rows of a team's members name no job
        same_job = own["station"][at] == station and (of_team or own["job"][at] == job)
        goes_on = begin == limit and own["progress_from"][at] > 0  # what somebody began before
        same = same or (rule == "finish_job" and (same_job or goes_on))
        waited = begin > limit and stands_by.any() and own["progress_from"][at] > 0  # for a tool, in the middle of it
        same = same or (waited and own["job"][at] == job >= 0)
        if goes_on and rule == "finish_job":
            job, station = own["job"][at], own["station"][at]
        if rule in AT_ONCE or not same:
            return max(limit, begin)
    return None
