"""Events come in the order of their times, and of one time in that in which they were set."""

import heapq

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from made_machine import as_floor, empty_floor, entered

from opsim.engine.fast_engine.event_list import forget_event, new_event, pop_event, push_event


@entered
def gone_through(floor_at, times, found):
    """Pushes where a time is said and pops where it is negative; ``found`` (n,) numbers of what was popped."""
    floor = as_floor(floor_at)
    n = 0
    for i in range(times.size):
        if times[i] >= 0:
            event = new_event(floor)
            event.number = i
            push_event(floor, times[i], event)
        elif floor.heap_n:
            event = pop_event(floor)
            found[n] = event.number
            forget_event(floor, event)
            n += 1
    return n


@settings(max_examples=150, deadline=None)
@given(st.lists(st.sampled_from([-1.0, 0.0, 0.5, 1.0, 2.0, 3.5]), max_size=300))
def test_the_heap_is_that_of_python(times):
    arena, floor = empty_floor()
    arena.freeze()
    found = np.zeros(len(times), dtype=np.int64)
    n = gone_through(floor.address, np.array(times), found)
    heap, wanted = [], []
    for i, at_s in enumerate(times):
        if at_s >= 0:
            heapq.heappush(heap, (at_s, i))
        elif heap:
            wanted.append(heapq.heappop(heap)[1])
    assert found[:n].tolist() == wanted
