import pickle
import tracemalloc

import numpy as np
import pytest

from opsim.kpi import Figure
from opsim.study.replication import MOST_SAMPLES, Figures, Replicated, Together, thinned, together

KEYS = [("worker_states", f"worker {n}", part, "share") for n in range(20) for part in ("work", "walk", "idle")]


def replication(number, size=500):
    rng = np.random.default_rng(number)
    figures = [Figure(*key, value) for key, value in zip(KEYS, rng.normal(size=len(KEYS)).tolist())]
    return Replicated(number, Figures.of(figures), {("time_in_system_s", ""): rng.exponential(size=size)})


def test_figures_are_what_they_were_made_of_also_after_they_were_sent():
    listed = [Figure("throughput_per_h", "", "", "1/h", 3.5), Figure("worker_states", "ana", "work", "share", np.nan)]
    for found in (Figures.of(listed), pickle.loads(pickle.dumps(Figures.of(listed)))):
        assert len(found) == 2 and found[0] == listed[0] and found[-1][:4] == listed[1][:4]
        assert [figure[:4] for figure in found] == [figure[:4] for figure in listed] and np.isnan(found[1].value)


def test_few_values_stay_as_they_came():
    done = [replication(number) for number in (2, 0, 1)]
    kept = together(done)
    assert [one.replication for one in kept] == [0, 1, 2]
    assert all(np.array_equal(one.samples["time_in_system_s", ""], of) for one, of in zip(kept, map(values, range(3))))


def values(number):
    return replication(number).samples["time_in_system_s", ""]


@pytest.mark.parametrize("seed", range(5))
def test_what_is_kept_does_not_depend_on_the_order_they_come_in(seed):
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 3000, 40)
    kept = Together(most=5000)
    for number in rng.permutation(40).tolist():
        kept.add(replication(number, sizes[number]))
    again = Together(most=5000)
    for number in range(40):
        again.add(replication(number, sizes[number]))
    left = [[one.samples["time_in_system_s", ""] for one in of.in_order()] for of in (kept, again)]
    assert all(np.array_equal(one, other) for one, other in zip(*left))
    assert 2000 < sum(of.size for of in left[0]) <= 5000


def test_thinned_values_are_spread_as_all_are():
    kept = Together(most=10_000)
    for number in range(200):
        kept.add(replication(number))
    pooled = np.concatenate([one.samples["time_in_system_s", ""] for one in kept.in_order()])
    whole = np.concatenate([values(number) for number in range(200)])
    of = np.linspace(0.05, 0.95, 19)
    assert np.allclose(np.quantile(pooled, of), np.quantile(whole, of), rtol=0.05, atol=0.01)
    assert np.allclose(np.quantile(thinned(whole, MOST_SAMPLES), of), np.quantile(whole, of), rtol=1e-3)


def test_another_replication_takes_its_figures_and_some_names_only():
    """60 figures are 480 bytes; 500 values of a sample would be 4,000, of which few are kept once there are many."""
    sent = [pickle.dumps(replication(number)) for number in range(160)]
    kept = Together(most=2_000)
    for one in sent[:60]:
        kept.add(pickle.loads(one))
    tracemalloc.start()
    for one in sent[60:]:
        kept.add(pickle.loads(one))
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert grown / 100 < 2000
