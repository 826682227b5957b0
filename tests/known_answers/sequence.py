"""Priorities by Cobham's formula, and lines of two with a place ahead or behind."""

from itertools import pairwise

from known_answers.case import Case

_COBHAM = "M/M/1 non-preemptive priority"
_TWO = "two-station line, exponential, equal rates"


def _stay(variant: str, product: str, expected: tuple[str, ...] | float, work_s: float = 0.0) -> Case:
    """The stay of a class: the expected wait and its mean work."""
    return Case("priorities", variant, f"stay_of_{product}_s", expected, shift=work_s, most_half_width=0.02, few=16)


def interrupted_s(arrivals: tuple[float, ...], level: int) -> float:
    """Mean stay of a class where higher ones interrupt it and it goes on later; all work is exponential of 1 s.

    Source: Conway, Maxwell & Miller 1967, Theory of Scheduling, section 8-6 (preemptive resume).
    """
    above, with_it = sum(arrivals[:level]), sum(arrivals[: level + 1])
    return 1 / (1 - above) + with_it / ((1 - above) * (1 - with_it))


def waiting_s(arrivals: tuple[float, ...], mean_s: tuple[float, ...], squared_s2: tuple[float, ...]) -> list[float]:
    """Mean wait of each class without interruption, from rates, means and mean squares of the work.

    Source: Cobham 1954, Priority assignment in waiting line problems, Operations Research 2(1).
    """
    rest_s = sum(rate * square / 2 for rate, square in zip(arrivals, squared_s2))
    loads = [sum(rate * mean for rate, mean in zip(arrivals[:k], mean_s)) for k in range(len(arrivals) + 1)]
    return [rest_s / ((1 - above) * (1 - with_it)) for above, with_it in pairwise(loads)]


_ARRIVALS = (0.3, 0.5)
_SHORTEST = waiting_s((0.4, 0.4), (0.5, 1.5), (0.5, 3.0))  # exponential of 0.5 s; three of them, Erlang

CASES = (
    _stay("waiting", "first", (_COBHAM, "Wq1"), 1.0),
    _stay("waiting", "second", (_COBHAM, "Wq2"), 1.0),
    *(_stay(how, "first", interrupted_s(_ARRIVALS, 0)) for how in ("resume", "restart")),
    *(_stay(how, "second", interrupted_s(_ARRIVALS, 1)) for how in ("resume", "restart")),
    _stay("shortest", "first", _SHORTEST[0], 0.5),
    _stay("shortest", "second", _SHORTEST[1], 1.5),
    Case(
        "blocking", "before_0", "throughput_per_h", 1 / 2, scale=3600.0, few=6
    ),  # M/M/1/1: a queue of one place in all
    Case("blocking", "before_2", "throughput_per_h", 3 / 4, scale=3600.0, few=6),  # M/M/1/3
    Case("blocking", "behind_2", "throughput_per_h", (_TWO, "throughput", "2"), scale=3600.0, few=6),
)
