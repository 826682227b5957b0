"""The engine with its full event log against the same models in hand-written SimPy, which log nothing.

Models: ten exponential stations in line with five places between; twenty stations served by eight workers who can each
serve those of two of eight groups. As machines the line has no workers; manned it has one at each station.
"""

import random
import time
from collections.abc import Callable

import pytest
import simpy
from plans import line, plan

from opsim.engine.simpy_engine import run_plan
from opsim.log import FINISH, WORK

N_STATIONS, BUFFER, HORIZON_S, ROUNDS = 10, 5, 6000.0, 5
LINE_RATE = 0.76  # 0.759-0.763 in long runs of several simulators
POOL_STATIONS, POOL_WORKERS, POOL_EVERY_S, POOL_S = 20, 8, 1 / (20 * 0.34), 3000.0
POOL_RATE = 6.8


def line_by_hand(seed: int) -> float:
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


def manned_line(seed: int) -> float:
    return line_rate(line(N_STATIONS, BUFFER, horizon=f"{HORIZON_S} s", seed=seed))


def machine_line(seed: int) -> float:
    text = line(N_STATIONS, BUFFER, horizon=f"{HORIZON_S} s", seed=seed)
    return line_rate(text.replace("mean: 1 s}", "mean: 1 s, automatic: true}").split("workers:")[0])


def line_rate(text: str) -> float:
    log = run_plan(plan(text))
    return float((log.of(FINISH)["end_s"] > HORIZON_S / 6).sum() / (HORIZON_S * 5 / 6))


def skilled(worker: int) -> list[int]:
    return [s for s in range(POOL_STATIONS) if s % POOL_WORKERS in (worker, (worker + 1) % POOL_WORKERS)]


def pool_by_hand(seed: int) -> float:
    """Jobs a second of the pool with a FilterStore of workers."""
    env, rng, done = simpy.Environment(), random.Random(seed), [0]
    idle = simpy.FilterStore(env)
    idle.items = list(range(POOL_WORKERS))
    skills = [frozenset(skilled(worker)) for worker in range(POOL_WORKERS)]

    def job(station):
        worker = yield idle.get(lambda w: station in skills[w])
        yield env.timeout(rng.expovariate(1.0))
        idle.put(worker)
        done[0] += 1

    def source():
        while True:
            yield env.timeout(rng.expovariate(1 / POOL_EVERY_S))
            env.process(job(rng.randrange(POOL_STATIONS)))

    env.process(source())
    env.run(POOL_S)
    return done[0] / POOL_S


def pool(seed: int) -> float:
    stations = range(POOL_STATIONS)
    skills = ["{" + ", ".join(f"s{s}: 1.0" for s in skilled(w)) + "}" for w in range(POOL_WORKERS)]
    text = "\n".join([
        "opsim: 1",
        "name: pool",
        f"run: {{horizon: {POOL_S} s, seed: {seed}}}",
        "layout: {places: {floor: [0 m, 0 m]}}",
        "tasks: {t: {dist: exponential, mean: 1 s}}",
        "stations: {" + ", ".join(f"s{s}: {{at: floor, tasks: [t], servers: {POOL_WORKERS}}}" for s in stations) + "}",
        "products: {" + ", ".join(f"p{s}: {{share: {1 / POOL_STATIONS}, route: [s{s}]}}" for s in stations) + "}",
        f"release: {{kind: poisson, every: {POOL_EVERY_S} s}}",
        "workers: {" + ", ".join(f"w{w}: {{skills: {skill}}}" for w, skill in enumerate(skills)) + "}",
        "allocation: {rule: oldest_job}",
    ])  # fmt: skip
    return len(run_plan(plan(text)).of(WORK)) / POOL_S


def seconds(run: Callable[[int], float], seed: int, rate: float) -> float:
    started = time.process_time()
    found = run(seed)
    spent = time.process_time() - started
    assert found == pytest.approx(rate, rel=0.05)
    return spent


@pytest.mark.parametrize(
    ("ours", "by_hand", "rate", "target"),
    [
        (machine_line, line_by_hand, LINE_RATE, 1.5),
        (manned_line, line_by_hand, LINE_RATE, 1.5),
        (pool, pool_by_hand, POOL_RATE, 1.0),
    ],
)
def test_against_simpy_by_hand(ours, by_hand, rate, target):
    ours(0)
    rounds = [(seconds(ours, seed, rate), seconds(by_hand, seed, rate)) for seed in range(1, ROUNDS + 1)]
    best_ours, best_hand = (min(column) for column in zip(*rounds))
    ratio = best_ours / best_hand
    print(f"\n{ours.__name__}, event log on: {ratio:.2f} x the CPU of {by_hand.__name__}, no log (target {target})")
