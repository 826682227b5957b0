"""Quality: whether an operation leaves a defect, and what an inspection makes of a job."""


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
