"""What comes together: kits of two parts (fork-join), and batches on one server, by their own Markov chains.

``known_answers.json`` has no fork-join and no batches: the oracle is the chain of each model, listed and solved here.
kits : parts come at random, and are lost (or hold up who makes them: one place more) where their store is full; a kit
       of both is put together by one server, which waits until all of it is there. De Cuypere & Fiems 2011,
       Performance evaluation of a kitting process, ASMTA, LNCS 6751: a Markov chain of the two stocks.
batches : jobs come at random; the server takes K of them together, and waits until there are K. Gross & Harris 1998,
       Fundamentals of Queueing Theory, sec. 3.2 (full-batch model).
"""

from collections.abc import Callable, Iterator

import numpy as np
from known_answers.case import Case

State = tuple[int, ...]
LONGEST_QUEUE = 400
"""Where the chain of batches is cut off: at load 0.75 nothing of what lies beyond is seen in twelve digits."""


def stationary(start: State, moves: Callable[[State], Iterator[tuple[float, State]]]) -> dict[State, float]:
    """Share of time in each state that is reached; ``moves`` yields (rate, next state)."""
    states = [start]
    number = {start: 0}
    flows = []
    for state in states:
        for rate, after in moves(state):
            if after not in number:
                number[after] = len(states)
                states.append(after)
            flows.append((rate, number[state], number[after]))
    balance = np.zeros((len(states), len(states)))
    for rate, here, there in flows:
        balance[there, here] += rate
        balance[here, here] -= rate
    balance[0] = 1.0
    return dict(zip(states, np.linalg.solve(balance, np.eye(len(states))[0]).tolist()))


def kitting(every_s: tuple[float, float], pieces: tuple[int, int], most: tuple[int, int], mean_s: float):
    """(kits a second, mean stock by the rooms of the stores) of kits of two parts.

    The state is the two stocks, and whether a kit is being made.
    """

    def begun(first: int, second: int) -> State:
        here = first >= pieces[0] and second >= pieces[1]
        return (first - pieces[0], second - pieces[1], 1) if here else (first, second, 0)

    def moves(state: State) -> Iterator[tuple[float, State]]:
        stock, busy = state[:2], state[2]
        for part in (0, 1):
            if stock[part] < most[part]:
                more = [held + (part == which) for which, held in enumerate(stock)]
                yield 1 / every_s[part], (*more, 1) if busy else begun(*more)
        if busy:
            yield 1 / mean_s, begun(*stock)

    share = stationary((0, 0, 0), moves)
    rate = sum(p for state, p in share.items() if state[2]) / mean_s
    return rate, lambda room: sum(p * (min(a, room[0]) + min(b, room[1])) for (a, b, _), p in share.items())


def jobs_in_batches(size: int, every_s: float, mean_s: float) -> float:
    """Mean jobs inside where a server takes ``size`` at once; the state is who waits, and whether a batch is served."""

    def begun(waiting: int) -> State:
        return (waiting - size, 1) if waiting >= size else (waiting, 0)

    def moves(state: State) -> Iterator[tuple[float, State]]:
        waiting, busy = state
        if waiting < LONGEST_QUEUE:
            yield 1 / every_s, (waiting + 1, 1) if busy else begun(waiting + 1)
        if busy:
            yield 1 / mean_s, begun(waiting)

    share = stationary((0, 0), moves)
    return sum(p * (waiting + size * busy) for (waiting, busy), p in share.items())


def _kits(variant: str, every_s, pieces, room, mean_s: float, blocks: bool = False) -> tuple[Case, ...]:
    """Who makes a part and finds no room holds it: as if the store had one place more."""
    rate, stock = kitting(every_s, pieces, tuple(places + blocks for places in room), mean_s)
    return (
        Case("kitting", variant, "throughput_per_h", rate, scale=3600.0, few=8),
        Case("kitting", variant, "pieces_in_stock", stock(room), few=8),
    )


CASES = (
    *_kits("base", (1.0, 1.0), (1, 1), (3, 3), 0.8),
    *_kits("uneven", (0.5, 1.0), (2, 1), (6, 2), 0.8),
    *_kits("blocking", (1.0, 1.0), (1, 1), (3, 3), 0.8, blocks=True),
    Case("batches", "base", "work_in_progress", jobs_in_batches(4, 1.0, 3.0), most_half_width=0.02, few=8),
    Case("batches", "eight", "work_in_progress", jobs_in_batches(8, 1.0, 6.0), most_half_width=0.02, few=8),
)
