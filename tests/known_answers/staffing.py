"""What variance between people costs a line: ``staffing.yaml`` against the recursion of a line with redrawn people.

Five saturated stations, lognormal times, total coefficient of variation 0.30, two places between, throughput times mean
time; 3,000 crews through the exact recursion of a line (blocking after service), Dallery & Gershwin 1992, sec. 5.
"""

from known_answers.cases import Case

EXPECTED = {"none": (0.939, None), "quarter": (0.850, 0.082), "half": (0.808, 0.112)}
"""By variant: mean over workforces, and standard deviation over workforces where people differ."""
ORACLE_ERROR = 0.004
CASES = tuple(Case("staffing", variant, "throughput_per_h", (), few=100) for variant in EXPECTED)


def rates(runs, variant: str):
    """(replications,) throughput times mean time, one a workforce."""
    return runs["staffing", variant]["throughput_per_h"] / 3600.0
