"""The floor: one loop for each model, written for it alone and compiled, no log; numbers drawn by numpy beforehand.

Numbers are a seed, or those given beforehand.
"""

from functools import cache

import numba
import numpy as np
from bench.peers.times import ARRIVALS_PER_S, BUFFER, N_STATIONS, POOL_ARRIVALS_PER_S, POOL_STATIONS, SKILLS, Given

ENDLESS_S = np.inf


def mm1(until_s, numbers):
    if isinstance(numbers, Given):
        gaps, services = map(np.array, (numbers.gaps, numbers.services[0]))
    else:
        n, rng = _most(ARRIVALS_PER_S * until_s), np.random.default_rng(numbers)
        gaps, services = rng.exponential(1 / ARRIVALS_PER_S, n), rng.exponential(1.0, n)
    finished, spent_s = _mm1(gaps, services, until_s)
    return finished, spent_s / finished


def line(until_s, numbers):
    if isinstance(numbers, Given):
        services = np.array(numbers.services)
    else:
        services = np.random.default_rng(numbers).exponential(1.0, (N_STATIONS, _most(0.8 * until_s)))
    finished = _line(services, BUFFER, until_s)
    return finished, finished / until_s


def pool(until_s, numbers):
    if isinstance(numbers, Given):
        gaps, stations, services = map(np.array, (numbers.gaps, numbers.stations, numbers.services[0]))
    else:
        n, rng = _most(POOL_ARRIVALS_PER_S * until_s), np.random.default_rng(numbers)
        gaps, stations = rng.exponential(1 / POOL_ARRIVALS_PER_S, n), rng.integers(0, POOL_STATIONS, n)
        services = rng.exponential(1.0, n)
    finished, spent_s = _pool(gaps, stations, services, _skills(), until_s)
    return finished, spent_s / finished


def _most(expected: float) -> int:
    """More numbers than a run will spend: ten standard errors more, and some."""
    return int(expected + 10 * expected**0.5) + 100


@cache
def _skills() -> np.ndarray:
    """Whether a worker (row) can serve a station (column)."""
    return np.array([[station in able for station in range(POOL_STATIONS)] for able in SKILLS])


@numba.njit
def _mm1(gaps, services, until_s):
    """Two times to look at: the next arrival, the next departure. Jobs that wait are known by their arrivals."""
    came_s = np.empty(gaps.size)
    arrival_s, departure_s = gaps[0], ENDLESS_S
    came, begun, finished, spent_s = 0, 0, 0, 0.0
    while True:
        if arrival_s <= departure_s:
            if arrival_s >= until_s:
                break
            came_s[came] = arrival_s
            if departure_s == ENDLESS_S:
                departure_s = arrival_s + services[begun]
                begun += 1
            came += 1
            arrival_s += gaps[came]
        else:
            if departure_s >= until_s:
                break
            spent_s += departure_s - came_s[finished]
            finished += 1
            if begun < came:
                departure_s += services[begun]
                begun += 1
            else:
                departure_s = ENDLESS_S
    return finished, spent_s


@numba.njit
def _push(times_s, kinds, n, time_s, kind):
    """Into a heap of n events."""
    i = n
    while i > 0:
        up = (i - 1) >> 1
        if times_s[up] <= time_s:
            break
        times_s[i], kinds[i] = times_s[up], kinds[up]
        i = up
    times_s[i], kinds[i] = time_s, kind
    return n + 1


@numba.njit
def _pop(times_s, kinds, n):
    """Take the first out of a heap of n events."""
    n -= 1
    time_s, kind, i = times_s[n], kinds[n], 0
    while True:
        down = 2 * i + 1
        if down >= n:
            break
        if down + 1 < n and times_s[down + 1] < times_s[down]:
            down += 1
        if times_s[down] >= time_s:
            break
        times_s[i], kinds[i] = times_s[down], kinds[down]
        i = down
    times_s[i], kinds[i] = time_s, kind
    return n


@numba.njit
def _line(services, buffer, until_s):
    """A heap of who is ready when; a station that is ready passes on what it can, and so do those before it."""
    n_stations = services.shape[0]
    times_s, ready = np.empty(n_stations + 1), np.empty(n_stations + 1, np.int64)
    is_busy, is_done = np.zeros(n_stations, np.bool_), np.zeros(n_stations, np.bool_)
    waiting, begun = np.zeros(n_stations, np.int64), np.ones(n_stations, np.int64)
    begun[1:] = 0
    n, finished = _push(times_s, ready, 0, services[0, 0], 0), 0
    is_busy[0] = True
    while times_s[0] < until_s:
        now_s, k = times_s[0], ready[0]
        n = _pop(times_s, ready, n)
        is_done[k] = True
        while k >= 0 and is_done[k]:
            if k == n_stations - 1:
                finished += 1
            elif not is_busy[k + 1]:
                is_busy[k + 1] = True
                n = _push(times_s, ready, n, now_s + services[k + 1, begun[k + 1]], k + 1)
                begun[k + 1] += 1
            elif waiting[k + 1] < buffer:
                waiting[k + 1] += 1
            else:
                break
            is_done[k] = False
            is_busy[k] = k == 0 or waiting[k] > 0
            if is_busy[k]:
                waiting[k] -= k > 0
                n = _push(times_s, ready, n, now_s + services[k, begun[k]], k)
                begun[k] += 1
            k -= 1
    return finished


@numba.njit
def _pool(gaps, stations, services, skills, until_s):
    """A heap of departures and one next arrival; those who wait, and the idle, in the order of their coming."""
    n_workers = skills.shape[0]
    times_s, who = np.empty(n_workers + 1), np.empty(n_workers + 1, np.int64)
    idle, serves_since_s = np.arange(n_workers), np.empty(n_workers)
    asked, asked_s = np.empty(gaps.size, np.int64), np.empty(gaps.size)
    n, n_idle, n_waiting, came, begun, finished, spent_s = 0, n_workers, 0, 0, 0, 0, 0.0
    arrival_s = gaps[0]
    while True:
        if n == 0 or arrival_s <= times_s[0]:
            if arrival_s >= until_s:
                break
            station, now_s = stations[came], arrival_s
            came += 1
            arrival_s += gaps[came]
            at = 0
            while at < n_idle and not skills[idle[at], station]:
                at += 1
            if at == n_idle:
                asked[n_waiting], asked_s[n_waiting] = station, now_s
                n_waiting += 1
                continue
            worker, job_s = idle[at], now_s
            n_idle -= 1
            for i in range(at, n_idle):
                idle[i] = idle[i + 1]
        else:
            now_s, worker = times_s[0], who[0]
            if now_s >= until_s:
                break
            n = _pop(times_s, who, n)
            spent_s += now_s - serves_since_s[worker]
            finished += 1
            at = 0
            while at < n_waiting and not skills[worker, asked[at]]:
                at += 1
            if at == n_waiting:
                idle[n_idle] = worker
                n_idle += 1
                continue
            job_s = asked_s[at]
            n_waiting -= 1
            for i in range(at, n_waiting):
                asked[i], asked_s[i] = asked[i + 1], asked_s[i + 1]
        serves_since_s[worker] = job_s
        n = _push(times_s, who, n, now_s + services[begun], worker)
        begun += 1
    return finished, spent_s
