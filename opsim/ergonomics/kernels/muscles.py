"""Three muscle compartments under constant loads, in closed form. Twin: tests/opsim/subjects/human/compartments.py."""

from __future__ import annotations

from math import exp, log
from typing import Any

from numba import carray

from opsim.ergonomics.kernels.compiled import called_from_c, compiled

TRACKING_PER_S = 10.0
"""As ``opsim.subjects.human.muscle_fatigue``; a test compares them."""


@compiled(error_model="numpy", nogil=True)
def _first(m, c1, c2, p1, p2, limit, side, seconds):
    """When m + c1 exp(-p1 t) + c2 exp(-p2 t), p1 > p2, first leaves ``side`` (-1 below, 1 above) of a limit within some
    seconds; -1: never. It has one extremum at most, so there is one way out before it and one after it.
    """
    turn = 0.0
    if c2 != 0.0:
        ratio = -(p1 * c1) / (p2 * c2)
        if ratio > 1.0:
            turn = log(ratio) / (p1 - p2)
    low = 0.0
    for end in (min(turn, seconds), seconds):
        if end > low and side * (m + c1 * exp(-p1 * end) + c2 * exp(-p2 * end) - limit) < 0.0:
            high = end
            for _ in range(200):  # bisection to the last bit
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                if side * (m + c1 * exp(-p1 * middle) + c2 * exp(-p2 * middle) - limit) < 0.0:
                    high = middle
                else:
                    low = middle
            return high
        low = max(low, end)
    return -1.0


@compiled(error_model="numpy", nogil=True)
def held(active, fatigued, load, tires, recovers, seconds):
    """(active, fatigued) shares of a muscle after a constant load was asked of it for some seconds.

    The flow into work is L (min(load, 1 - fatigued) - active), which is what the three cases of the papers' controller
    come to; so there are two regimes, each linear: enough is left (fatigued <= 1 - load), or all that is left works.
    """
    most = 1.0 - load
    pull = TRACKING_PER_S + tires
    for _ in range(64):  # regimes follow each other a few times at most
        if seconds <= 0.0:
            break
        grows = tires * active - recovers * fatigued
        if fatigued < most or (fatigued == most and grows <= 0.0):
            level = TRACKING_PER_S * load / pull
            steady = tires * level / recovers
            fast = tires * (active - level) / (recovers - pull)
            slow = fatigued - steady - fast
            spent = -1.0
            if fatigued + tires * max(active, level) * seconds > most:
                spent = _first(steady, fast, slow, pull, recovers, most, -1.0, seconds)
            step = seconds if spent < 0.0 else spent
            active = level + (active - level) * exp(-pull * step)
            fatigued = steady + fast * exp(-pull * step) + slow * exp(-recovers * step)
        else:
            total = pull + recovers
            root = (total * total - 4.0 * (pull * recovers + TRACKING_PER_S * tires)) ** 0.5
            p1 = 0.5 * (total + root)
            p2 = (pull * recovers + TRACKING_PER_S * tires) / p1
            steady = 1.0 / (1.0 + recovers / tires + recovers / TRACKING_PER_S)
            above = fatigued - steady
            fast = -(grows + p2 * above) / (p1 - p2)
            slow = above - fast
            spent = _first(steady, fast, slow, p1, p2, most, 1.0, seconds)
            step = seconds if spent < 0.0 else spent
            fast, slow = fast * exp(-p1 * step), slow * exp(-p2 * step)
            active = (recovers * steady + fast * (recovers - p1) + slow * (recovers - p2)) / tires
            fatigued = steady + fast + slow
        if spent >= 0.0:
            fatigued = most
        seconds -= step
    return active, fatigued


