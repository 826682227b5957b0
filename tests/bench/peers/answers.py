"""What the models must answer: job by job from the given numbers, and in the long run.

mm1 by Lindley's recursion (1952), the line by the recursion of blocking after service (Dallery & Gershwin 1992),
the pool by a loop over its events.
"""

from bisect import bisect_left
from collections.abc import Callable
from heapq import heappop, heappush
from itertools import accumulate
from math import sqrt

from bench.peers.times import SKILLS, Given

LONG_RUN = {"mm1": 5.0, "line": 0.7603, "pool": 2.68}
"""mm1 by theory; the others by the recursions below: 16 runs of 8,000 s (+/- 0.0013), 24 of 20,000 s (+/- 0.01)."""
SPREAD = {"mm1": 45.0, "line": 0.42, "pool": 18.1}
"""Standard error of an answer times the square root of the jobs finished: from the same runs; mm1 by theory,
the variance of a mean wait rho (2 + 5 rho - 4 rho^2 + rho^3) / (1 - rho)^4 = 1976 and a little for the service."""


def mm1(until_s: float, numbers: Given) -> tuple[int, float]:
    arrivals, services = list(accumulate(numbers.gaps)), numbers.services[0]
    free_s, leaves_s = 0.0, []
    for arrival_s, service_s in zip(arrivals, services):
        free_s = max(free_s, arrival_s) + service_s
        leaves_s.append(free_s)
    finished = bisect_left(leaves_s, until_s)
    return finished, sum(leaves_s[n] - arrivals[n] for n in range(finished)) / finished


def line(until_s: float, numbers: Given, buffer: int = 5) -> tuple[int, float]:
    services = numbers.services
    last, left = len(services) - 1, [[0.0] * len(services[0]) for _ in services]
    for n in range(len(services[0])):
        comes_s = 0.0
        for j, column in enumerate(services):
            leaves_s = max(comes_s, left[j][n - 1] if n else 0.0) + column[n]
            if j < last and n > buffer:
                leaves_s = max(leaves_s, left[j + 1][n - buffer - 1])
            comes_s = left[j][n] = leaves_s
    finished = bisect_left(left[last], until_s)
    return finished, finished / until_s


Choice = Callable[[list[int]], int]
"""Which of the idle workers who can, in the order of their becoming idle."""


def pool(
    until_s: float, numbers: Given, service: Callable[[int], float] | None = None, choose: Choice = lambda able: able[0]
) -> tuple[int, float]:
    """``service(worker)`` are the next seconds; without it, those of ``numbers`` in the order of starts."""
    if service is None:
        in_order = iter(numbers.services[0])
        service = lambda _worker: next(in_order)  # noqa: E731
    idle, waiting, events, spent = list(range(len(SKILLS))), [], [], []

    def start(worker, arrival_s, now):
        heappush(events, (now + service(worker), worker, arrival_s))

    for arrival_s, station in zip(accumulate(numbers.gaps), numbers.stations):
        while events and events[0][0] < min(arrival_s, until_s):
            now, worker, came_s = heappop(events)
            spent.append(now - came_s)
            job = next((job for job in waiting if job[1] in SKILLS[worker]), None)
            if job is None:
                idle.append(worker)
            else:
                waiting.remove(job)
                start(worker, job[0], now)
        if arrival_s >= until_s:
            return len(spent), sum(spent) / len(spent)
        able = [worker for worker in idle if station in SKILLS[worker]]
        if able:
            idle.remove(chosen := choose(able))
            start(chosen, arrival_s, arrival_s)
        else:
            waiting.append((arrival_s, station))
    raise ValueError("more numbers are needed")


def long_run_error(model: str, outcome: tuple[int, float]) -> float:
    """How many standard errors an answer lies off the long run."""
    jobs, answer = outcome
    return abs(answer - LONG_RUN[model]) / (SPREAD[model] / sqrt(jobs))
