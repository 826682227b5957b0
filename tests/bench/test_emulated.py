"""What it costs to draw durations from a motion emulator instead of a lognormal distribution."""

import time

import pytest
from plans import line, plan

from opsim.engine.floor.run import run_plan
from opsim.log import WORK

ROUNDS, TARGET = 5, 1.2


def seconds_per_performance(p) -> float:
    started = time.process_time()
    work = run_plan(p).of(WORK)
    spent = time.process_time() - started
    assert work.duration_s.mean() == pytest.approx(1.5, rel=0.2)
    return spent / len(work)


def test_emulated_against_lognormal_durations():
    text = line(10, 5, horizon="5000 s")
    libraries = "opsim: 1\nlibraries: {moves: libraries/bench_work.npz}\n"
    emulated = text.replace("opsim: 1\n", libraries).replace("dist: exponential, mean: 1 s", "emulator: moves/reach")
    lognormal = text.replace(
        "dist: exponential, mean: 1 s", "dist: lognormal, mean: 1.5 s, cv: 0.19, between_share: 0.5"
    )
    plans = plan(emulated), plan(lognormal)
    rounds = [tuple(map(seconds_per_performance, plans)) for _ in range(ROUNDS + 1)][1:]
    best = [min(column) for column in zip(*rounds)]
    print(f"\nline of ten, emulated: {best[0] / best[1]:.2f} x the CPU of lognormal durations (target {TARGET})")
