"""Paced lines: who meets whom, and two at one task."""

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