@compiled(error_model="numpy", nogil=True)
def work(state, course, first, last, seconds):
    """What a piece of work, from share ``first`` to ``last`` of its course, leaves of the muscles; the worst fatigue.

    state  : (J, 5) active and fatigued shares of each joint's muscles, written to; how fast they tire and recover, 1/s,
             and how many times faster where the load is 0
    course : (P, J) loads 0..1 in even parts of the whole performance; seconds : that the piece lasts
    """
    n_parts, n_joints = course.shape
    whole_s = seconds / (last - first) if last > first else 0.0
    worst = 0.0
    for joint in range(n_joints):
        active, fatigued = state[joint, 0], state[joint, 1]
        tires, recovers, at_rest = state[joint, 2], state[joint, 3], state[joint, 4]
        pull = TRACKING_PER_S + tires
        known_s, known_pace, fast_left, slow_left = -1.0, 0.0, 0.0, 0.0
        for part in range(n_parts):
            begin, end = max(first, part / n_parts), min(last, (part + 1) / n_parts)
            if end > begin:
                load, part_s = course[part, joint], (end - begin) * whole_s
                pace = recovers * at_rest if load == 0.0 else recovers
                level = TRACKING_PER_S * load / pull
                if fatigued + tires * max(active, level) * part_s < 1.0 - load:  # enough is left: ``held`` in short
                    if abs(part_s - known_s) > 1e-12 * part_s or pace != known_pace:
                        known_s, known_pace = part_s, pace
                        fast_left, slow_left = exp(-pull * part_s), exp(-pace * part_s)
                    steady = tires * level / pace
                    fast = tires * (active - level) / (pace - pull)
                    fatigued = steady + fast * fast_left + (fatigued - steady - fast) * slow_left
                    active = level + (active - level) * fast_left
                else:
                    active, fatigued = held(active, fatigued, load, tires, pace, part_s)
        state[joint, 0], state[joint, 1] = active, fatigued
        worst = max(worst, fatigued)
    return worst


@compiled(error_model="numpy", nogil=True)
def rest(state, seconds):
    """What a rest leaves of the muscles; the worst fatigue. ``state`` as in ``work``."""
    worst = 0.0
    for joint in range(state.shape[0]):
        recovers = state[joint, 3] * state[joint, 4]
        active, fatigued = held(state[joint, 0], state[joint, 1], 0.0, state[joint, 2], recovers, seconds)
        state[joint, 0], state[joint, 1] = active, fatigued
        worst = max(worst, fatigued)
    return worst


@compiled(error_model="numpy", nogil=True)
def spend(state, course, first, last, work_s, rest_s):
    """``work``, then ``rest`` where it lasts: in one call. NOTE: to get in costs as much as what is done inside."""
    worst = work(state, course, first, last, work_s)
    return rest(state, rest_s) if rest_s > 0.0 else worst


@compiled(error_model="numpy", nogil=True)
def _worst_after(state, spare, seconds):
    """The worst fatigue after a rest, on trial: ``spare`` is written to, and ``state`` is not."""
    for joint in range(state.shape[0]):
        for number in range(state.shape[1]):
            spare[joint, number] = state[joint, number]
    return rest(spare, seconds)


@compiled(error_model="numpy", nogil=True)
def rest_to_s(state, spare, level):
    """Seconds of rest after which no joint is above a level, above 0; to 1 ms, from above. ``spare`` : as ``state``."""
    low, high = 0.0, 1.0
    while _worst_after(state, spare, high) > level:
        low, high = high, 2.0 * high
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        if _worst_after(state, spare, middle) > level:
            low = middle
        else:
            high = middle
    return high


def _passed(state, course, n_joints, n_parts, first, last, work_s, rest_s):
    muscles = carray(state, (n_joints, 5))
    if n_parts == 0:
        return rest(muscles, rest_s)
    return spend(muscles, carray(course, (n_parts, n_joints)), first, last, work_s, rest_s)


def _rest_to_s(state, spare, n_joints, level):
    return rest_to_s(carray(state, (n_joints, 5)), carray(spare, (n_joints, 5)), level)


def for_c() -> tuple[Any, Any]:
    """``spend``, or ``rest`` of a course without parts, and ``rest_to_s``: as C calls them, by addresses."""
    numbers, size = "CPointer(float64), CPointer(float64)", "int64"
    passed = called_from_c(_passed, f"float64({numbers}, {size}, {size}, float64, float64, float64, float64)")
    return passed, called_from_c(_rest_to_s, f"float64({numbers}, {size}, float64)")


@compiled(error_model="numpy", nogil=True)
def exhausted_s(load, tires, recovers, most_s):
    """Seconds for which a fresh muscle meets a load: until no resting muscle is left for it; -1: beyond ``most_s``."""
    pull = TRACKING_PER_S + tires
    level = TRACKING_PER_S * load / pull
    steady = tires * level / recovers
    fast = tires * (0.0 - level) / (recovers - pull)
    return _first(steady, fast, -steady - fast, pull, recovers, 1.0 - load, -1.0, most_s)
