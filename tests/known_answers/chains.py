"""The exact rate of a saturated line with blocking after service, by its Markov chain: an oracle without simulation.

Source: Hillier & Boling (1967), Finite queues in series with exponential or Erlang service times, Operations Research
15(2): the states are listed, the balance equations solved. Here times are Erlang, a phase of the work at a time.
"""

from collections.abc import Iterator

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

IDLE, BLOCKED = 0, -1
State = tuple[tuple[int, ...], tuple[int, ...]]
"""What each station does (IDLE, BLOCKED, or its phase from 1), and the jobs waiting before it."""


def line_rate(mean_s: tuple[float, ...], phases: int = 1, room: int = 0) -> float:
    """Jobs a second of a line with these mean times, Erlang in ``phases``, and ``room`` places before each station."""
    steps = list(_reachable((1,) + (IDLE,) * (len(mean_s) - 1), phases, room))
    number = {state: i for i, (state, _) in enumerate(steps)}
    flow = coo_array(_flows(steps, number, phases / np.array(mean_s)), shape=(len(steps), len(steps))).tocsr()
    balance = (flow - coo_array((flow.sum(0), (range(len(steps)),) * 2), shape=flow.shape)).tolil()
    balance[0, :] = 1.0
    share = spsolve(balance.tocsr(), np.eye(len(steps))[0])
    leaving = np.array([state[0][-1] == phases for state, _ in steps])
    return float(share[leaving].sum() * phases / mean_s[-1])


def _reachable(start: tuple[int, ...], phases: int, room: int) -> Iterator[tuple[State, dict[int, State]]]:
    """Every state with the state after the next event of each working station."""
    waiting: list[State] = [(start, (0,) * len(start))]
    seen = set(waiting)
    for state in waiting:
        after = {k: _event(state, k, phases, room) for k, doing in enumerate(state[0]) if doing > 0}
        waiting += [new for new in dict.fromkeys(after.values()) if new not in seen]
        seen.update(after.values())
        yield state, after


def _flows(steps, number, rate):
    """Rates into states (rows) from states (columns), as scipy wants them."""
    flows = [(rate[k], number[new], number[old]) for old, after in steps for k, new in after.items()]
    values, to, origin = zip(*flows)
    return values, (to, origin)


def _event(state: State, k: int, phases: int, room: int) -> State:
    doing, queue = list(state[0]), list(state[1])
    if doing[k] < phases:
        doing[k] += 1
    elif k + 1 == len(doing) or _accepts(doing, queue, k + 1, room):
        _take(doing, queue, k)
    else:
        doing[k] = BLOCKED
    return tuple(doing), tuple(queue)


def _accepts(doing: list[int], queue: list[int], k: int, room: int) -> bool:
    """Hand a job to station k if it has a place."""
    if doing[k] == IDLE:
        doing[k] = 1
    elif queue[k] < room:
        queue[k] += 1
    else:
        return False
    return True


def _take(doing: list[int], queue: list[int], k: int) -> None:
    """Station k has let its job go: it takes the next, and a blocked station before it may hand on its own."""
    if k == 0:
        doing[0] = 1
        return
    doing[k], upstream_waits = IDLE, doing[k - 1] == BLOCKED
    if queue[k]:
        queue[k] -= 1
        doing[k] = 1
    elif upstream_waits:
        doing[k] = 1
        return _take(doing, queue, k - 1)
    if upstream_waits:
        queue[k] += 1
        _take(doing, queue, k - 1)
