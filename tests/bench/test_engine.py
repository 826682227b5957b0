"""The engine with its full event log against the same line in hand-written SimPy, which logs nothing."""

import random
import time

import pytest
import simpy
from plans import line, plan

from opsim.engine.simpy_engine import run_plan
from opsim.log import FINISH

N_STATIONS, BUFFER, HORIZON_S, ROUNDS = 10, 5, 6000.0, 3
RATE = 0.76  # ten exponential stations, five places between: 0.759-0.763 in long runs of several simulators


def by_hand(seed: int) -> float:
    """Jobs a second of the line written with Stores, as SimPy's users write it."""
    env, rng = simpy.Environment(), random.Random(seed)
    buffers = [simpy.Store(env, capacity=BUFFER) for _ in range(N_STATIONS - 1)]
    finished = [0]

    def machine(rank):
        while True:
            if rank:
                yield buffers[rank - 1].get()
            yield env.timeout(rng.expovariate(1.0))
            if rank < N_STATIONS - 1:
                yield buffers[rank].put(1)
            else:
                finished[0] += env.now > HORIZON_S / 6

    for rank in range(N_STATIONS):
        env.process(machine(rank))
    env.run(HORIZON_S)
    return finished[0] / (HORIZON_S * 5 / 6)


def ours(seed: int) -> float:
    log = run_plan(plan(line(N_STATIONS, BUFFER, horizon=f"{HORIZON_S} s", seed=seed)))
    return float((log.of(FINISH)["end_s"] > HORIZON_S / 6).sum() / (HORIZON_S * 5 / 6))


def timed(run, seed) -> float:
    started = time.process_time()
    assert run(seed) == pytest.approx(RATE, abs=0.04)
    return time.process_time() - started


def test_line_of_ten_against_simpy_by_hand():
    ours(0)
    seconds = [(timed(ours, seed), timed(by_hand, seed)) for seed in range(1, ROUNDS + 1)]
    best_ours, best_hand = (min(column) for column in zip(*seconds))
    print(f"\nline of {N_STATIONS}, event log on: {best_ours / best_hand:.2f} x the CPU of SimPy by hand without a log")
