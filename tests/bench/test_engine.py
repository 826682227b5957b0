"""The engine with its full event log against the same models in hand-written SimPy, which log nothing.

Models and answers are those of ``bench.peers``; the table with other simulators is ``make bench-peers``.
"""

import pytest
from bench.peers import compare

ROUNDS = 6
RUNNERS = {(runner.label, runner.model): runner for runner in compare.runners()}


@pytest.mark.parametrize(
    ("label", "model", "target"),
    [("opsim", "line", 1.5), ("opsim, manned", "line", 1.5), ("opsim", "pool", 1.0), ("opsim", "mm1", 1.5)],
)
def test_against_simpy_by_hand(label, model, target):
    ours, by_hand = RUNNERS[label, model], RUNNERS["SimPy by hand", model]
    assert all(compare.agree(*compare.exact(runner)) for runner in (ours, by_hand))
    speeds = [[compare.jobs_per_cpu_s(runner, seed) for runner in (ours, by_hand)] for seed in range(1, ROUNDS + 1)]
    best_ours, best_by_hand = map(max, zip(*speeds))
    ratio = best_by_hand / best_ours
    print(f"\n{model}, {label}, event log on: {ratio:.2f} x the CPU of SimPy by hand, no log (target {target})")
